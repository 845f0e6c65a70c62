#include "reconstruct/eaw/eaw.h"

#include "reconstruct/lineage_rows.h"

namespace lumi {
namespace {

std::vector<Tap> declareTaps() {
    std::vector<Tap> taps = temporalTaps();
    for (int level = 0; level <= EawModule::kMaxLevels; ++level)
        taps.push_back({.name = "level" + std::to_string(level),
                        .channels = "RGB",
                        .unit = "W/(m^2 sr)",
                        .colourMap = "none",
                        .help = level == 0 ? "Illumination before the first level"
                                           : "Illumination after this level; the last one's where fewer run"});
    return taps;
}

}  // namespace

EawModule::EawModule() : ScreenFilter(declareTaps(), false) {}

SignalSet EawModule::reads() const {
    return commonSignals() | input_.reads() | SignalSet{Signal::Normal, Signal::Position, Signal::InverseDepth};
}

void EawModule::describe(ParameterVisitor& v) {
    input_.describe(v);
    v.integer("levels", levels_,
              {.label = "Wavelet levels", .min = 0, .max = kMaxLevels, .help = "Iterations of the à-trous transform"});
    v.number("sigma-color", edges_.sigmaColour,
             {.label = "Sigma colour",
              .min = 0.01,
              .max = 1000,
              .scale = Scale::Log,
              .unit = "W/(m^2 sr)",
              .help = "sigma_rt at the first level, of demodulated illumination; it halves with each level"});
    v.number("sigma-normal", edges_.sigmaNormal,
             {.label = "Sigma normal",
              .min = 0.01,
              .max = 10,
              .scale = Scale::Log,
              .help = "sigma_n at the first level; it doubles with each level"});
    v.number("sigma-position", edges_.sigmaPosition,
             {.label = "Sigma position",
              .min = 0.001,
              .max = 10,
              .scale = Scale::Log,
              .help = "sigma_x, distance between points as a part of their depth"});
    describeAntialiasing(v);
}

bool EawModule::filter(const FrameContext& context, const Step& step, Image& out) {
    const Image* from = input_.integrate(context, frame(), step.previous, step.next, captured(), inspected());
    if (!from) return false;
    const auto measured = context.timer.measure("wavelet filter");
    for (int level = 0; level <= kMaxLevels; ++level) {
        if (level > 0 && level <= levels_) {
            Image& to = planes_[level % 2];
            if (Lineage* lineage = inspected())
                addEdgeAvoidingRows(*lineage, "level " + std::to_string(level), context.signals, edges_, level - 1,
                                    *from);
            if (!edgeAvoidingLevel(context.signals, edges_, level - 1, *from, to, context.stop)) return false;
            from = &to;
        }
        captured().keep("level" + std::to_string(level), *from);
    }
    remodulate(frame(), *from, nullptr, out);
    return true;
}

size_t EawModule::byteCount() const {
    return ScreenFilter::byteCount() + input_.byteCount() + planes_[0].bytes() + planes_[1].bytes();
}

}  // namespace lumi
