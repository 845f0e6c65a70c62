#include "reconstruct/screen_filter.h"

#include <cassert>

#include "reconstruct/lineage_rows.h"

namespace lumi {
namespace {

std::vector<Tap> withDropped(std::vector<Tap> taps) {
    taps.push_back(droppedTap());
    return taps;
}

}  // namespace

ScreenFilter::ScreenFilter(std::vector<Tap> taps, bool antialiased)
    : antialiasing_(antialiased), taps_(withDropped(std::move(taps))) {}

void ScreenFilter::resize(Extent2 extent) {
    extent_ = extent;
    forget();
}

void ScreenFilter::forget() {
    history_.clear();
    antialiasing_.forget();
    taps_.clear();
    lineage_ = {};
    dropped_ = 0;
}

RunResult ScreenFilter::run(const FrameContext& context, Image& out) {
    assert(context.signals.extent() == extent_);
    if (context.stop.stop_requested()) return RunResult::Stopped;
    taps_.begin(context.wantedTaps);
    pendingLineage_ = {};
    if (const auto& p = context.inspected; p && p->x >= 0 && p->y >= 0 && p->x < extent_.width && p->y < extent_.height)
        pendingLineage_.pixel = *p;
    {
        const auto measured = context.timer.measure("demodulation");
        demodulate(context.signals, frame_);
        fillDropped(context.signals, frame_);
        taps_.keep("dropped", frame_.dropped);
    }
    if (!filter(context, history_.begin(context.frame, context.changes.cut), out)) return RunResult::Stopped;
    if (!antialiasing_.run(context, out)) return RunResult::Stopped;
    history_.commit();
    antialiasing_.commit();
    taps_.commit();
    lineage_ = pendingLineage_;
    dropped_ = frame_.droppedPixels;
    commit();
    return RunResult::Completed;
}

const Image& ScreenFilter::tap(const std::string& name) const {
    const Image* found = taps_.find(name);
    return found ? *found : Module::tap(name);
}

size_t ScreenFilter::byteCount() const {
    return taps_.bytes() + antialiasing_.byteCount() + frame_.bytes() +
           history_.byteCount([](const TemporalHistory& h) { return h.bytes(); });
}

std::vector<Tap> temporalTaps() {
    return {
        {.name = "reprojection",
         .channels = "Y",
         .range = ValueRange{0, kVerdictUnused},
         .colourMap = "turbo",
         .help =
             "Verdict of the history's taps: 0 sky, 1 all kept, 2 some refused, 3 found by the 3x3 fall-back, 4 and "
             "above lost, plus 1 off screen, 2 another object, 4 depth, 8 normal; 20 accumulation is off"},
        {.name = "refusals",
         .channels = "XYZW",
         .range = ValueRange{0, 15},
         .colourMap = "none",
         .help = "Which of the history's four taps were refused for another object (X), depth (Y), normal (Z) and off "
                 "screen "
                 "(W): each a sum of 1, 2, 4 and 8 for the upper left, upper right, lower left and lower right one"},
        {.name = "historyLength",
         .channels = "Y",
         .unit = "frames",
         .range = ValueRange{0, 64},
         .help = "Frames that make up a pixel's history"}};
}

VerdictImages verdictImages(CapturedTaps& taps) { return {taps.target("reprojection"), taps.target("refusals")}; }

TemporalOptions temporalOptions(const DemodulatedFrame& frame, CapturedTaps& taps) {
    return {.dropped = frame.droppedPixels > 0 ? &frame.dropped : nullptr, .verdicts = verdictImages(taps)};
}

void keepNoHistory(CapturedTaps& taps, Extent2 extent) {
    verdictImages(taps).unused(extent);
    if (Image* length = taps.target("historyLength")) length->reset(extent, 1);
}

void AccumulatedInput::describe(ParameterVisitor& v) {
    v.toggle("temporal", enabled_,
             {.label = "Temporal accumulation",
              .help = "Integrate over time before filtering, as SVGF does ([Schied17, sec. 5.1])"});
    v.when(enabled_, [&] { settings_.describe(v); });
}

const Image* AccumulatedInput::integrate(const FrameContext& context, const DemodulatedFrame& frame,
                                         const TemporalHistory* previous, TemporalHistory& next, CapturedTaps& taps,
                                         Lineage* lineage) {
    const auto measured = context.timer.measure("temporal filter");
    frame.addComponents(sum_);
    if (!enabled_) {
        next = {};  // a later frame starts its history anew
        keepNoHistory(taps, frame.direct.extent());
        return &sum_;
    }
    const TemporalOptions options = temporalOptions(frame, taps);
    if (!filterTemporally(context.signals, settings_, {&sum_}, previous, next, context.stop, options)) return nullptr;
    taps.keep("historyLength", next.length);
    if (lineage) addHistoryRows(*lineage, context.signals, previous, settings_, options.dropped);
    return &next.components[0].colour;
}

}  // namespace lumi
