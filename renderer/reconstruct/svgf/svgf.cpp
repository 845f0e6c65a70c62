#include "reconstruct/svgf/svgf.h"

#include <algorithm>
#include <limits>

#include "filter/orthographic_guide.h"
#include "reconstruct/lineage_rows.h"
#include "reconstruct/svgf/svgf_taps.h"

namespace lumi {

namespace {

std::vector<Tap> joined(std::vector<Tap> taps, const std::vector<Tap>& own) {
    taps.insert(taps.end(), own.begin(), own.end());
    return taps;
}

}  // namespace

SvgfModule::SvgfModule() : SvgfModule(std::vector<Tap>{}) {}
SvgfModule::SvgfModule(const std::vector<Tap>& own) : ScreenFilter(joined(svgfTaps(kMaxLevels), own), true) {}

SignalSet SvgfModule::reads() const { return commonSignals() | reprojectionSignals() | surfaceGuideSignals(); }

AtrousSettings SvgfModule::atrousSettings() const {
    AtrousSettings settings = parameters_.atrous;
    settings.edges.planeDistance = parameters_.depthWeight == DepthWeight::PlaneDistance;
    return settings;
}

bool SvgfModule::filter(const FrameContext& context, const Step& step, Image& out) {
    // 4.1 temporal filtering, 4.2 variance estimation, 4.3 wavelet transform.
    keepInput(captured(), frame());
    if (!integrate(context, step)) return false;
    if (!estimateVariance(context, step.next)) return false;
    const Levels* filtered = filterSpatially(context);
    if (!filtered) return false;
    // 3: modulate again.
    const auto measured = context.timer.measure("modulation");
    remodulate(frame(), (*filtered)[0].rgb, &(*filtered)[1].rgb, out);
    handOver(step.next);
    return true;
}

bool SvgfModule::integrate(const FrameContext& context, const Step& step) {
    TemporalOptions options = temporalOptions(frame(), captured());
    options.luminance = {&input_[0].luminance, &input_[1].luminance};
    HistoryLoss& loss = options.loss;
    if (!estimateLoss(context, loss)) return false;
    const auto measured = context.timer.measure("temporal filter");
    for (Illumination& planes : input_) planes.reset(extent());
    if (!filterTemporally(context.signals, parameters_.temporal, {&frame().direct, &frame().indirect}, step.previous,
                          step.next, context.stop, options))
        return false;
    keepIntegrated(captured(), step.next);
    if (Lineage* lineage = inspected()) {
        if (loss.empty())
            addHistoryRows(*lineage, context.signals, step.previous, parameters_.temporal, options.dropped);
        for (size_t c = 0; c < loss.size(); ++c)
            addHistoryRows(*lineage, context.signals, step.previous, parameters_.temporal, options.dropped,
                           c == 0 ? "direct, history" : "indirect, history", loss[c]);
    }
    // The integrated colour moves on; handOver() gives the history what it is to keep.
    for (size_t c = 0; c < kComponents; ++c) std::swap(input_[c].rgb, step.next.components[c].colour);
    return true;
}

void SvgfModule::handOver(TemporalHistory& next) {
    Levels& kept = feedbackLevel() > 0 ? feedback_ : input_;
    for (size_t c = 0; c < kComponents; ++c) std::swap(kept[c].rgb, next.components[c].colour);
}

SurfaceGuide SvgfModule::surfaceGuideOf(const FrameContext& context) {
    if (context.camera.projection == Projection::Perspective) return surfaceGuide(context.signals);
    return orthographicGuide(context.signals, 2 * context.camera.halfHeight, depth_);
}

bool SvgfModule::estimateVariance(const FrameContext& context, const TemporalHistory& integrated) {
    const auto measured = context.timer.measure("variance estimation");
    const SurfaceGuide guide = surfaceGuideOf(context);
    const float least = parameters_.varianceSource == VarianceSource::Spatial
                            ? std::numeric_limits<float>::max()
                            : static_cast<float>(parameters_.spatialVarianceFrames);
    std::vector<MomentPlanes> planes;
    for (size_t c = 0; c < kComponents; ++c) {
        const TemporalComponent& component = integrated.components[c];
        planes.push_back({component.mean.data(), component.sampleVariance.data(), input_[c].sampleVariance.data()});
    }
    return estimateVarianceSpatially(guide, atrousSettings().edges, integrated.length.data(), least, planes,
                                     context.stop);
}

const SvgfModule::Levels* SvgfModule::filterSpatially(const FrameContext& context) {
    const auto measured = context.timer.measure("wavelet filter");
    const SurfaceGuide guide = surfaceGuideOf(context);
    const AtrousSettings settings = atrousSettings();
    keepEdgeWeights(captured(), guide, settings, input_[0], input_[1]);
    const Levels* from = &input_;
    for (int level = 0; level <= kMaxLevels; ++level) {
        if (level > 0 && level <= parameters_.levels) {
            Levels& to = level == feedbackLevel() ? feedback_ : levels_[level % 2];
            for (size_t c = 0; c < kComponents && inspected(); ++c)
                addAtrousRows(*inspected(), (c == 0 ? "direct, level " : "indirect, level ") + std::to_string(level),
                              guide, settings, (*from)[c], 1 << (level - 1));
            if (!atrousLevel(guide, settings, 1 << (level - 1), {&(*from)[0], &(*from)[1]}, {&to[0], &to[1]},
                             context.stop))
                return nullptr;
            from = &to;
        }
        for (size_t c = 0; c < kComponents; ++c) keepLevel(captured(), level, c == 1, (*from)[c]);
    }
    return from;
}

size_t SvgfModule::byteCount() const {
    size_t sum = ScreenFilter::byteCount() + depth_.bytes();
    for (const Levels* levels : {&input_, &levels_[0], &levels_[1], &feedback_})
        for (const Illumination& planes : *levels) sum += planes.bytes();
    return sum;
}

}  // namespace lumi
