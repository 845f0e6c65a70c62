#include "study/units.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "measure/measure.h"
#include "study/run_job.h"
#include "study/temporal_metrics.h"

namespace lumi {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// NaN if any value is.
double meanOf(const std::vector<double>& values) {
    double sum = 0;
    for (const double value : values) sum += value;
    return values.empty() ? kNaN : sum / static_cast<double>(values.size());
}

}  // namespace

StudyRowIndex::StudyRowIndex(const StudyRecords& records) {
    std::set<int> spp;
    std::set<size_t> scenes;
    for (const StudyRow& row : records.rows) {
        rows_[{row.method, row.spp}].push_back(&row);
        spp.insert(row.spp);
        scenes.insert(row.scene);
    }
    spp_.assign(spp.begin(), spp.end());
    scenes_.assign(scenes.begin(), scenes.end());
    if (scenes_.size() > 1) scenes_.push_back(kAllScenes);
}

const std::vector<const StudyRow*>& StudyRowIndex::of(size_t method, int spp) const {
    static const std::vector<const StudyRow*> none;
    const auto found = rows_.find({method, spp});
    return found == rows_.end() ? none : found->second;
}

std::vector<double> unitValues(const Study& study, const StudyRowIndex& rows, size_t scene, size_t method, int spp,
                               const std::string& metric, int64_t frame, ValueKind kind) {
    // Consecutive frames are no independent units for a metric of their differences.
    const bool byFrame = study.intervals.units == StudyIntervals::Units::FramesAndSeeds && !findTemporalMetric(metric);
    std::map<std::pair<int, int64_t>, std::map<size_t, std::vector<double>>> found;
    for (const StudyRow* row : rows.of(method, spp)) {
        if ((scene != kAllScenes && row->scene != scene) || (frame >= 0 && row->frame != frame)) continue;
        if (!row->metrics.contains(metric)) continue;
        const double value = kind == ValueKind::Corrected ? row->value(metric) : row->metrics.at(metric);
        found[{row->seed, byFrame ? row->frame : 0}][row->scene].push_back(std::isfinite(value) ? value : kNaN);
    }
    if (found.empty()) return {};
    std::vector<int64_t> frames{0};
    if (byFrame && frame < 0) frames = study.frames.measure;
    else if (byFrame) frames = {frame};
    std::vector<double> values;
    for (const int seed : study.seeds)
        for (const int64_t own : frames) {
            // Each scene counts alike, however many frames it has.
            std::vector<double> means;
            for (const auto& [index, all] : found[{seed, own}]) means.push_back(meanOf(all));
            values.push_back(meanOf(means));
        }
    return values;
}

int64_t countMissing(const std::vector<double>& values) {
    return std::count_if(values.begin(), values.end(), [](double value) { return !std::isfinite(value); });
}

double finiteMean(const std::vector<double>& values) {
    double sum = 0;
    int64_t count = 0;
    for (const double value : values)
        if (std::isfinite(value)) sum += value, ++count;
    return count ? sum / static_cast<double>(count) : kNaN;
}

std::vector<std::string> allMetrics(const Study& study) {
    std::vector<std::string> metrics = study.metrics;
    metrics.insert(metrics.end(), study.temporalMetrics.begin(), study.temporalMetrics.end());
    for (const StudyStatistic& statistic : study.statistics) metrics.push_back(statistic.name);
    return metrics;
}

std::string definitionOf(const Study& study, const std::string& metric) {
    if (const StudyStatistic* statistic = study.statistic(metric)) return statistic->definition;
    const TemporalMetric* temporal = findTemporalMetric(metric);
    std::string text = temporal ? temporal->definition : findMetric(metric).definition;
    if (metric == "relmse") text += fmt::format(" Here epsilon is {:g}.", study.metricSettings.relMseEpsilon);
    if (const auto& range = study.metricSettings.flipExposures; range && metric == "hdr_flip")
        text +=
            fmt::format(" Here the exposures are {} from {:g} to {:g} EV.", range->count, range->start, range->stop);
    if (isSquaredError(metric)) text += " The reference's own error is taken off.";
    return text;
}

std::string titleOf(const Study& study, const std::string& metric) {
    if (const StudyStatistic* statistic = study.statistic(metric)) return statistic->title;
    if (metric == "tracing_ns_per_ray") return "ns a ray, tracing alone";
    if (isTimeQuantity(metric))
        return metric == "frame_ms" ? "ms a frame" : metric == "run_ms" ? "ms of the method" : "ns a ray, whole frame";
    const TemporalMetric* temporal = findTemporalMetric(metric);
    return temporal ? temporal->title : findMetric(metric).title;
}

bool higherIsBetter(const Study& study, const std::string& metric) {
    if (const StudyStatistic* statistic = study.statistic(metric)) return statistic->higherIsBetter;
    if (isTimeQuantity(metric)) return false;
    return !findTemporalMetric(metric) && findMetric(metric).higherIsBetter;
}

IntervalMethod intervalMethod(const Study& study) {
    return study.intervals.method == StudyIntervals::Method::Bootstrap ? IntervalMethod::Bootstrap
                                                                       : IntervalMethod::StudentT;
}

}  // namespace lumi
