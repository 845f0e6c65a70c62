#include "reconstruct/taa/taa.h"

#include <atomic>
#include <cassert>
#include <cmath>

#include "base/parallel.h"

namespace lumi {
namespace {

constexpr int64_t kGrain = 1 << 14;

/// How many pixels are not finite; `mask`, if given, is 1 there.
int64_t countDropped(const Image& rgb, Image* mask) {
    if (mask) mask->reset(rgb.extent(), 1);
    std::atomic<int64_t> count{0};
    parallelRanges(rgb.extent().area(), kGrain, [&](int64_t begin, int64_t end) {
        const float *r = rgb.plane(0).data, *g = rgb.plane(1).data, *b = rgb.plane(2).data;
        int64_t found = 0;
        for (int64_t i = begin; i < end; ++i) {
            const bool bad = !std::isfinite(r[i]) || !std::isfinite(g[i]) || !std::isfinite(b[i]);
            found += bad;
            if (mask && bad) mask->data()[i] = 1;
        }
        count += found;
    });
    return count;
}

}  // namespace

void TaaModule::resize(Extent2 extent) {
    extent_ = extent;
    forget();
}

void TaaModule::forget() {
    history_.clear();
    taps_.clear();
    dropped_ = 0;
}

const Image& TaaModule::tap(const std::string& name) const {
    const Image* found = taps_.find(name);
    return found ? *found : Module::tap(name);
}

RunResult TaaModule::run(const FrameContext& context, Image& out) {
    assert(context.signals.extent() == extent_);
    if (context.stop.stop_requested()) return RunResult::Stopped;
    const auto measured = context.timer.measure("antialiasing");
    taps_.begin(context.wantedTaps);
    const int64_t dropped = countDropped(context.signals[Signal::Noisy], taps_.target("dropped"));
    auto [previous, next] = history_.begin(context.frame, context.changes.cut);
    if (!antialiasTemporally(context.signals, settings_, exposureFactor(context.scene), context.signals[Signal::Noisy],
                             previous, scratch_, next, out, context.stop))
        return RunResult::Stopped;
    history_.commit();
    taps_.commit();
    dropped_ = dropped;
    return RunResult::Completed;
}

size_t TaaModule::byteCount() const {
    return taps_.bytes() + scratch_.bytes() + history_.byteCount([](const Image& image) { return image.bytes(); });
}

}  // namespace lumi
