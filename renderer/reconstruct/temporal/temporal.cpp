#include "reconstruct/temporal/temporal.h"

#include "reconstruct/lineage_rows.h"

namespace lumi {
namespace {

std::vector<Tap> declareTaps() {
    std::vector<Tap> taps = temporalTaps();
    taps.push_back({.name = "illumination",
                    .channels = "RGB",
                    .colourMap = "none",
                    .help = "Integrated illumination, demodulated"});
    taps.push_back({.name = "sampleVariance",
                    .channels = "Y",
                    .colourMap = "magma",
                    .help = "Variance of a sample's luminance over time (sec. 4.2)"});
    return taps;
}

}  // namespace

TemporalModule::TemporalModule() : ScreenFilter(declareTaps(), false) {}

void TemporalModule::describe(ParameterVisitor& v) {
    settings_.describe(v);
    describeAntialiasing(v);
}

bool TemporalModule::filter(const FrameContext& context, const Step& step, Image& out) {
    const auto measured = context.timer.measure("temporal filter");
    frame().addComponents(sum_);
    const TemporalOptions options = temporalOptions(frame(), captured());
    if (!filterTemporally(context.signals, settings_, {&sum_}, step.previous, step.next, context.stop, options))
        return false;
    if (Lineage* lineage = inspected())
        addHistoryRows(*lineage, context.signals, step.previous, settings_, options.dropped);
    const TemporalComponent& integrated = step.next.components[0];
    remodulate(frame(), integrated.colour, nullptr, out);
    captured().keep("illumination", integrated.colour);
    captured().keep("historyLength", step.next.length);
    captured().keep("sampleVariance", integrated.sampleVariance);
    return true;
}

}  // namespace lumi
