#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>

#include "study/results.h"

namespace lumi {
using Json = nlohmann::ordered_json;
namespace {

/// One method's times at one number of samples: means over the seeds' medians.
struct MeanTime {
    size_t scene = 0, method = 0;
    int spp = 1;
    Interval frameMs;
    double traceMs = 0, poseMs = 0, runMs = 0, raysPerFrame = 0;
    std::map<std::string, double> stagesMs;
};

std::vector<MeanTime> meanTimes(const Study& study, const StudyRecords& records) {
    std::map<std::tuple<size_t, int, size_t>, std::vector<const StudyTime*>> groups;
    for (const StudyTime& time : records.times) groups[{time.scene, time.spp, time.method}].push_back(&time);
    std::vector<MeanTime> means;
    for (const auto& [key, times] : groups) {
        MeanTime mean{std::get<0>(key), std::get<2>(key), std::get<1>(key), {}, 0, 0, 0, 0, {}};
        std::vector<double> frames;
        const double count = static_cast<double>(times.size());
        for (const StudyTime* time : times) {
            frames.push_back(time->frameMs());
            mean.traceMs += time->traceMs / count;
            mean.poseMs += time->poseMs / count;
            mean.runMs += time->runMs / count;
            mean.raysPerFrame += time->raysPerFrame / count;
            for (const auto& [stage, ms] : time->stagesMs) mean.stagesMs[stage] += ms / count;
        }
        mean.frameMs = meanInterval(frames, study.intervals.level);
        means.push_back(std::move(mean));
    }
    return means;
}

const StudySummary* findSummary(const StudySummaries& all, size_t scene, size_t method, int spp, const std::string& metric) {
    for (const StudySummary& summary : all.metrics)
        if (summary.scene == scene && summary.method == method && summary.spp == spp && summary.metric == metric)
            return &summary;
    return nullptr;
}

/// Time and metric of a method at each of its sample counts.
struct Curve {
    std::vector<double> spp, ms, value;
};

Curve curveOf(const std::vector<MeanTime>& times, const StudySummaries& all, size_t scene, size_t method,
              const std::string& metric) {
    Curve curve;
    for (const MeanTime& time : times) {
        const StudySummary* summary = findSummary(all, scene, method, time.spp, metric);
        if (time.scene != scene || time.method != method || !summary) continue;
        curve.spp.push_back(time.spp);
        curve.ms.push_back(time.frameMs.mean);
        curve.value.push_back(summary->interval.mean);
    }
    return curve;
}

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

/// The other's metric in the method's time, and the other's time at the method's error.
Json pairJson(const MeanTime& time, double value, const Curve& other, bool higher) {
    std::vector<double> ms = other.ms, byTime = other.value, errors = other.value, msByError = other.ms;
    if (!std::is_sorted(ms.begin(), ms.end())) ms.clear(), byTime.clear();
    if (!higher) std::reverse(errors.begin(), errors.end()), std::reverse(msByError.begin(), msByError.end());
    if (!std::is_sorted(errors.begin(), errors.end())) errors.clear(), msByError.clear();
    return {{"equal_time_ms", time.frameMs.mean}, {"metric", value},
            {"against_at_equal_time", number(logLogAt(ms, byTime, time.frameMs.mean))},
            {"against_ms_at_equal_metric", number(logLogAt(errors, msByError, value))},
            {"against_fastest_ms", ms.empty() ? Json(nullptr) : number(ms.front())},
            {"against_slowest_ms", ms.empty() ? Json(nullptr) : number(ms.back())}};
}

Json pairsJson(const Study& study, const StudyPlan& plan, const std::vector<MeanTime>& times, const StudySummaries& all) {
    Json list = Json::array();
    for (const StudyPair& pair : study.pairs)
        for (const MeanTime& time : times)
            for (size_t other = 0; other < plan.methods.size(); ++other) {
                if (study.entries[plan.methods[time.method].entry].name != pair.entry ||
                    study.entries[plan.methods[other].entry].name != pair.against)
                    continue;
                for (const std::string& metric : study.metrics) {
                    const StudySummary* summary = findSummary(all, time.scene, time.method, time.spp, metric);
                    if (!summary) continue;
                    Json entry = {{"scene", study.scenes[time.scene].name}, {"entry", plan.methods[time.method].name},
                                  {"spp", time.spp}, {"against", plan.methods[other].name}, {"of", metric}};
                    entry.update(pairJson(time, summary->interval.mean, curveOf(times, all, time.scene, other, metric),
                                          higherIsBetter(metric)));
                    list.push_back(std::move(entry));
                }
            }
    return list;
}

}  // namespace

Json timingsJson(const Study& study, const StudyPlan& plan, const StudyRecords& records, const StudySummaries& summaries) {
    const std::vector<MeanTime> times = meanTimes(study, records);
    Json rows = Json::array();
    for (const MeanTime& time : times) {
        Json stages = Json::object();
        for (const auto& [stage, ms] : time.stagesMs) stages[stage] = ms;
        rows.push_back({{"scene", study.scenes[time.scene].name}, {"entry", plan.methods[time.method].name},
                        {"spp", time.spp}, {"frame_ms", time.frameMs.mean},
                        {"low", number(time.frameMs.known() ? time.frameMs.low : NAN)},
                        {"high", number(time.frameMs.known() ? time.frameMs.high : NAN)}, {"pose_ms", time.poseMs},
                        {"trace_ms", time.traceMs}, {"run_ms", time.runMs}, {"rays_per_frame", time.raysPerFrame},
                        {"stages_ms", std::move(stages)}});
    }
    return {{"rows", std::move(rows)}, {"pairs", pairsJson(study, plan, times, summaries)}};
}

}  // namespace lumi
