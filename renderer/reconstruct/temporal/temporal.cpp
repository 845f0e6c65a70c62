#include "reconstruct/temporal/temporal.h"

#include <cassert>

namespace lumi {

TemporalModule::TemporalModule()
    : taps_({{.name = "illumination", .channels = "RGB", .colourMap = "none", .help = "Integrated illumination, demodulated"},
             {.name = "reprojection",
              .channels = "Y",
              .rangeHigh = 19,
              .colourMap = "turbo",
              .help = "Verdict of the history's taps: 0 sky, 1 all kept, 2 some refused, 3 found by the 3x3 fall-back, 4 and "
                      "above lost, plus 1 off screen, 2 another object, 4 depth, 8 normal"},
             {.name = "historyLength", .channels = "Y", .unit = "frames", .rangeHigh = 64, .help = "Frames that make up a pixel's history"},
             {.name = "sampleVariance", .channels = "Y", .colourMap = "magma", .help = "Variance of a sample's luminance over time (sec. 4.2)"},
             {.name = "dropped", .channels = "Y", .colourMap = "magma", .help = "1 where a value of the input was NaN or infinite and was dropped"}}) {}

SignalSet TemporalModule::reads() const { return demodulationSignals() | reprojectionSignals() | antialiasing_.reads(); }

void TemporalModule::describe(ParameterVisitor& v) {
    settings_.describe(v);
    antialiasing_.describe(v);
}

void TemporalModule::resize(Extent2 extent) {
    extent_ = extent;
    forget();
}

void TemporalModule::forget() {
    history_.clear();
    antialiasing_.forget();
    taps_.clear();
}

RunResult TemporalModule::run(const FrameContext& context, Image& out) {
    assert(context.signals.extent() == extent_);
    if (context.stop.stop_requested()) return RunResult::Stopped;
    taps_.begin(context.wantedTaps);
    auto [previous, next] = history_.begin(context.frame, context.changes.cut);
    {
        const auto measured = context.timer.measure("temporal filter");
        demodulate(context.signals, frame_);
        for (size_t i = 0; i < frame_.direct.size(); ++i) frame_.direct.data()[i] += frame_.indirect.data()[i];
        if (!filterTemporally(context.signals, settings_, {&frame_.direct}, previous, next, taps_.target("reprojection"), context.stop))
            return RunResult::Stopped;
        remodulate(frame_, next.components[0].colour, nullptr, out);
    }
    if (!antialiasing_.run(context, out)) return RunResult::Stopped;

    taps_.keep("illumination", next.components[0].colour);
    taps_.keep("historyLength", next.length);
    taps_.keep("sampleVariance", next.components[0].sampleVariance);
    taps_.keep("dropped", frame_.dropped);
    history_.commit();
    antialiasing_.commit();
    taps_.commit();
    return RunResult::Completed;
}

const Image& TemporalModule::tap(const std::string& name) const {
    const Image* found = taps_.find(name);
    return found ? *found : Module::tap(name);
}

size_t TemporalModule::byteCount() const {
    size_t sum = taps_.bytes() + antialiasing_.byteCount() + history_.byteCount([](const TemporalHistory& h) { return h.bytes(); });
    for (const Image* image : {&frame_.emission, &frame_.albedo, &frame_.direct, &frame_.indirect, &frame_.dropped}) sum += image->bytes();
    return sum;
}

}  // namespace lumi
