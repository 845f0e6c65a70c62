#include "reconstruct/taa/taa.h"

#include <cassert>

namespace lumi {

void TaaModule::resize(Extent2 extent) {
    extent_ = extent;
    forget();
}

RunResult TaaModule::run(const FrameContext& context, Image& out) {
    assert(context.signals.extent() == extent_);
    if (context.stop.stop_requested()) return RunResult::Stopped;
    const auto measured = context.timer.measure("antialiasing");
    auto [previous, next] = history_.begin(context.frame, context.changes.cut);
    if (!antialiasTemporally(context.signals, settings_, context.signals[Signal::Noisy], previous, scratch_, next, out, context.stop))
        return RunResult::Stopped;
    history_.commit();
    return RunResult::Completed;
}

size_t TaaModule::byteCount() const {
    return scratch_.bytes() + history_.byteCount([](const Image& image) { return image.bytes(); });
}

}  // namespace lumi
