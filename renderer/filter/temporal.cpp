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

/// Scratch of one task.
struct TemporalRow {
    ReprojectedRow taps;
    std::vector<float> colourAlphas, momentsAlphas;
};

class TemporalPass {
public:
    TemporalPass(const Signals& signals, const TemporalSettings& settings, const std::vector<const Image*>& samples,
                 const TemporalHistory* previous, TemporalHistory& next, Image* verdict, const HistoryLoss& loss)
        : signals_(signals), settings_(settings), samples_(samples), previous_(previous), next_(next), verdict_(verdict), loss_(loss),
          reprojection_(signals, previous ? previous->surface : next.surface, settings.reprojection) {}

    void row(int y, TemporalRow& scratch) const {
        const int width = signals_.extent().width;
        scratch.colourAlphas.resize(static_cast<size_t>(width));
        scratch.momentsAlphas.resize(static_cast<size_t>(width));
        if (verdict_) judge(y);
        if (!previous_) return integrate(y, 0, width, {}, scratch);
        reprojection_.row(y, scratch.taps);
        const auto follows = [&taps = scratch.taps](int x) {
            const auto at = static_cast<size_t>(x);
            bool all = true;
            for (const auto& index : taps.index) all = all && index[at] == index[at - 1] + 1;
            return all;
        };
        forIndexRuns(0, width, follows, [&](int from, int to, bool inARow) {
            integrate(y, from, to - from, tapsOf(scratch.taps, from, inARow), scratch);
        });
        if (!settings_.reprojection.wideFallback) return;
        for (int x = 0; x < width; ++x) {
            if (!scratch.taps.lost(x)) continue;
            const ReprojectedTaps wide = reprojection_.widen(x, y);
            if (wide.count > 0) integrate(y, x, 1, tapsOf(wide), scratch);
        }
    }

private:
    void judge(int y) const {
        for (int x = 0; x < signals_.extent().width; ++x) {
            const bool sky = signals_.ids(Signal::ObjectId).at(0, x, y) == 0;
            verdict_->at(0, x, y) = previous_ ? verdictValue(reprojection_.taps(x, y), sky) : sky ? 0.0f : 4.0f;
        }
    }

    /// Pixels [x, x + count) of row y.
    void integrate(int y, int x, int count, const HistoryTaps& taps, TemporalRow& scratch) const {
        const int64_t at = static_cast<int64_t>(y) * signals_.extent().width + x;
        HistoryLengthRow lengths{count, taps, previous_ ? previous_->length.data() : nullptr, signals_.ids(Signal::ObjectId).data() + at,
                                 settings_.colourAlpha, settings_.momentsAlpha, kLongestHistory, settings_.arithmeticWarmUp,
                                 next_.length.data() + at, scratch.colourAlphas.data(), scratch.momentsAlphas.data()};
        const TemporalKernels& kernels = temporalKernels();
        for (size_t n = 0; n < samples_.size(); ++n) {
            if (n == 0 || !loss_.empty()) kernels.lengthRow(lengths);
            if (!loss_.empty()) {
                kernels.adaptRow(loss_[n]->data() + at, lengths.colourAlphas, count);
                kernels.adaptRow(loss_[n]->data() + at, lengths.momentsAlphas, count);
            }
            integrateComponent(at, lengths, n);
        }
        if (!loss_.empty()) shorten(at, count);
    }

    void integrateComponent(int64_t at, const HistoryLengthRow& lengths, size_t n) const {
        const Image& sample = *samples_[n];
        TemporalComponent& to = next_.components[n];
        IntegrationRow row;
        row.count = lengths.count;
        row.taps = lengths.taps;
        for (int c = 0; c < 3; ++c) {
            row.previousColour[c] = previous_ ? previous_->components[n].colour.plane(c).data : nullptr;
            row.sample[c] = sample.plane(c).data + at;
            row.colour[c] = to.colour.plane(c).data + at;
        }
        row.previousMean = previous_ ? previous_->components[n].mean.data() : nullptr;
        row.previousVariance = previous_ ? previous_->components[n].sampleVariance.data() : nullptr;
        row.colourAlphas = lengths.colourAlphas;
        row.momentsAlphas = lengths.momentsAlphas;
        row.mean = to.mean.data() + at;
        row.variance = to.sampleVariance.data() + at;
        temporalKernels().integrateRow(row);
    }

    /// What was given up is not part of the history any more.
    void shorten(int64_t at, int count) const {
        for (int64_t i = at; i < at + count; ++i) {
            float most = 0;
            for (const Image* lambda : loss_) most = std::max(most, lambda->data()[i]);
            float& length = next_.length.data()[i];
            length = length > 0 ? 1 + (1 - most) * (length - 1) : 0;
        }
    }

    const Signals& signals_;
    const TemporalSettings& settings_;
    const std::vector<const Image*>& samples_;
    const TemporalHistory* previous_;
    TemporalHistory& next_;
    Image* verdict_;
    const HistoryLoss& loss_;
    const Reprojection reprojection_;
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
    surface.reset(extent);
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
                      const TemporalHistory* previous, TemporalHistory& next, Image* verdict, std::stop_token stop,
                      const HistoryLoss& loss) {
    const Extent2 extent = signals.extent();
    assert(loss.empty() || loss.size() == samples.size());
    next.reset(extent, static_cast<int>(samples.size()));
    if (previous && (previous->length.extent() != extent || previous->components.size() != samples.size())) previous = nullptr;
    if (verdict) verdict->reset(extent, 1);
    const TemporalPass pass(signals, settings, samples, previous, next, verdict, loss);
    parallelRanges(extent.height, kRows, [&](int64_t begin, int64_t end) {
        TemporalRow scratch;
        next.surface.copyRows(signals, static_cast<int>(begin), static_cast<int>(end));
        for (int y = static_cast<int>(begin); y < end; ++y) pass.row(y, scratch);
    }, stop);
    return !stop.stop_requested();
}

}  // namespace lumi
