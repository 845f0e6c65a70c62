#include "study/times.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <tuple>

namespace lumi {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// The interval of one time of every seed.
template <class Of>
Interval timeInterval(const Study& study, const std::vector<const StudyTime*>& times, Of&& of) {
    std::vector<double> values;
    for (const StudyTime* time : times) values.push_back(of(*time));
    return meanInterval(values, study.intervals.level);
}

/// Of trace and `stages` over all rays; NaN for a method without them.
double tracingNsPerRay(const StudyTime& time, const std::vector<std::string>& stages) {
    double ms = time.traceMs;
    bool any = ms > 0;
    for (const auto& [stage, stageMs] : time.stagesMs)
        if (std::count(stages.begin(), stages.end(), stage)) ms += stageMs, any = true;
    return any && time.raysPerFrame > 0 ? 1e6 * ms / time.raysPerFrame : kNaN;
}

std::vector<StudyMeanTime> meanTimes(const Study& study, const StudyRecords& records) {
    std::map<std::tuple<size_t, int, size_t>, std::vector<const StudyTime*>> groups;
    for (const StudyTime& time : records.times) groups[{time.scene, time.spp, time.method}].push_back(&time);
    std::vector<StudyMeanTime> means;
    for (const auto& [key, times] : groups) {
        StudyMeanTime mean;
        std::tie(mean.scene, mean.spp, mean.method) = key;
        mean.frameMs = timeInterval(study, times, [](const StudyTime& time) { return time.frameMs(); });
        mean.poseMs = timeInterval(study, times, [](const StudyTime& time) { return time.poseMs; });
        mean.buildMs = timeInterval(study, times, [](const StudyTime& time) { return time.buildMs; });
        mean.traceMs = timeInterval(study, times, [](const StudyTime& time) { return time.traceMs; });
        mean.runMs = timeInterval(study, times, [](const StudyTime& time) { return time.runMs; });
        mean.raysPerFrame = timeInterval(study, times, [](const StudyTime& time) { return time.raysPerFrame; });
        std::map<std::string, bool> stages;
        for (const StudyTime* time : times)
            for (const auto& [stage, ms] : time->stagesMs) stages[stage] = true;
        for (const auto& [stage, ignored] : stages)
            mean.stagesMs[stage] = timeInterval(study, times, [&, name = stage](const StudyTime& time) {
                const auto found = time.stagesMs.find(name);
                return found == time.stagesMs.end() ? 0 : found->second;
            });
        for (const int seed : study.seeds) {
            const auto own =
                std::find_if(times.begin(), times.end(), [&](const StudyTime* time) { return time->seed == seed; });
            const StudyTime* time = own == times.end() ? nullptr : *own;
            mean.frameMsBySeed.push_back(time ? time->frameMs() : kNaN);
            mean.runMsBySeed.push_back(time ? time->runMs : kNaN);
            mean.nsPerRayBySeed.push_back(
                time && time->raysPerFrame > 0 ? 1e6 * (time->traceMs + time->runMs) / time->raysPerFrame : kNaN);
            mean.tracingNsPerRayBySeed.push_back(time ? tracingNsPerRay(*time, study.tracingStages) : kNaN);
        }
        mean.nsPerRay = meanInterval(mean.nsPerRayBySeed, study.intervals.level);
        if (!study.tracingStages.empty())
            mean.tracingNsPerRay = meanInterval(mean.tracingNsPerRayBySeed, study.intervals.level);
        means.push_back(std::move(mean));
    }
    return means;
}

/// A seed's time and metric at each of a method's sample counts; neither need rise or fall all the way, for both have
/// noise.
struct TimeCurve {
    std::vector<double> ms, value;
};

TimeCurve timeCurve(const StudyTimes& times, const SeedCurve& curve, size_t scene, size_t method, size_t seed) {
    TimeCurve result;
    for (size_t i = 0; i < curve.spp.size(); ++i) {
        const StudyMeanTime* time = times.find(scene, method, static_cast<int>(curve.spp[i]));
        if (!time || !std::isfinite(time->frameMsBySeed[seed]) || !std::isfinite(curve.value[i])) continue;
        result.ms.push_back(time->frameMsBySeed[seed]);
        result.value.push_back(curve.value[i]);
    }
    return result;
}

/// Several methods, each with its sample counts, are one curve by what they cost.
void sortByTime(TimeCurve& curve) {
    std::vector<std::pair<double, double>> points;
    for (size_t i = 0; i < curve.ms.size(); ++i) points.emplace_back(curve.ms[i], curve.value[i]);
    std::sort(points.begin(), points.end());
    for (size_t i = 0; i < points.size(); ++i) std::tie(curve.ms[i], curve.value[i]) = points[i];
}

/// One seed's numbers of a pair.
struct SeedEqual {
    double otherAtTime = kNaN, otherMs = kNaN;
};

SeedEqual equalOf(const TimeCurve& other, double ms, double value, bool higher) {
    return {logLogAt(other.ms, other.value, ms),
            logLogAt(other.value, other.ms, value, higher ? Course::Rising : Course::Falling)};
}

/// `others`: one method, or several that are one at several costs.
void addPair(const Study& study, const StudyPlan& plan, const StudyRowIndex& rows, const StudyMeanTime& time,
             const std::vector<size_t>& others, const std::string& metric, StudyTimes& times) {
    const std::vector<SeedCurve> own = seedCurves(study, rows, time.scene, time.method, metric);
    const auto curveOf = [&](size_t seed) {
        TimeCurve all;
        for (const size_t other : others) {
            const TimeCurve part =
                timeCurve(times, seedCurves(study, rows, time.scene, other, metric)[seed], time.scene, other, seed);
            all.ms.insert(all.ms.end(), part.ms.begin(), part.ms.end());
            all.value.insert(all.value.end(), part.value.begin(), part.value.end());
        }
        if (others.size() > 1) sortByTime(all);
        return all;
    };
    std::vector<double> values, atTime, differences, otherMs, ratios;
    for (size_t seed = 0; seed < study.seeds.size(); ++seed) {
        const auto point = std::find(own[seed].spp.begin(), own[seed].spp.end(), time.spp);
        if (point == own[seed].spp.end()) continue;
        const double value = own[seed].value[static_cast<size_t>(point - own[seed].spp.begin())],
                     ms = time.frameMsBySeed[seed];
        const SeedEqual equal = equalOf(curveOf(seed), ms, value, higherIsBetter(study, metric));
        values.push_back(value);
        atTime.push_back(equal.otherAtTime);
        differences.push_back(value - equal.otherAtTime);
        otherMs.push_back(equal.otherMs);
        ratios.push_back(equal.otherMs / ms);
    }
    if (values.empty()) return;
    const auto interval = [&](const std::vector<double>& list) {
        return meanInterval(list, study.intervals.level, intervalMethod(study));
    };
    std::string names;
    for (const size_t other : others) names += (names.empty() ? "" : ", ") + plan.methods[other].name;
    times.pairs.push_back({time.scene, time.method, names, time.spp, metric, time.frameMs, interval(values),
                           interval(atTime), interval(differences), interval(otherMs), interval(ratios)});
}

void addPairs(const Study& study, const StudyPlan& plan, const StudyRowIndex& rows, StudyTimes& times) {
    for (const StudyPair& pair : study.pairs)
        for (const StudyMeanTime& time : times.methods) {
            if (study.entries[plan.methods[time.method].entry].name != pair.entry || plan.methods[time.method].whole)
                continue;
            std::vector<std::vector<size_t>> curves(pair.against.size() > 1 ? 1 : 0);
            for (size_t other = 0; other < plan.methods.size(); ++other) {
                if (!std::count(pair.against.begin(), pair.against.end(),
                                study.entries[plan.methods[other].entry].name) ||
                    plan.methods[other].whole)
                    continue;
                if (pair.against.size() > 1) curves[0].push_back(other);
                else curves.push_back({other});
            }
            for (const std::vector<size_t>& others : curves)
                for (const std::string& metric : allMetrics(study))
                    addPair(study, plan, rows, time, others, metric, times);
        }
}

void addStages(const Study& study, const StudyPlan& plan, StudyTimes& times) {
    for (const StudyMeanTime& time : times.methods) {
        if (!plan.methods[time.method].whole) continue;
        const size_t whole = *plan.methods[time.method].whole;
        const StudyMeanTime* with = times.find(time.scene, whole, time.spp);
        if (with)
            times.stages.push_back({time.scene, whole, time.method, time.spp, with->frameMs, time.frameMs,
                                    pairedInterval(time.frameMsBySeed, with->frameMsBySeed, study.intervals.level)});
    }
}

}  // namespace

const std::vector<double>& StudyMeanTime::bySeed(const std::string& quantity) const {
    if (quantity == "tracing_ns_per_ray") return tracingNsPerRayBySeed;
    return quantity == "frame_ms" ? frameMsBySeed : quantity == "run_ms" ? runMsBySeed : nsPerRayBySeed;
}

const StudyMeanTime* StudyTimes::find(size_t scene, size_t method, int spp) const {
    for (const StudyMeanTime& time : methods)
        if (time.scene == scene && time.method == method && time.spp == spp) return &time;
    return nullptr;
}

StudyTimes summarizeTimes(const Study& study, const StudyPlan& plan, const StudyRecords& records) {
    StudyTimes times;
    times.methods = meanTimes(study, records);
    addPairs(study, plan, StudyRowIndex(records), times);
    addStages(study, plan, times);
    return times;
}

}  // namespace lumi
