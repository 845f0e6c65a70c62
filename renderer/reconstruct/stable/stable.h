#pragma once
#include "filter/scattered.h"
#include "frame/history.h"
#include "reconstruct/captured_taps.h"
#include "reconstruct/stable/analysis.h"
#include "reconstruct/stable/sample_pass.h"
#include "reconstruct/stable/temporal_integration.h"

namespace lumi {

/// Interactive stable ray tracing [DalCorso17]: shading locations stay on the surfaces from frame to frame and move
/// over the screen with them. Each frame reprojects them (sec. 4.1), adds and removes some so that their density stays
/// even (4.2), verifies that the camera sees them and shades those that it does (4.3), and makes the image of these
/// (4.4). A sample averages the indirect light of its paths over its life (6.1). It reads no signals: it places its own
/// rays.
///
/// Differs from the paper:
/// - A location is (instance, triangle, barycentrics), so that samples stay on surfaces that deform; the paper's is a
///   position in the space of an affine transform. A ray that leaves the scene gives a sample too: its direction.
/// - Samples lie without gaps instead of 16 slots a pixel, and light is kept as floats: see SampleSet for the bytes.
///   Where a sample is in the world is kept, too, and found again only when surfaces move.
/// - Of several samples in one sub-pixel the first in memory's order stays: the paper's is that of the quickest thread.
/// - Algorithm 1 keeps the occlusion bit of an occluded sample in an empty sub-pixel, as the text says.
/// - A sample's visibility ray is the first of the path that shades it, and batches of rays are lists without gaps.
///   `batches` has the paper's way.
/// - Samples of the same triangle count as visible wherever the ray meets it, whatever epsilon; those on the body of a
///   light if they face the ray as the hit does. All rays to a sample pass the same blended surfaces or stop at them,
///   so that it is not occluded now and then: a still view of such converges to samples that have each drawn once.
/// - A sample that its ray does not find is evicted. If all of a pixel are occluded the first moves to what occludes
///   it, but not while nothing changes: verdicts stay then.
/// - The density's tolerance is 0.75, not 1: a view that zooms in spreads samples, and at 1 the density may fall far
///   below the target, for pixels act only where the window is empty. At 0.75 it falls by 13% while the view comes
///   nearer by 1% a frame, and by 18% at 3%; at 0.5 by less, but two to eight times as many samples are exchanged, each
///   a step in the image. Fig. 10's trade-off (study stable-fig10, quick, hairball and print): against 1 it has 0.66
///   and 0.96 of the error (relMSE) and as much flicker, where 0.5 has 1.21 and 1.33 times the flicker for 0.53 and
///   1.05 times the error. The paper names no default: its only value, for one figure (fig. 4), is 1. It is at most the
///   target, or nothing would ever be added to an empty screen. At the image's border density counts the area inside.
/// - The Gaussian of sec. 4.4 has no sigma in the paper. It is 0.7 pixels: there the CPBD of our hairball (448 x 448)
///   is 0.81, and fig. 7 prints 0.818 for theirs, the paper's only figure that depends on it; at 0.5 it is 0.86. Cut
///   off after 3 x 3 pixels, a tenth of its height is left: "truncated" says something.
/// - Samples have places, not cells of 8 x 8. Those of the sky are lost when an orthographic camera moves: it sees one
///   direction, which tells no place.
/// - Directions of indirect light are those of the integrator (BSDF sampling), and what came to other lobes than the
///   diffuse one stays out of the average, for it depends on the view: it is that of the frame. The average has warmed
///   up as a mean until it has 1/alpha paths. An edit of materials or of paths begins it anew, and so does a moved
///   light in samples that are hidden. While nothing changes at all, light is an arithmetic mean and verdicts stay;
///   that mean goes on from the average, but begins anew if a light or an object moved within the last 4/alpha frames,
///   so that no light of then stays in it.
/// - Temporal integration clips as filter/taa.h does.
/// - The lens is a pinhole and the shutter an instant: samples have one place on the screen.
class StableModule : public Module {
public:
    StableModule();
    SignalSet reads() const override { return {}; }
    void describe(ParameterVisitor&) override;
    void resize(Extent2) override;
    void forget() override;
    RunResult run(const FrameContext&, Image& out) override;
    std::span<const Tap> taps() const override { return taps_.declared(); }
    const Image& tap(const std::string& name) const override;
    Lineage lineage() const override { return lineage_; }
    Convergence convergence() const override;
    size_t byteCount() const override;

    /// What is amiss with the parameters, in a sentence; empty: nothing.
    std::string advice() const;

    /// Of the last completed run.
    const SampleSet& samples() const { return history_.current().samples; }
    const VerificationCounts& verification() const { return counts_; }

private:
    struct Kept {
        SampleSet samples;
        uint64_t meanFrames = 0;    ///< whose paths are in the mean of each visible sample
        uint64_t steadyFrames = 0;  ///< since a light or an object moved
        bool averaged = false;      ///< nothing had changed, and light was the mean of its paths
        float epsilon = 0;          ///< that verdicts were found with
    };
    bool placeSamples(const FrameContext& context, const SampleSet& previous, Kept& next);
    GatheringState lightState(const FrameContext& context, const Kept* previous, Kept& next) const;
    bool trace(const FrameContext& context, const SampleSet& previous, const GatheringState& light, SampleSet& samples,
               VerificationCounts& counts);
    bool reconstruct(const FrameContext& context, const SampleSet& samples, Image& out);
    std::span<const Vec3> coloursOf(const SampleSet& samples) const;
    void keepTaps(const FrameContext& context, const SampleSet& samples);
    void inspect(const FrameContext& context, const SampleSet& samples);

    Extent2 extent_;
    DensitySettings density_;
    VerificationSettings verification_;
    GatheringSettings gathering_;
    ScatteredSettings scattered_;
    TemporalIntegration temporal_{0.25f};
    FrameHistory<Kept> history_;
    SampleFrame frame_;
    Spares<SampleBatch> spare_;
    Image weights_, motion_, localDensity_;
    VerificationCounts counts_;
    CapturedTaps taps_;
    Lineage lineage_;
};

}  // namespace lumi
