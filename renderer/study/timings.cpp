#include <nlohmann/json.hpp>

#include "study/results.h"

namespace lumi {
using Json = nlohmann::ordered_json;
namespace {

Json headJson(const Study& study, const StudyPlan& plan, size_t scene, size_t method, int spp) {
    return {{"scene", study.scenes[scene].name}, {"entry", plan.methods[method].name}, {"spp", spp}};
}

Json rowJson(const Study& study, const StudyPlan& plan, const StudyMeanTime& time) {
    Json row = headJson(study, plan, time.scene, time.method, time.spp);
    row["frame_ms"] = intervalJson(time.frameMs);
    row["pose_ms"] = intervalJson(time.poseMs);
    row["build_ms"] = intervalJson(time.buildMs);
    row["trace_ms"] = intervalJson(time.traceMs);
    row["run_ms"] = intervalJson(time.runMs);
    row["rays_per_frame"] = intervalJson(time.raysPerFrame);
    row["ns_per_ray"] = intervalJson(time.nsPerRay);
    if (!study.tracingStages.empty()) row["tracing_ns_per_ray"] = intervalJson(time.tracingNsPerRay);
    row["stages_ms"] = Json::object();
    for (const auto& [stage, ms] : time.stagesMs) row["stages_ms"][stage] = intervalJson(ms);
    return row;
}

Json pairJson(const Study& study, const StudyPlan& plan, const StudyEqual& equal) {
    Json pair = headJson(study, plan, equal.scene, equal.method, equal.spp);
    pair["against"] = equal.against;
    pair["metric"] = equal.metric;
    pair["frame_ms"] = intervalJson(equal.ms);
    pair["value"] = intervalJson(equal.value);
    pair["against_at_equal_time"] = intervalJson(equal.otherAtEqualTime);
    pair["difference_at_equal_time"] = intervalJson(equal.differenceAtEqualTime);
    pair["against_ms_at_equal_value"] = intervalJson(equal.otherMsAtEqualValue);
    pair["times_as_long"] = intervalJson(equal.timesAsLong);
    return pair;
}

}  // namespace

Json timingsJson(const Study& study, const StudyPlan& plan, const StudyTimes& times,
                 const std::vector<StudyCheckResult>& checks) {
    Json all = {{"rows", Json::array()}, {"pairs", Json::array()}, {"ablations", Json::array()}};
    for (const StudyMeanTime& time : times.methods) all["rows"].push_back(rowJson(study, plan, time));
    for (const StudyEqual& equal : times.pairs) all["pairs"].push_back(pairJson(study, plan, equal));
    for (const StudyStageTime& stage : times.stages) {
        Json entry = headJson(study, plan, stage.scene, stage.whole, stage.spp);
        entry["stage"] = plan.methods[stage.without].stage;
        entry["whole_ms"] = intervalJson(stage.wholeMs);
        entry["without_ms"] = intervalJson(stage.withoutMs);
        entry["difference_ms"] = intervalJson(stage.differenceMs);
        all["ablations"].push_back(std::move(entry));
    }
    if (!study.checks.empty()) all["checks"] = checksJson(study, checks, true);
    return all;
}

}  // namespace lumi
