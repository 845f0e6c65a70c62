#include "study/summary.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "study/run_job.h"

namespace lumi {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

Interval intervalOf(const Study& study, const std::vector<double>& values) {
    return meanInterval(values, study.intervals.level, intervalMethod(study));
}

void addMeans(const Study& study, const StudyPlan& plan, const StudyRowIndex& rows, StudySummaries& all) {
    for (const size_t scene : rows.scenes())
        for (const int spp : rows.spp())
            for (size_t method = 0; method < plan.methods.size(); ++method)
                for (const std::string& metric : allMetrics(study)) {
                    const auto add = [&](int64_t frame, std::vector<StudySummary>& list) {
                        const std::vector<double> values = unitValues(study, rows, scene, method, spp, metric, frame);
                        if (values.empty()) return;
                        list.push_back({scene, method, spp, metric, frame, intervalOf(study, values),
                                        finiteMean(unitValues(study, rows, scene, method, spp, metric, frame,
                                                              ValueKind::Measured)),
                                        countMissing(values)});
                    };
                    add(-1, all.metrics);
                    if (scene == kAllScenes || study.frames.measure.size() < 2) continue;
                    for (const int64_t frame : study.frames.measure) add(frame, all.frames);
                }
}

/// Of the entries; what stages are worth is another question.
void addRankings(const Study& study, const StudyPlan& plan, const StudyRowIndex& rows, StudySummaries& all) {
    for (const size_t scene : rows.scenes())
        for (const int spp : rows.spp())
            for (const std::string& metric : allMetrics(study)) {
                std::vector<size_t> methods;
                std::vector<std::vector<double>> values;
                for (size_t method = 0; method < plan.methods.size(); ++method) {
                    std::vector<double> own = unitValues(study, rows, scene, method, spp, metric);
                    if (plan.methods[method].whole || countMissing(own) == static_cast<int64_t>(own.size())) continue;
                    methods.push_back(method);
                    values.push_back(std::move(own));
                }
                if (methods.size() < 2) continue;
                const bool higher = higherIsBetter(study, metric);
                const std::vector<Rank> ranks =
                    rankMethods(values, higher, study.intervals.level, intervalMethod(study));
                std::vector<size_t> order(methods.size());
                for (size_t i = 0; i < order.size(); ++i) order[i] = i;
                std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) {
                    const double x = finiteMean(values[a]), y = finiteMean(values[b]);
                    return higher ? x > y : x < y;
                });
                StudyRanking ranking{scene, spp, metric, {}};
                for (const size_t i : order)
                    ranking.places.push_back({methods[i], ranks[i],
                                              i == order[0]
                                                  ? Interval{}
                                                  : pairedInterval(values[i], values[order[0]], study.intervals.level,
                                                                   intervalMethod(study))});
                all.rankings.push_back(std::move(ranking));
            }
}

void addSlopes(const Study& study, const StudyPlan& plan, const StudyRowIndex& rows, StudySummaries& all) {
    for (const size_t scene : rows.scenes())
        for (size_t method = 0; method < plan.methods.size(); ++method)
            for (const std::string& metric : study.metrics) {
                if (scene == kAllScenes || higherIsBetter(study, metric)) continue;
                std::vector<double> slopes;
                for (const SeedCurve& curve : seedCurves(study, rows, scene, method, metric))
                    slopes.push_back(curve.spp.size() > 2 ? logLogSlope(curve.spp, curve.value) : kNaN);
                const Interval slope = intervalOf(study, slopes);
                if (slope.count > 0) all.slopes.push_back({scene, method, metric, slope});
            }
}

/// Samples at which `curve` has the value; beyond its last, by the square of the error falling as 1/n.
double samplesFor(const SeedCurve& curve, double value, bool root, bool& extrapolated) {
    const double last = curve.value.back();
    if (value < last && last > 0 && value > 0) {
        extrapolated = true;
        return curve.spp.back() * std::pow(last / value, root ? 2 : 1);
    }
    return logLogAt(curve.value, curve.spp, value, Course::Falling);
}

