#pragma once
#include "filter/scattered.h"
#include "reconstruct/captured_taps.h"
#include "reconstruct/stable/temporal_integration.h"
#include "reconstruct/stable/tile_order.h"

namespace lumi {

/// Standard supersampling, what stable ray tracing is compared with [DalCorso17, sec. 6]: every frame traces 1 to 6
/// samples at fixed places of each pixel and reconstructs as `stable` does. With temporal integration the places are
/// jittered from frame to frame, which makes it full temporal antialiasing. It reads no signals: it places its own
/// rays, from a pinhole and at the shutter's opening, as `stable` does.
///
/// Differs from the paper, which does not say where the samples are: they form a rook pattern, one in each row and
/// column of spp x spp cells, the same in all pixels; a single one is in the middle. Temporal integration clips as
/// filter/taa.h does. Both filter tone-mapped colours (`tone-mapped`), which is a bias against references that are
/// linear.
class SupersamplingModule : public Module {
public:
    SupersamplingModule();
    SignalSet reads() const override { return {}; }
    void describe(ParameterVisitor&) override;
    void resize(Extent2) override;
    void forget() override;
    RunResult run(const FrameContext&, Image& out) override;
    std::span<const Tap> taps() const override { return taps_.declared(); }
    const Image& tap(const std::string& name) const override;
    size_t byteCount() const override;

    /// Place of sample `s` of `count` within its pixel, moved by `jitter` in pixels and wrapped around.
    static Vec2 placeInPixel(int s, int count, Vec2 jitter);

private:
    void listSamples();
    bool trace(const FrameContext& context);
    void traceRun(const FrameContext& context, std::span<const uint32_t> samples, const Vec2* within);

    Extent2 extent_;
    int samplesPerPixel_ = 1;
    ScatteredSettings scattered_;
    TemporalIntegration temporal_{0.1f};
    int listedSamples_ = 0;  ///< that first_ and list_ are for; 0: none
    std::vector<uint32_t> first_;
    TileList list_;  ///< samples in the order in which they are traced
    std::vector<Vec2> places_, motions_;
    std::vector<Vec3> colours_;
    Image weights_, motion_;
    CapturedTaps taps_;
};

}  // namespace lumi
