#include "reconstruct/aaf/aaf.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "reconstruct/aaf/occlusion.h"
#include "reconstruct/lineage_rows.h"

namespace lumi {
namespace {

std::vector<Tap> declareTaps() {
    std::vector<Tap> taps = temporalTaps();
    taps.push_back(
        {.name = "occlusion",
         .channels = "Y",
         .help = "d1/d2 - 1 of the sharpest of the window's shadows, accumulated; 0 where nothing was blocked"});
    taps.push_back({.name = "filterWidth",
                    .channels = "Y",
                    .unit = "m",
                    .help = "beta, the Gaussian's standard deviation on the surface"});
    taps.push_back({.name = "integratedDirect",
                    .channels = "RGB",
                    .unit = "W/(m^2 sr)",
                    .colourMap = "none",
                    .help = "Direct illumination before the filter"});
    taps.push_back({.name = "filteredDirect",
                    .channels = "RGB",
                    .unit = "W/(m^2 sr)",
                    .colourMap = "none",
                    .help = "Direct illumination after it"});
    return taps;
}

}  // namespace

AafModule::AafModule() : ScreenFilter(declareTaps(), false) { temporalSettings_.moments = false; }

SignalSet AafModule::reads() const {
    return commonSignals() | occlusionSignals() | (temporal_ ? reprojectionSignals() : SignalSet{});
}

void AafModule::describe(ParameterVisitor& v) {
    v.toggle("temporal", temporal_,
             {.label = "Temporal accumulation",
              .help = "Integrate light and occlusion distances over time ([Schied17, sec. 5.1])"});
    v.when(temporal_, [&] { temporalSettings_.describe(v); });
    v.integer("window-radius", windowRadius_,
              {.label = "Window radius",
               .min = 0,
               .max = 8,
               .unit = "px",
               .help = "Of the window that d2max is gathered in"});
    v.number("overlap", overlap_,
             {.label = "k",
              .min = 0.5,
              .max = 10,
              .help = "How many standard deviations of the filter the sharpest penumbra's own is wide"});
    v.integer("max-radius", maxRadius_,
              {.label = "Largest radius", .min = 1, .max = 128, .unit = "px", .help = "Of the filter on the screen"});
    describeAntialiasing(v);
}

bool AafModule::filter(const FrameContext& context, const Step& step, Image& out) {
    {
        const auto measured = context.timer.measure("occlusion");
        if (!measureOcclusion(context, emitters_, measured_)) return false;
        gatherOcclusion(context.signals, windowRadius_, measured_, occlusion_);
    }
    if (!integrate(context, step)) return false;
    const auto measured = context.timer.measure("axis-aligned filter");
    const Image& direct = temporal_ ? step.next.components[0].colour : frame().direct;
    captured().keep("integratedDirect", direct);
    chooseWidths(temporal_ ? step.next.components[2].colour : occlusion_);
    blur(context.signals, context.camera, true, direct, half_);
    if (context.stop.stop_requested()) return false;
    blur(context.signals, context.camera, false, half_, filtered_);
    captured().keep("filteredDirect", filtered_);
    remodulate(frame(), filtered_, temporal_ ? &step.next.components[1].colour : &frame().indirect, out);
    return !context.stop.stop_requested();
}

bool AafModule::integrate(const FrameContext& context, const Step& step) {
    const auto measured = context.timer.measure("temporal filter");
    if (!temporal_) {
        step.next = {};  // a later frame starts its history anew
        keepNoHistory(captured(), extent());
        return true;
    }
    const TemporalOptions options = temporalOptions(frame(), captured());
    if (!filterTemporally(context.signals, temporalSettings_, {&frame().direct, &frame().indirect, &occlusion_},
                          step.previous, step.next, context.stop, options))
        return false;
    captured().keep("historyLength", step.next.length);
    if (Lineage* lineage = inspected())
        addHistoryRows(*lineage, context.signals, step.previous, temporalSettings_, options.dropped);
    return true;
}

/// beta of each pixel, 0 where nothing was blocked.
void AafModule::chooseWidths(const Image& occlusion) {
    if (width_.extent() != extent()) width_.reset(extent(), 1);
    Image* shown = captured().target("occlusion");
    if (shown) shown->reset(extent(), 1);
    for (int64_t i = 0; i < extent().area(); ++i) {
        // Means over the frames that had a blocker.
        const float found = occlusion.plane(1).data[i], perFound = found > 1e-3f ? 1 / found : 0;
        width_.data()[i] = occlusion.plane(2).data[i] * perFound / overlap_;
        if (shown) shown->data()[i] = occlusion.plane(0).data[i] * perFound;
    }
    captured().keep("filterWidth", width_);
}

void AafModule::blur(const Signals& signals, const CameraPose& camera, bool alongRows, const Image& in,
                     Image& out) const {
    if (out.extent() != extent()) out.reset(extent(), 3);
    const Image &position = signals[Signal::Position], &normal = signals[Signal::Normal],
                &inverseDepth = signals[Signal::InverseDepth];
    const IdImage& object = signals.ids(Signal::ObjectId);
    parallelFor(extent().height, [&](int64_t row) {
        const int y = static_cast<int>(row);
        for (int x = 0; x < extent().width; ++x) {
            const float beta = width_.at(0, x, y), z = inverseDepth.at(0, x, y);
            float shift[3] = {0, 0, 0}, weights = 1;
            const bool surface = beta > 0 && z > 0 && object.at(0, x, y) != 0;
            // A footprint of a pixel that faces the camera; slanted ones reach their weights' end sooner.
            const float pixels = surface ? std::max(1.0f, 2 * beta / camera.pixelSizeAt(1 / z)) : 0;
            const int radius = static_cast<int>(std::min(pixels, static_cast<float>(maxRadius_)));
            for (int k = -radius; k <= radius; ++k) {
                const int i = alongRows ? x + k : x, j = alongRows ? y : y + k;
                if (k == 0 || i < 0 || j < 0 || i >= extent().width || j >= extent().height) continue;
                if (object.at(0, i, j) != object.at(0, x, y)) continue;
                float distance = 0;
                for (int c = 0; c < 3; ++c) {
                    const float d = position.at(c, i, j) - position.at(c, x, y);
                    distance += d * d;
                }
                const float w = facesAlike(normal, {x, y}, {i, j}) ? std::exp(-distance / (2 * beta * beta)) : 0;
                if (!(w > 0)) continue;
                weights += w;
                for (int c = 0; c < 3; ++c) shift[c] += w * (in.at(c, i, j) - in.at(c, x, y));
            }
            for (int c = 0; c < 3; ++c) out.at(c, x, y) = in.at(c, x, y) + shift[c] / weights;
        }
    });
}

size_t AafModule::byteCount() const {
    size_t sum = ScreenFilter::byteCount();
    for (const Image* image : {&measured_, &occlusion_, &width_, &half_, &filtered_}) sum += image->bytes();
    return sum;
}

}  // namespace lumi
