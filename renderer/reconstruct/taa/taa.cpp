#include "reconstruct/taa/taa.h"

#include <cassert>
#include <cmath>

namespace lumi {
namespace {

/// 1 where a channel of `rgb` is no number.
void markDropped(const Image& rgb, Image& mask) {
    mask.reset(rgb.extent(), 1);
    for (int c = 0; c < rgb.channels(); ++c)
        for (int64_t i = 0; i < rgb.extent().area(); ++i)
            if (!std::isfinite(rgb.plane(c).data[i])) mask.data()[i] = 1;
}

}  // namespace

void TaaModule::resize(Extent2 extent) {
    extent_ = extent;
    forget();
}

void TaaModule::forget() {
    history_.clear();
    taps_.clear();
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
    if (Image* mask = taps_.target("dropped")) markDropped(context.signals[Signal::Noisy], *mask);
    auto [previous, next] = history_.begin(context.frame, context.changes.cut);
    if (!antialiasTemporally(context.signals, settings_, context.signals[Signal::Noisy], previous, scratch_, next, out, context.stop))
        return RunResult::Stopped;
    history_.commit();
    taps_.commit();
    return RunResult::Completed;
}

size_t TaaModule::byteCount() const {
    return taps_.bytes() + scratch_.bytes() + history_.byteCount([](const Image& image) { return image.bytes(); });
}

}  // namespace lumi
