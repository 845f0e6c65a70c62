#pragma once
#include "filter/taa.h"
#include "frame/history.h"
#include "reconstruct/module.h"

namespace lumi {

/// Temporal integration with colour clamping of images that were made from samples [DalCorso17, sec. 6, after
/// Patney16]: filter/taa.h along the samples' own motion, the longest of each 3 x 3 pixels (sec. 4.4). The parameter
/// `temporal` switches it on.
class TemporalIntegration {
public:
    explicit TemporalIntegration(float alpha) { settings_.alpha = alpha; }
    void describe(ParameterVisitor& v);
    bool enabled() const { return enabled_; }
    void forget() { history_.clear(); }
    /// In place; `motion`: X, Y in pixels. Returns false if stopped.
    bool run(const FrameContext& context, const Image& motion, Image& image);
    void commit() { history_.commit(); }
    size_t bytes() const;

private:
    bool enabled_ = false;
    TaaSettings settings_;
    FrameHistory<Image> history_;
    Image scratch_, length_;
};

/// The longest motion (previous minus current place) among each pixel's samples, X and Y; 0 where a pixel
/// has none. `first` and `hidden` as in filter/scattered.h.
void longestMotions(std::span<const uint32_t> first, std::span<const Vec2> motions, std::span<const uint8_t> hidden,
                    Image& out);

}  // namespace lumi