void addEquivalents(const Study& study, const StudyPlan& plan, const StudyRowIndex& rows, StudySummaries& all) {
    for (const StudyPair& pair : study.pairs)
        for (size_t method = 0; method < plan.methods.size(); ++method)
            for (size_t other = 0; other < plan.methods.size(); ++other)
                for (const size_t scene : rows.scenes())
                    for (const std::string& metric : study.metrics) {
                        if (study.entries[plan.methods[method].entry].name != pair.entry || pair.against.size() != 1 ||
                            study.entries[plan.methods[other].entry].name != pair.against[0] || scene == kAllScenes ||
                            plan.methods[method].whole || plan.methods[other].whole || !isSquaredError(metric))
                            continue;
                        const std::vector<SeedCurve> own = seedCurves(study, rows, scene, method, metric);
                        const std::vector<SeedCurve> against = seedCurves(study, rows, scene, other, metric);
                        if (own.empty() || own[0].spp.empty() || against[0].spp.empty()) continue;
                        for (size_t point = 0; point < own[0].spp.size(); ++point) {
                            StudyEquivalent result{scene,  method, other, static_cast<int>(own[0].spp[point]),
                                                   metric, {},     false};
                            std::vector<double> samples;
                            for (size_t seed = 0; seed < own.size(); ++seed)
                                samples.push_back(samplesFor(against[seed], own[seed].value[point], metric == "rmse",
                                                             result.extrapolated));
                            result.samples = intervalOf(study, samples);
                            if (result.samples.count > 0) all.equivalents.push_back(result);
                        }
                    }
}

/// Each stage of an ablation against the whole entry, on the same samples where the stage leaves them alone.
void addStages(const Study& study, const StudyPlan& plan, const StudyRowIndex& rows, StudySummaries& all) {
    for (const size_t scene : rows.scenes())
        for (const int spp : rows.spp())
            for (size_t method = 0; method < plan.methods.size(); ++method) {
                if (!plan.methods[method].whole) continue;
                const size_t whole = *plan.methods[method].whole;
                for (const std::string& metric : allMetrics(study)) {
                    const std::vector<double> with = unitValues(study, rows, scene, whole, spp, metric);
                    const std::vector<double> without = unitValues(study, rows, scene, method, spp, metric);
                    if (with.empty() || without.empty()) continue;
                    all.stages.push_back({scene, whole, method, spp, metric, intervalOf(study, with),
                                          intervalOf(study, without),
                                          pairedInterval(without, with, study.intervals.level, intervalMethod(study))});
                }
            }
}

void addNonFinite(const StudyPlan& plan, const StudyRowIndex& rows, StudySummaries& all) {
    for (const size_t scene : rows.scenes())
        for (const int spp : rows.spp())
            for (size_t method = 0; method < plan.methods.size() && scene != kAllScenes; ++method) {
                StudyNonFinite found{scene, method, spp, 0, 0, 0};
                for (const StudyRow* row : rows.of(method, spp)) {
                    if (row->scene != scene || row->frame < 0) continue;
                    found.pixels += row->nonFinitePixels;
                    found.images += row->nonFinitePixels > 0;
                    ++found.allImages;
                }
                if (found.pixels > 0) all.nonFinite.push_back(found);
            }
}

}  // namespace

std::vector<SeedCurve> seedCurves(const Study& study, const StudyRowIndex& rows, size_t scene, size_t method,
                                  const std::string& metric) {
    std::vector<SeedCurve> curves(study.seeds.size());
    for (size_t i = 0; i < curves.size(); ++i)
        for (const int spp : rows.spp()) {
            double sum = 0;
            int count = 0;
            for (const StudyRow* row : rows.of(method, spp))
                if (row->scene == scene && row->seed == study.seeds[i] && row->metrics.contains(metric))
                    sum += row->value(metric), ++count;
            if (count == 0) continue;
            curves[i].spp.push_back(spp);
            curves[i].value.push_back(std::isfinite(sum) ? sum / count : kNaN);
        }
    return curves;
}

StudySummaries summarize(const Study& study, const StudyPlan& plan, const StudyRecords& records) {
    StudySummaries all;
    const StudyRowIndex rows(records);
    addMeans(study, plan, rows, all);
    addRankings(study, plan, rows, all);
    addSlopes(study, plan, rows, all);
    addEquivalents(study, plan, rows, all);
    addStages(study, plan, rows, all);
    addNonFinite(plan, rows, all);
    all.biases = separateBiases(study, plan, records);
    return all;
}

}  // namespace lumi
