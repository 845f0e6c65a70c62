#include "filter/temporal.h"

#include <algorithm>
#include <cassert>

#include "base/parallel.h"
#include "filter/index_runs.h"
#include "filter/temporal_kernels.h"

namespace lumi {
namespace {

constexpr int64_t kRows = 8;
constexpr float kLongestHistory = 4096;  ///< frames; counts stop there

/// From pixel x on.
HistoryTaps tapsOf(const ReprojectedRow& row, int x, bool inARow) {
    HistoryTaps taps{4, inARow, {}, {}};
    for (int k = 0; k < 4; ++k) {
        taps.index[k] = row.index[k].data() + x;
        taps.weight[k] = row.weight[k].data() + x;
    }
    return taps;
}

/// Of one pixel; those that are not there have weight 0.
HistoryTaps tapsOf(const ReprojectedTaps& pixel) {
    HistoryTaps taps{HistoryTaps::kMost, false, {}, {}};
    for (size_t k = 0; k < HistoryTaps::kMost; ++k) {
        taps.index[k] = &pixel.index[k];
        taps.weight[k] = &pixel.weight[k];
    }
    return taps;
}

constexpr int kBlock = 512;  ///< pixels whose taps stay in the first-level cache

/// Scratch of one task.
struct TemporalBlock {
    ReprojectedRow taps{kBlock};
    float colourAlphas[kBlock], momentsAlphas[kBlock];
    float adaptedColourAlphas[kBlock], adaptedMomentsAlphas[kBlock];  ///< of one component, with its loss
};

class TemporalPass {
public:
    TemporalPass(const Signals& signals, const TemporalSettings& settings, const std::vector<const Image*>& samples,
                 const TemporalHistory* previous, TemporalHistory& next, const TemporalOptions& options)
        : signals_(signals),
          settings_(settings),
          samples_(samples),
          previous_(previous),
          next_(next),
          options_(options),
          reprojection_(signals, previous ? previous->surface : next.surface, settings.reprojection) {}

    void row(int y, TemporalBlock& scratch) const {
        const int width = signals_.extent().width;
        for (int first = 0; first < width; first += kBlock) block(y, first, std::min(first + kBlock, width), scratch);
    }

private:
    void block(int y, int first, int last, TemporalBlock& scratch) const {
        if (!previous_) {
            integrate(y, first, last - first, {}, scratch);
            for (int x = first; x < last && options_.verdicts.wanted(); ++x) judge(x, y, {}, {});
            return;
        }
        const ReprojectedRow& taps = scratch.taps;
        const bool anyLost = reprojection_.row(y, first, last, scratch.taps) > 0;
        const int count = last - first;
        if (taps.inARow(count)) integrate(y, first, count, tapsOf(taps, 0, true), scratch);
        else
            forIndexRuns(
                0, count, [&taps](int k) { return taps.follows(k); },
                [&](int from, int to, bool inARow) {
                    integrate(y, first + from, to - from, tapsOf(taps, from, inARow), scratch);
                });
        const bool judged = options_.verdicts.wanted();
        for (int k = 0; k < count && (anyLost || judged); ++k) {
            ReprojectedTaps wide;
            if (anyLost && taps.lost(k)) wide = reprojection_.widen(first + k, y);
            if (wide.count > 0) integrate(y, first + k, 1, tapsOf(wide), scratch);
            if (judged) judge(first + k, y, taps.pixel(k), wide);
        }
    }

    void judge(int x, int y, const ReprojectedTaps& taps, const ReprojectedTaps& wide) const {
        const bool sky = signals_.ids(Signal::ObjectId).at(0, x, y) == 0;
        const auto& [verdict, refusals] = options_.verdicts;
        if (verdict) verdict->at(0, x, y) = previous_ ? verdictValue(wide.wide ? wide : taps, sky) : sky ? 0.0f : 4.0f;
        if (!refusals) return;
        const std::array<float, 4> masks = sky ? std::array<float, 4>{} : refusalMasks(taps.refusals);
        for (int r = 0; r < 4; ++r) refusals->at(r, x, y) = masks[static_cast<size_t>(r)];
    }

    /// Pixels [x, x + count) of row y.
    void integrate(int y, int x, int count, const HistoryTaps& taps, TemporalBlock& scratch) const {
        const int64_t at = static_cast<int64_t>(y) * signals_.extent().width + x;
        const TemporalKernels& kernels = temporalKernels();
        kernels.lengthRow({count, taps, previous_ ? previous_->length.data() : nullptr,
                           signals_.ids(Signal::ObjectId).data() + at, settings_.colourAlpha, settings_.momentsAlpha,
                           kLongestHistory, settings_.arithmeticWarmUp, next_.length.data() + at, scratch.colourAlphas,
                           scratch.momentsAlphas});
        if (options_.dropped) keepHistory(at, count, scratch);
        for (size_t n = 0; n < samples_.size(); ++n) {
            IntegrationRow row = rowOf(at, n);
            row.count = count;
            row.taps = taps;
            row.colourAlphas = scratch.colourAlphas;
            row.momentsAlphas = scratch.momentsAlphas;
            if (!options_.loss.empty()) {
                const float* lambda = options_.loss[n]->data() + at;
                kernels.adaptRow(lambda, scratch.colourAlphas, scratch.adaptedColourAlphas, count);
                kernels.adaptRow(lambda, scratch.momentsAlphas, scratch.adaptedMomentsAlphas, count);
                row.colourAlphas = scratch.adaptedColourAlphas;
                row.momentsAlphas = scratch.adaptedMomentsAlphas;
            }
            kernels.integrateRow(row);
        }
        if (!options_.loss.empty()) shorten(at, count);
    }

