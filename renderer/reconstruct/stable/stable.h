#pragma once
#include "filter/scattered.h"
#include "frame/history.h"
#include "reconstruct/captured_taps.h"
#include "reconstruct/stable/analysis.h"
#include "reconstruct/stable/shading.h"
#include "reconstruct/stable/temporal_integration.h"
#include "reconstruct/stable/verification.h"

namespace lumi {

/// Interactive stable ray tracing [DalCorso17]: shading locations stay on the surfaces from frame to frame and move over
/// the screen with them. Each frame reprojects them (sec. 4.1), adds and removes some so that their density stays even
/// (4.2), verifies that the camera sees them and shades those that it does (4.3), and makes the image of these (4.4). A
/// sample averages the indirect light of its paths over its life (6.1). It reads no signals: it places its own rays.
///
/// Differs from the paper:
/// - A location is (instance, triangle, barycentrics), so that samples stay on surfaces that deform; the paper's is a
///   position in the space of an affine transform. A ray that leaves the scene gives a sample too: its direction.
/// - Samples lie without gaps instead of 16 slots a pixel, and light is kept as floats: see SampleSet for the bytes.
/// - Of several samples in one sub-pixel the first in memory's order stays: the paper's is that of the quickest thread.
/// - Algorithm 1 keeps the occlusion bit of an occluded sample in an empty sub-pixel, as the text says.
/// - Visibility is traced for all samples first, shading follows for those that are visible: both work on lists without
///   gaps. `batches` has the paper's way.
/// - Samples of the same triangle count as visible wherever the ray meets it, whatever epsilon.
/// - A sample that its ray does not find is evicted. The density's tolerance is at most the target, or nothing would ever
///   be added to an empty screen. At the image's border density counts the area inside.
/// - Indirect light has warmed up as a mean until it has 1/alpha paths; while nothing changes at all, light is an
///   arithmetic mean and verdicts stay.
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

    /// Of the last completed run.
    const SampleSet& samples() const { return history_.current().samples; }
    const VerificationCounts& verification() const { return counts_; }
    int64_t filledPixels() const { return filledPixels_; }

private:
    struct Kept {
        SampleSet samples;
        uint64_t stillFrames = 0;  ///< since anything changed
    };
    bool placeSamples(const FrameContext& context, const SampleSet& previous, SampleSet& next);
    bool reconstruct(const FrameContext& context, const SampleSet& samples, Image& out);
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
    Image weights_, motion_, localDensity_;
    VerificationCounts counts_;
    int64_t filledPixels_ = 0;
    CapturedTaps taps_;
    Lineage lineage_;
};

}  // namespace lumi
