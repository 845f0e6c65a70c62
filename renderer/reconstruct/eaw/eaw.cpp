#include "reconstruct/eaw/eaw.h"

#include <cassert>

#include "base/parallel.h"

namespace lumi {
namespace {

std::vector<Tap> declareTaps() {
    std::vector<Tap> taps{{.name = "dropped", .channels = "Y", .colourMap = "magma", .help = "1 where a value of the input was NaN or infinite and was dropped"}};
    for (int level = 0; level <= EawModule::kMaxLevels; ++level)
        taps.push_back({.name = "level" + std::to_string(level),
                        .channels = "RGB",
                        .unit = "W/(m^2 sr)",
                        .colourMap = "none",
                        .help = level == 0 ? "Illumination before the first level" : "Illumination after this level; the last one's where fewer run"});
    return taps;
}

}  // namespace

EawModule::EawModule() : taps_(declareTaps()) {}

SignalSet EawModule::reads() const {
    SignalSet set = demodulationSignals() | SignalSet{Signal::Normal, Signal::Position, Signal::InverseDepth} | antialiasing_.reads();
    if (temporal_) set |= reprojectionSignals();
    return set;
}

void EawModule::describe(ParameterVisitor& v) {
    v.toggle("temporal", temporal_,
             {.label = "Temporal accumulation", .help = "Integrate over time before filtering, as SVGF does ([Schied17, sec. 5.1])"});
    v.when(temporal_, [&] { temporalSettings_.describe(v, false); });
    v.integer("levels", levels_, {.label = "Wavelet levels", .min = 0, .max = kMaxLevels, .help = "Iterations of the à-trous transform"});
    v.number("sigma-color", edges_.sigmaColour,
             {.label = "Sigma colour",
              .min = 0.01,
              .max = 100,
              .scale = Scale::Log,
              .unit = "W/(m^2 sr)",
              .help = "sigma_rt at the first level, of demodulated illumination; it halves with each level"});
    v.number("sigma-normal", edges_.sigmaNormal,
             {.label = "Sigma normal", .min = 0.01, .max = 10, .scale = Scale::Log, .help = "sigma_n at the first level; it doubles with each level"});
    v.number("sigma-position", edges_.sigmaPosition,
             {.label = "Sigma position",
              .min = 0.001,
              .max = 10,
              .scale = Scale::Log,
              .help = "sigma_x, distance between points as a part of their depth"});
    antialiasing_.describe(v);
}

void EawModule::resize(Extent2 extent) {
    extent_ = extent;
    forget();
}

void EawModule::forget() {
    history_.clear();
    antialiasing_.forget();
    taps_.clear();
}

RunResult EawModule::run(const FrameContext& context, Image& out) {
    assert(context.signals.extent() == extent_);
    if (context.stop.stop_requested()) return RunResult::Stopped;
    taps_.begin(context.wantedTaps);
    demodulate(context.signals, frame_);
    taps_.keep("dropped", frame_.dropped);
    if (!integrate(context)) return RunResult::Stopped;
    const Image* filtered = filterSpatially(context);
    if (!filtered) return RunResult::Stopped;
    remodulate(frame_, *filtered, nullptr, out);
    if (!antialiasing_.run(context, out)) return RunResult::Stopped;
    history_.commit();
    antialiasing_.commit();
    taps_.commit();
    return RunResult::Completed;
}

bool EawModule::integrate(const FrameContext& context) {
    const auto measured = context.timer.measure("temporal filter");
    input_ = frame_.direct;
    parallelRanges(static_cast<int64_t>(input_.size()), 1 << 15, [&](int64_t begin, int64_t end) {
        for (int64_t i = begin; i < end; ++i) input_.data()[i] += frame_.indirect.data()[i];
    });
    auto [previous, next] = history_.begin(context.frame, context.changes.cut);
    if (!temporal_) {
        next = {};  // a later frame starts its history anew
        return true;
    }
    if (!filterTemporally(context.signals, temporalSettings_, {&input_}, previous, next, nullptr, context.stop)) return false;
    input_ = next.components[0].colour;
    return true;
}

const Image* EawModule::filterSpatially(const FrameContext& context) {
    const auto measured = context.timer.measure("wavelet filter");
    const Image* from = &input_;
    for (int level = 0; level <= kMaxLevels; ++level) {
        if (level > 0 && level <= levels_) {
            Image& to = planes_[level % 2];
            if (!edgeAvoidingLevel(context.signals, edges_, level - 1, *from, to, context.stop)) return nullptr;
            from = &to;
        }
        taps_.keep("level" + std::to_string(level), *from);
    }
    return from;
}

const Image& EawModule::tap(const std::string& name) const {
    const Image* found = taps_.find(name);
    return found ? *found : Module::tap(name);
}

size_t EawModule::byteCount() const {
    size_t sum = taps_.bytes() + antialiasing_.byteCount() + input_.bytes() + planes_[0].bytes() + planes_[1].bytes() +
                 history_.byteCount([](const TemporalHistory& h) { return h.bytes(); });
    for (const Image* image : {&frame_.emission, &frame_.albedo, &frame_.direct, &frame_.indirect, &frame_.dropped}) sum += image->bytes();
    return sum;
}

}  // namespace lumi