    /// The planes of component n from pixel `at` on.
    IntegrationRow rowOf(int64_t at, size_t n) const {
        TemporalComponent& to = next_.components[n];
        IntegrationRow row;
        for (int c = 0; c < 3; ++c) {
            row.previousColour[c] = previous_ ? previous_->components[n].colour.plane(c).data : nullptr;
            row.sample[c] = samples_[n]->plane(c).data + at;
            row.colour[c] = to.colour.plane(c).data + at;
        }
        if (!options_.luminance.empty()) row.luminance = options_.luminance[n]->data() + at;
        if (!settings_.moments) return row;
        row.previousMean = previous_ ? previous_->components[n].mean.data() : nullptr;
        row.previousVariance = previous_ ? previous_->components[n].sampleVariance.data() : nullptr;
        row.mean = to.mean.data() + at;
        row.variance = to.sampleVariance.data() + at;
        return row;
    }

    /// Samples that are no measurement count nothing where there is a history.
    void keepHistory(int64_t at, int count, TemporalBlock& scratch) const {
        const float* dropped = options_.dropped->data() + at;
        float* length = next_.length.data() + at;
        for (int k = 0; k < count; ++k)
            if (dropped[k] != 0 && length[k] > 1)
                scratch.colourAlphas[k] = scratch.momentsAlphas[k] = 0, length[k] -= 1;
    }

    /// What was given up is not part of the history any more.
    void shorten(int64_t at, int count) const {
        for (int64_t i = at; i < at + count; ++i) {
            float most = 0;
            for (const Image* lambda : options_.loss) most = std::max(most, lambda->data()[i]);
            float& length = next_.length.data()[i];
            length = length > 0 ? 1 + (1 - most) * (length - 1) : 0;
        }
    }

    const Signals& signals_;
    const TemporalSettings& settings_;
    const std::vector<const Image*>& samples_;
    const TemporalHistory* previous_;
    TemporalHistory& next_;
    const TemporalOptions& options_;
    const Reprojection reprojection_;
};

}  // namespace

void TemporalSettings::describe(ParameterVisitor& v) {
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
             {.label = "Arithmetic warm-up",
              .help = "Average the first frames in equal parts, 1/n, until 1/n falls below alpha"});
    reprojection.describe(v);
}

void TemporalHistory::reset(Extent2 extent, int count, bool moments) {
    surface.reset(extent);
    const Extent2 ofMoments = moments ? extent : Extent2{};
    const auto fits = [&](const TemporalComponent& c) { return c.mean.extent() == ofMoments; };
    if (length.extent() == extent && components.size() == static_cast<size_t>(count) &&
        std::all_of(components.begin(), components.end(), fits))
        return;
    components.resize(static_cast<size_t>(count));
    for (TemporalComponent& component : components) {
        component.colour.reset(extent, 3);
        component.mean.reset(ofMoments, 1);
        component.sampleVariance.reset(ofMoments, 1);
    }
    length.reset(extent, 1);
}

size_t TemporalHistory::bytes() const {
    size_t sum = length.bytes() + surface.bytes();
    for (const TemporalComponent& c : components) sum += c.colour.bytes() + c.mean.bytes() + c.sampleVariance.bytes();
    return sum;
}

bool filterTemporally(const Signals& signals, const TemporalSettings& settings,
                      const std::vector<const Image*>& samples, const TemporalHistory* previous, TemporalHistory& next,
                      std::stop_token stop, const TemporalOptions& options) {
    const Extent2 extent = signals.extent();
    assert(options.loss.empty() || options.loss.size() == samples.size());
    next.reset(extent, static_cast<int>(samples.size()), settings.moments);
    if (previous && (previous->length.extent() != extent || previous->components.size() != samples.size()))
        previous = nullptr;
    if (options.verdicts.verdict) options.verdicts.verdict->reset(extent, 1);
    if (options.verdicts.refusals) options.verdicts.refusals->reset(extent, 4);
    for (Image* plane : options.luminance)
        if (plane->extent() != extent) plane->reset(extent, 1);
    const TemporalPass pass(signals, settings, samples, previous, next, options);
    parallelRanges(
        extent.height, kRows,
        [&](int64_t begin, int64_t end) {
            TemporalBlock scratch;
            next.surface.copyRows(signals, static_cast<int>(begin), static_cast<int>(end));
            for (int y = static_cast<int>(begin); y < end; ++y) pass.row(y, scratch);
        },
        stop);
    return !stop.stop_requested();
}

}  // namespace lumi
