#include "reconstruct/none/none.h"

#include <cassert>

namespace lumi {

Signal NoneModule::signal() const {
    switch (component_) {
        case Component::Direct: return Signal::Direct;
        case Component::Indirect: return Signal::Indirect;
        case Component::Emission: return Signal::Emission;
        default: return Signal::Noisy;
    }
}

SignalSet NoneModule::reads() const { return {signal()}; }

void NoneModule::describe(ParameterVisitor& v) {
    v.choice("component", component_,
             {.label = "Component",
              .options = {"all", "direct", "indirect", "emission"},
              .help = "Which part of the light is shown: all of it, light that met one surface, light that met more, "
                      "or emitters and sky seen directly"});
}

RunResult NoneModule::run(const FrameContext& context, Image& out) {
    const Image& source = context.signals[signal()];
    assert(source.extent() == extent_ && source.channels() == 3);
    if (context.stop.stop_requested()) return RunResult::Stopped;
    out = source;
    return RunResult::Completed;
}

}  // namespace lumi
