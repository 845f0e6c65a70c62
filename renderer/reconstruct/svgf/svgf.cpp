#include "reconstruct/svgf/svgf.h"

#include <algorithm>
#include <cassert>

namespace lumi {

SvgfModule::SvgfModule() : taps_(kMaxLevels) {}

SignalSet SvgfModule::reads() const {
    return demodulationSignals() | reprojectionSignals() | surfaceGuideSignals() | antialiasing_.reads();
}

void SvgfModule::resize(Extent2 extent) {
    extent_ = extent;
    forget();
}

void SvgfModule::forget() {
    history_.clear();
    antialiasing_.forget();
    taps_.clear();
}

AtrousSettings SvgfModule::atrousSettings() const {
    AtrousSettings settings = parameters_.atrous;
    settings.edges.planeDistance = parameters_.depthWeight == DepthWeight::PlaneDistance;
    return settings;
}

RunResult SvgfModule::run(const FrameContext& context, Image& out) {
    assert(context.signals.extent() == extent_);
    if (context.stop.stop_requested()) return RunResult::Stopped;
    taps_.begin(context.wantedTaps);
    auto [previous, next] = history_.begin(context.frame, context.changes.cut);

    // 3: demodulate the albedo of directly visible surfaces.
    {
        const auto measured = context.timer.measure("demodulation");
        demodulate(context.signals, frame_);
        taps_.keepInput(frame_);
    }
    // 4.1 temporal filtering, 4.2 variance estimation, 4.3 wavelet transform.
    if (!integrate(context, previous, next)) return RunResult::Stopped;
    if (!estimateVariance(context, next)) return RunResult::Stopped;
    const Levels* filtered = filterSpatially(context, next);
    if (!filtered) return RunResult::Stopped;
    // 3: modulate again, and antialias.
    {
        const auto measured = context.timer.measure("modulation");
        remodulate(frame_, (*filtered)[0].rgb, &(*filtered)[1].rgb, out);
    }
    if (!antialiasing_.run(context, out)) return RunResult::Stopped;

    history_.commit();
    antialiasing_.commit();
    taps_.commit();
    return RunResult::Completed;
}

bool SvgfModule::integrate(const FrameContext& context, const TemporalHistory* previous, TemporalHistory& next) {
    const auto measured = context.timer.measure("temporal filter");
    if (!filterTemporally(context.signals, parameters_.temporal, {&frame_.direct, &frame_.indirect}, previous, next,
                          taps_.target("reprojection"), context.stop))
        return false;
    taps_.keepIntegrated(next);
    for (size_t c = 0; c < kComponents; ++c) {
        input_[c].reset(extent_);
        input_[c].rgb = next.components[c].colour;
        input_[c].sampleVariance = next.components[c].sampleVariance;
        updateLuminance(input_[c]);
    }
    return true;
}

bool SvgfModule::estimateVariance(const FrameContext& context, const TemporalHistory& integrated) {
    const auto measured = context.timer.measure("variance estimation");
    const SurfaceGuide guide = surfaceGuide(context.signals);
    const float least = parameters_.varianceSource == VarianceSource::Spatial
                            ? std::numeric_limits<float>::max()
                            : static_cast<float>(parameters_.spatialVarianceFrames);
    for (size_t c = 0; c < kComponents; ++c) {
        const TemporalComponent& component = integrated.components[c];
        if (!estimateVarianceSpatially(guide, atrousSettings().edges, integrated.length.data(), least, component.mean.data(),
                                       component.sampleVariance.data(), input_[c].sampleVariance.data(), context.stop))
            return false;
    }
    return true;
}

const SvgfModule::Levels* SvgfModule::filterSpatially(const FrameContext& context, TemporalHistory& next) {
    const auto measured = context.timer.measure("wavelet filter");
    const SurfaceGuide guide = surfaceGuide(context.signals);
    const AtrousSettings settings = atrousSettings();
    taps_.keepEdgeWeights(guide, settings, input_[0], input_[1]);
    const int feedback = std::min(parameters_.feedbackLevel, parameters_.levels);
    const Levels* from = &input_;
    for (int level = 0; level <= kMaxLevels; ++level) {
        if (level > 0 && level <= parameters_.levels) {
            Levels& to = levels_[level % 2];
            if (!atrousLevel(guide, settings, 1 << (level - 1), {&(*from)[0], &(*from)[1]}, {&to[0], &to[1]}, context.stop))
                return nullptr;
            from = &to;
        }
        for (size_t c = 0; c < kComponents; ++c) {
            taps_.keepLevel(level, c == 1, (*from)[c]);
            if (level == feedback && level > 0) next.components[c].colour = (*from)[c].rgb;
        }
    }
    return from;
}

const Image& SvgfModule::tap(const std::string& name) const {
    const Image* found = taps_.find(name);
    return found ? *found : Module::tap(name);
}

size_t SvgfModule::byteCount() const {
    size_t sum = taps_.bytes() + antialiasing_.byteCount() + history_.byteCount([](const TemporalHistory& h) { return h.bytes(); });
    for (const Image* image : {&frame_.emission, &frame_.albedo, &frame_.direct, &frame_.indirect, &frame_.dropped}) sum += image->bytes();
    for (const Levels* levels : {&input_, &levels_[0], &levels_[1]})
        for (const Illumination& planes : *levels) sum += planes.bytes();
    return sum;
}

}  // namespace lumi
