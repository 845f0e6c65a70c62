#pragma once
#include <memory>

#include "filter/scattered.h"
#include "frame/history.h"
#include "reconstruct/captured_taps.h"
#include "reconstruct/stable/sample_set.h"
#include "reconstruct/stable/tile_order.h"

namespace lumi {

/// Temporally coherent ray tracing with one sample a pixel [Martin02], as [DalCorso17, sec. 6] adapts it: the samples
/// of the frame before are projected to where their surfaces are, the closest of those that land in a pixel stays, a
/// pixel without one gets a new ray through its middle, and the last three frames are averaged. It reads no signals.
///
/// Differs from the papers:
/// - A sample is traced again through the place where it landed: what the ray meets is the pixel's sample from then on,
///   if it is not the surface point that was expected (verification after Adelson and Hodges, which [Martin02] shares).
/// - Objects move and deform, as in [DalCorso17]; [Martin02] knows moving viewpoints only.
/// - The box filter over time averages images, pixel by pixel, or (`average` = scene) the colours of a sample along its
///   way: [DalCorso17] calls it scene-based (sec. 7), but also the cause of blur (sec. 6, fig. 7), which only the
///   former can be where light does not depend on the view. `frames` is its length.
/// - A sample is the colour of its pixel, wherever in it. With `filter` = gaussian samples go through the
///   reconstruction that [DalCorso17] gives the other methods (fig. 8): comparisons are of where samples are then, and
///   not of filters, too.
class Martin2002Module : public Module {
public:
    Martin2002Module();
    SignalSet reads() const override { return {}; }
    void describe(ParameterVisitor&) override;
    void resize(Extent2) override;
    void forget() override;
    RunResult run(const FrameContext&, Image& out) override;
    std::span<const Tap> taps() const override { return taps_.declared(); }
    const Image& tap(const std::string& name) const override;
    size_t byteCount() const override;

private:
    static constexpr int kMostFrames = 8;
    /// A frame: the sample of each pixel, and the images that the box filter of the next one still needs.
    struct Kept {
        size_t bytes() const {
            return locations.size() * (sizeof(SampleLocation) + sizeof(Vec2) + 12 + colours.size() * sizeof(Vec3));
        }

        std::vector<SampleLocation> locations;
        std::vector<Vec2> places;
        std::vector<uint32_t> names, pathsDrawn, ages;
        std::vector<std::vector<Vec3>>
            colours;  ///< of each sample in this frame and those before, as far as it is old enough
        std::vector<std::shared_ptr<const Image>> images;  ///< the newest first
    };
    void project(const FrameContext& context, const Kept& previous);
    void reproject(const FrameContext& context, const Kept& previous, Kept& next);
    void verifyAndShade(const FrameContext& context, Kept& next);
    void verifyAndShade(const FrameContext& context, std::span<const uint32_t> pixels, Kept& next);
    bool filter(const FrameContext& context, const Kept* previous, Kept& next, Image& out);
    bool reconstruct(const FrameContext& context, std::span<const Vec2> places, std::span<const Vec3> colours,
                     Image& out);
    void averageSamples(const Kept& kept, std::vector<Vec3>& means) const;
    void averageImages(const std::vector<std::shared_ptr<const Image>>& images, Image& out) const;

    /// What the box filter over time follows.
    enum class Average { Screen, Scene };

    Extent2 extent_;
    int frames_ = 3;
    Average average_ = Average::Screen;
    ScatteredSettings scattered_{.filter = ScatteredSettings::Filter::Box};
    FrameHistory<Kept> history_;
    std::vector<uint64_t> nearest_;  ///< of each pixel: depth and index of the closest sample that landed there
    std::vector<Vec2> places_;       ///< of the samples of the frame before, on this frame's screen
    std::vector<Vec3> inWorld_;
    std::vector<Vec3> means_;      ///< of each sample's colours
    std::vector<uint32_t> first_;  ///< of a pixel's samples: it has one
    Image weights_;
    TileList order_;              ///< all pixels
    std::vector<uint8_t> codes_;  ///< of the tap `verdicts`
    CapturedTaps taps_;
};

}  // namespace lumi
