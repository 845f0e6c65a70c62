#pragma once
#include "filter/taa.h"
#include "frame/history.h"
#include "reconstruct/module.h"

namespace lumi {

/// Temporal antialiasing as the last stage of a module: the parameters `taa` and `taa-...`, and the history. The module
/// calls run() once a frame and commit() when the frame is complete.
class AntialiasingPass {
public:
    explicit AntialiasingPass(bool enabled) : enabled_(enabled) {}
    bool enabled() const { return enabled_; }
    SignalSet reads() const { return enabled_ ? taaSignals() : SignalSet{}; }
    void describe(ParameterVisitor& v);
    void forget() { history_.clear(); }
    /// Antialiases `image` in place, if enabled. Returns false if stopped.
    bool run(const FrameContext& context, Image& image);
    void commit() { history_.commit(); }
    size_t byteCount() const {
        return scratch_.bytes() + history_.byteCount([](const Image& image) { return image.bytes(); });
    }

private:
    bool enabled_;
    TaaSettings settings_;
    FrameHistory<Image> history_;
    Image scratch_;
};

}  // namespace lumi
