#include "filter/temporal.h"

#include <algorithm>
#include <cassert>

#include "base/parallel.h"

namespace lumi {
namespace {

constexpr int64_t kRows = 8;
constexpr float kLongestHistory = 4096;  ///< frames; counts stop there

float luminanceOf(const Image& rgb, int64_t i) {
    const int64_t area = rgb.extent().area();
    return 0.2126f * rgb.data()[i] + 0.7152f * rgb.data()[i + area] + 0.0722f * rgb.data()[i + 2 * area];
}

/// What a pixel's taps say together.
struct Past {
    float colour[3] = {0, 0, 0};
    float mean = 0;
    float sampleVariance = 0;
};

Past gather(const TemporalComponent& component, const ReprojectedTaps& taps) {
    Past past;
    const int64_t area = component.mean.extent().area();
    for (int k = 0; k < taps.count; ++k) {
        const int32_t at = taps.index[static_cast<size_t>(k)];
        const float weight = taps.weight[static_cast<size_t>(k)];
        for (int c = 0; c < 3; ++c) past.colour[c] += weight * component.colour.data()[at + c * area];
        past.mean += weight * component.mean.data()[at];
    }
    // The second moment of the taps together, about their common mean.
    for (int k = 0; k < taps.count; ++k) {
        const int32_t at = taps.index[static_cast<size_t>(k)];
        const float shift = component.mean.data()[at] - past.mean;
        past.sampleVariance += taps.weight[static_cast<size_t>(k)] * (component.sampleVariance.data()[at] + shift * shift);
    }
    return past;
}

class TemporalPass {
public:
    TemporalPass(const Signals& signals, const TemporalSettings& settings, const std::vector<const Image*>& samples,
                 const TemporalHistory* previous, TemporalHistory& next, Image* verdict)
        : signals_(signals), settings_(settings), samples_(samples), previous_(previous), next_(next), verdict_(verdict) {}

    void row(int y) const {
        const int width = signals_.extent().width;
        const Reprojection reprojection(signals_, previous_ ? previous_->surface : next_.surface, settings_.reprojection);
        for (int x = 0; x < width; ++x) {
            const bool sky = signals_.ids(Signal::ObjectId).at(0, x, y) == 0;
            ReprojectedTaps taps;
            if (previous_) taps = reprojection.taps(x, y);
            if (verdict_) verdict_->at(0, x, y) = previous_ || sky ? verdictValue(taps, sky) : 4.0f;
            integrate(static_cast<int64_t>(y) * width + x, taps, sky);
        }
    }

private:
    void integrate(int64_t i, const ReprojectedTaps& taps, bool sky) const {
        float length = 0;
        for (int k = 0; k < taps.count; ++k)
            length += taps.weight[static_cast<size_t>(k)] * previous_->length.data()[taps.index[static_cast<size_t>(k)]];
        length = sky ? 0 : std::min(length + 1, kLongestHistory);
        next_.length.data()[i] = length;
        const float least = settings_.arithmeticWarmUp && length > 0 ? 1 / length : 0;
        const float colourAlpha = taps.count == 0 ? 1 : std::max(settings_.colourAlpha, least);
        const float momentsAlpha = taps.count == 0 ? 1 : std::max(settings_.momentsAlpha, least);
        for (size_t n = 0; n < samples_.size(); ++n) {
            const Past past = taps.count == 0 ? Past{} : gather(previous_->components[n], taps);
            blend(i, *samples_[n], past, colourAlpha, momentsAlpha, next_.components[n]);
        }
    }

    /// C' = alpha C + (1 - alpha) C'(i-1), and the same for the moments about the mean.
    static void blend(int64_t i, const Image& sample, const Past& past, float colourAlpha, float momentsAlpha,
                      TemporalComponent& next) {
        const int64_t area = sample.extent().area();
        for (int c = 0; c < 3; ++c)
            next.colour.data()[i + c * area] = past.colour[c] + colourAlpha * (sample.data()[i + c * area] - past.colour[c]);
        const float difference = luminanceOf(sample, i) - past.mean;
        next.mean.data()[i] = past.mean + momentsAlpha * difference;
        next.sampleVariance.data()[i] = (1 - momentsAlpha) * (past.sampleVariance + momentsAlpha * difference * difference);
    }

    const Signals& signals_;
    const TemporalSettings& settings_;
    const std::vector<const Image*>& samples_;
    const TemporalHistory* previous_;
    TemporalHistory& next_;
    Image* verdict_;
};

}  // namespace

void TemporalSettings::describe(ParameterVisitor& v, bool moments) {
    v.number("color-alpha", colourAlpha,
             {.label = "Colour alpha",
              .min = 0.01,
              .max = 1,
              .scale = Scale::Log,
              .help = "Weight of the new sample in the integrated colour (sec. 4.1)"});
    if (moments)
        v.number("moments-alpha", momentsAlpha,
                 {.label = "Moments alpha",
                  .min = 0.01,
                  .max = 1,
                  .scale = Scale::Log,
                  .help = "Weight of the new sample in the luminance moments (sec. 4.2)"});
    v.toggle("arithmetic-warm-up", arithmeticWarmUp,
             {.label = "Arithmetic warm-up", .help = "Average the first frames in equal parts, 1/n, until 1/n falls below alpha"});
    reprojection.describe(v);
}

void TemporalHistory::reset(Extent2 extent, int count) {
    if (length.extent() == extent && components.size() == static_cast<size_t>(count)) return;
    components.resize(static_cast<size_t>(count));
    for (TemporalComponent& component : components) {
        component.colour.reset(extent, 3);
        component.mean.reset(extent, 1);
        component.sampleVariance.reset(extent, 1);
    }
    length.reset(extent, 1);
}

size_t TemporalHistory::bytes() const {
    size_t sum = length.bytes() + surface.bytes();
    for (const TemporalComponent& c : components) sum += c.colour.bytes() + c.mean.bytes() + c.sampleVariance.bytes();
    return sum;
}

bool filterTemporally(const Signals& signals, const TemporalSettings& settings, const std::vector<const Image*>& samples,
                      const TemporalHistory* previous, TemporalHistory& next, Image* verdict, std::stop_token stop) {
    const Extent2 extent = signals.extent();
    next.reset(extent, static_cast<int>(samples.size()));
    if (previous && (previous->length.extent() != extent || previous->components.size() != samples.size())) previous = nullptr;
    if (verdict) verdict->reset(extent, 1);
    next.surface.copyFrom(signals);
    const TemporalPass pass(signals, settings, samples, previous, next, verdict);
    parallelRanges(extent.height, kRows, [&](int64_t begin, int64_t end) {
        for (int y = static_cast<int>(begin); y < end; ++y) pass.row(y);
    }, stop);
    return !stop.stop_requested();
}

}  // namespace lumi
