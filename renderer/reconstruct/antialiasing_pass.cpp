#include "reconstruct/antialiasing_pass.h"

#include "params/renaming_visitor.h"

namespace lumi {

void AntialiasingPass::describe(ParameterVisitor& v) {
    v.toggle(
        "taa", enabled_,
        {.label = "Temporal antialiasing",
         .help =
             "Antialias the finished image over frames [Karis14]; edges that the filter keeps are aliased otherwise"});
    v.when(enabled_, [&] {
        RenamingVisitor renamed(v, "taa-");
        settings_.describe(renamed);
    });
}

bool AntialiasingPass::run(const FrameContext& context, Image& image) {
    auto step = history_.begin(context.frame, context.changes.cut);
    if (!enabled_) {
        step.next = {};  // a later frame starts its history anew
        return true;
    }
    const auto measured = context.timer.measure("antialiasing");
    return antialiasTemporally(context.signals, settings_, exposureFactor(context.scene), image, step.previous,
                               scratch_, step.next, image, context.stop);
}

}  // namespace lumi
