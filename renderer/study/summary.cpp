#include "study/summary.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "measure/measure.h"
#include "study/run_job.h"
#include "study/temporal_metrics.h"

namespace lumi {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

double meanOf(const std::vector<double>& values) {
    double sum = 0;
    for (const double value : values) sum += value;
    return values.empty() ? kNaN : sum / static_cast<double>(values.size());
}

std::vector<std::string> metricsOf(const Study& study) {
    std::vector<std::string> metrics = study.metrics;
    metrics.insert(metrics.end(), study.temporalMetrics.begin(), study.temporalMetrics.end());
    return metrics;
}

/// The uncorrected mean over everything that goes into a summary.
double plainMean(const StudyRowIndex& rows, size_t scene, size_t method, int spp, const std::string& metric, int64_t frame) {
    std::vector<double> values;
    for (const StudyRow* row : rows.of(method, spp))
        if ((scene == kAllScenes || row->scene == scene) && (frame < 0 || row->frame == frame) && row->metrics.contains(metric))
            values.push_back(row->metrics.at(metric));
    return meanOf(values);
}

void addMeans(const Study& study, const StudyPlan& plan, const StudyRowIndex& rows, StudySummaries& all) {
    for (const size_t scene : rows.scenes())
        for (const int spp : rows.spp())
            for (size_t method = 0; method < plan.methods.size(); ++method)
                for (const std::string& metric : metricsOf(study)) {
                    const auto add = [&](int64_t frame, std::vector<StudySummary>& list) {
                        const std::vector<double> values = unitValues(study, rows, scene, method, spp, metric, frame);
                        if (values.empty()) return;
                        list.push_back({scene, method, spp, metric, frame,
                                        meanInterval(values, study.intervals.level, intervalMethod(study)),
                                        plainMean(rows, scene, method, spp, metric, frame)});
                    };
                    add(-1, all.metrics);
                    if (scene == kAllScenes || study.frames.measure.size() < 2) continue;
                    for (const int64_t frame : study.frames.measure) add(frame, all.frames);
                }
}

void addRankings(const Study& study, const StudyPlan& plan, const StudyRowIndex& rows, StudySummaries& all) {
    for (const size_t scene : rows.scenes())
        for (const int spp : rows.spp())
            for (const std::string& metric : metricsOf(study)) {
                std::vector<size_t> methods;
                std::vector<std::vector<double>> values;
                for (size_t method = 0; method < plan.methods.size(); ++method) {
                    std::vector<double> own = unitValues(study, rows, scene, method, spp, metric);
                    if (own.empty() || (!values.empty() && own.size() != values.front().size())) continue;
                    methods.push_back(method);
                    values.push_back(std::move(own));
                }
                if (methods.size() < 2) continue;
                const bool higher = higherIsBetter(metric);
                const std::vector<Rank> ranks = rankMethods(values, higher, study.intervals.level, intervalMethod(study));
                std::vector<size_t> order(methods.size());
                for (size_t i = 0; i < order.size(); ++i) order[i] = i;
                std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) {
                    const double x = meanOf(values[a]), y = meanOf(values[b]);
                    return higher ? x > y : x < y;
                });
                StudyRanking ranking{scene, spp, metric, {}};
                for (const size_t i : order)
                    ranking.places.push_back({methods[i], ranks[i],
                                              i == order[0] ? Interval{}
                                                            : pairedInterval(values[i], values[order[0]], study.intervals.level,
                                                                             intervalMethod(study))});
                all.rankings.push_back(std::move(ranking));
            }
}

/// A seed's value of a metric at each number of samples that a method ran with.
struct Curve {
    std::vector<double> spp, value;
};

std::vector<Curve> seedCurves(const Study& study, const StudyRowIndex& rows, size_t scene, size_t method,
                              const std::string& metric) {
    std::vector<Curve> curves;
    for (const int seed : study.seeds) {
        Curve curve;
        for (const int spp : rows.spp()) {
            std::vector<double> values;
            for (const StudyRow* row : rows.of(method, spp))
                if (row->scene == scene && row->seed == seed && !std::isnan(row->value(metric)))
                    values.push_back(row->value(metric));
            if (values.empty()) continue;
            curve.spp.push_back(spp);
            curve.value.push_back(meanOf(values));
        }
        if (!curve.spp.empty()) curves.push_back(std::move(curve));
    }
    return curves;
}

void addSlopes(const Study& study, const StudyPlan& plan, const StudyRowIndex& rows, StudySummaries& all) {
    for (const size_t scene : rows.scenes())
        for (size_t method = 0; method < plan.methods.size(); ++method)
            for (const std::string& metric : study.metrics) {
                if (scene == kAllScenes || higherIsBetter(metric)) continue;
                std::vector<double> slopes;
                for (const Curve& curve : seedCurves(study, rows, scene, method, metric))
                    if (const double slope = logLogSlope(curve.spp, curve.value); curve.spp.size() > 2 && !std::isnan(slope))
                        slopes.push_back(slope);
                if (!slopes.empty())
                    all.slopes.push_back({scene, method, metric, meanInterval(slopes, study.intervals.level, intervalMethod(study))});
            }
}

/// Samples at which `curve` has the value; beyond its last, by the square of the error falling as 1/n.
double samplesFor(const Curve& curve, double value, bool root, bool& extrapolated) {
    std::vector<double> errors(curve.value.rbegin(), curve.value.rend()), spp(curve.spp.rbegin(), curve.spp.rend());
    if (value < errors.front() && errors.front() > 0 && value > 0) {
        extrapolated = true;
        return spp.front() * std::pow(errors.front() / value, root ? 2 : 1);
    }
    return logLogAt(errors, spp, value);
}

void addEquivalents(const Study& study, const StudyPlan& plan, const StudyRowIndex& rows, StudySummaries& all) {
    for (const StudyPair& pair : study.pairs)
        for (size_t method = 0; method < plan.methods.size(); ++method)
            for (size_t other = 0; other < plan.methods.size(); ++other)
                for (const size_t scene : rows.scenes())
                    for (const std::string& metric : study.metrics) {
                        if (study.entries[plan.methods[method].entry].name != pair.entry ||
                            study.entries[plan.methods[other].entry].name != pair.against || scene == kAllScenes ||
                            !isSquaredError(metric))
                            continue;
                        const std::vector<Curve> own = seedCurves(study, rows, scene, method, metric);
                        const std::vector<Curve> against = seedCurves(study, rows, scene, other, metric);
                        if (own.size() != against.size() || own.empty()) continue;
                        for (size_t point = 0; point < own[0].spp.size(); ++point) {
                            StudyEquivalent result{scene, method, other, static_cast<int>(own[0].spp[point]), metric, {}, false};
                            std::vector<double> samples;
                            for (size_t seed = 0; seed < own.size(); ++seed)
                                samples.push_back(samplesFor(against[seed], own[seed].value[point], metric == "rmse",
                                                             result.extrapolated));
                            result.samples = meanInterval(samples, study.intervals.level, intervalMethod(study));
                            if (!std::isnan(result.samples.mean)) all.equivalents.push_back(result);
                        }
                    }
}

}  // namespace

bool higherIsBetter(const std::string& metric) {
    return !findTemporalMetric(metric) && findMetric(metric).higherIsBetter;
}

IntervalMethod intervalMethod(const Study& study) {
    return study.intervals.method == StudyIntervals::Method::Bootstrap ? IntervalMethod::Bootstrap : IntervalMethod::StudentT;
}

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
                               const std::string& metric, int64_t frame) {
    // Consecutive frames are no independent units for a metric of their differences.
    const bool byFrame = study.intervals.units == StudyIntervals::Units::FramesAndSeeds && !findTemporalMetric(metric);
    std::map<std::pair<int, int64_t>, std::map<size_t, std::vector<double>>> units;
    for (const StudyRow* row : rows.of(method, spp)) {
        if ((scene != kAllScenes && row->scene != scene) || (frame >= 0 && row->frame != frame)) continue;
        const double value = row->value(metric);
        if (!std::isnan(value)) units[{row->seed, byFrame ? row->frame : 0}][row->scene].push_back(value);
    }
    std::vector<double> values;
    for (const auto& [unit, scenes] : units) {
        // Each scene counts alike, however many frames it has.
        std::vector<double> means;
        for (const auto& [index, own] : scenes) means.push_back(meanOf(own));
        values.push_back(meanOf(means));
    }
    return values;
}

StudySummaries summarize(const Study& study, const StudyPlan& plan, const StudyRecords& records) {
    StudySummaries all;
    const StudyRowIndex rows(records);
    addMeans(study, plan, rows, all);
    addRankings(study, plan, rows, all);
    addSlopes(study, plan, rows, all);
    addEquivalents(study, plan, rows, all);
    all.biases = separateBiases(study, plan, records);
    return all;
}

}  // namespace lumi
