#include "study/results.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "base/isa.h"

namespace lumi {
using Json = nlohmann::ordered_json;
namespace {

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json valuesJson(const std::map<std::string, double>& values) {
    Json object = Json::object();
    for (const auto& [key, value] : values) object[key] = number(value);
    return object;
}

Json textsJson(const std::vector<std::pair<std::string, std::string>>& values) {
    Json object = Json::object();
    for (const auto& [key, value] : values) object[key] = value;
    return object;
}

std::string sceneName(const Study& study, size_t scene) {
    return scene == kAllScenes ? "all" : study.scenes[scene].name;
}

/// What every row begins with. Rows of one method at one number of samples differ in frame and seed only.
Json headJson(const Study& study, const StudyPlan& plan, size_t scene, size_t method, int spp) {
    return {{"scene", sceneName(study, scene)}, {"entry", plan.methods[method].name}, {"spp", spp}};
}

Json frameJson(int64_t frame) { return frame < 0 ? Json("sequence") : Json(frame); }

Json rowsJson(const Study& study, const StudyPlan& plan, const StudyRecords& records) {
    Json rows = Json::array();
    for (const StudyRow& row : records.rows) {
        const StudyMethod& method = plan.methods[row.method];
        Json entry = {{"scene", study.scenes[row.scene].name},
                      {"frame", frameJson(row.frame)},
                      {"entry", method.name},
                      {"spp", row.spp},
                      {"seed", row.seed},
                      {"module", study.entries[method.entry].module}};
        if (method.whole) entry["without"] = method.stage;
        if (study.sweep && !method.coordinates.empty())
            for (size_t i = 0; i < method.coordinates.size(); ++i)
                entry["sweep"][study.sweep->axes[i].id] = method.coordinates[i];
        entry["metrics"] = valuesJson(row.metrics);
        if (!row.reasons.empty()) entry["reasons"] = row.reasons;
        if (row.frame >= 0) {
            entry["corrected"] = valuesJson(row.corrected);
            entry["nonfinite_pixels"] = row.nonFinitePixels;
        }
        rows.push_back(std::move(entry));
    }
    return rows;
}

Json summaryJson(const Study& study, const StudyPlan& plan, const std::vector<StudySummary>& summaries) {
    Json list = Json::array();
    for (const StudySummary& summary : summaries) {
        Json entry = headJson(study, plan, summary.scene, summary.method, summary.spp);
        if (summary.frame >= 0) entry["frame"] = summary.frame;
        entry["metric"] = summary.metric;
        entry.update(intervalJson(summary.interval));
        entry["uncorrected_mean"] = number(summary.uncorrected);
        entry["missing"] = summary.missing;
        list.push_back(std::move(entry));
    }
    return list;
}

Json rankingsJson(const Study& study, const StudyPlan& plan, const StudySummaries& all) {
    Json list = Json::array();
    for (const StudyRanking& ranking : all.rankings) {
        Json places = Json::array();
        for (const StudyRanking::Place& place : ranking.places) {
            Json entry = {{"entry", plan.methods[place.method].name},
                          {"best_rank", place.rank.best},
                          {"worst_rank", place.rank.worst}};
            if (place.toBest.count > 0) entry["difference_to_first"] = intervalJson(place.toBest);
            places.push_back(std::move(entry));
        }
        list.push_back({{"scene", sceneName(study, ranking.scene)},
                        {"spp", ranking.spp},
                        {"metric", ranking.metric},
                        {"places", std::move(places)}});
    }
    return list;
}

Json biasJson(const Study& study, const StudyPlan& plan, const StudySummaries& all) {
    Json list = Json::array();
    for (const StudyBias& bias : all.biases) {
        Json entry = headJson(study, plan, bias.scene, bias.method, bias.spp);
        entry["seeds"] = bias.seeds;
        entry["mse"] = intervalJson(bias.meanSquaredError);
        entry["squared_bias"] = intervalJson(bias.squaredBias);
        entry["squared_bias"]["mean"] = number(bias.parts.squaredBias);
        entry["variance"] = intervalJson(bias.variance);
        entry["variance"]["mean"] = number(bias.parts.variance);
        entry["share_of_bias"] = intervalJson(bias.share);
        entry["share_of_bias"]["mean"] = number(bias.biasShare);
        entry["pixels"] = bias.pixels;
        entry["pixels_left_out"] = bias.pixelsLeftOut;
        list.push_back(std::move(entry));
    }
    return list;
}

Json slopesJson(const Study& study, const StudyPlan& plan, const StudySummaries& all) {
    Json list = Json::array();
    for (const StudySlope& slope : all.slopes) {
        Json entry = {{"scene", sceneName(study, slope.scene)},
                      {"entry", plan.methods[slope.method].name},
                      {"metric", slope.metric}};
        entry.update(intervalJson(slope.slope));
        list.push_back(std::move(entry));
    }
    return list;
}

Json equivalentsJson(const Study& study, const StudyPlan& plan, const StudySummaries& all) {
    Json list = Json::array();
    for (const StudyEquivalent& one : all.equivalents) {
        Json entry = headJson(study, plan, one.scene, one.method, one.spp);
        entry["against"] = plan.methods[one.against].name;
        entry["metric"] = one.metric;
        entry["equivalent_spp"] = intervalJson(one.samples);
        entry["extrapolated"] = one.extrapolated;
        list.push_back(std::move(entry));
    }
    return list;
}

Json stagesJson(const Study& study, const StudyPlan& plan, const StudySummaries& all) {
    Json list = Json::array();
    for (const StudyStageEffect& stage : all.stages) {
        Json entry = headJson(study, plan, stage.scene, stage.whole, stage.spp);
        entry["stage"] = plan.methods[stage.without].stage;
        entry["metric"] = stage.metric;
        entry["whole"] = intervalJson(stage.wholeMean);
        entry["without"] = intervalJson(stage.withoutMean);
        entry["difference"] = intervalJson(stage.difference);
        list.push_back(std::move(entry));
    }
    return list;
}

Json nonFiniteJson(const Study& study, const StudyPlan& plan, const StudySummaries& all) {
    Json list = Json::array();
    for (const StudyNonFinite& found : all.nonFinite) {
        Json entry = headJson(study, plan, found.scene, found.method, found.spp);
        entry["pixels"] = found.pixels, entry["images"] = found.images, entry["of_images"] = found.allImages;
        list.push_back(std::move(entry));
    }
    return list;
}

Json tuningJson(const Study& study, const StudyRecords& records) {
    Json list = Json::array();
    for (const StudyChoice& choice : records.choices) {
        Json candidates = Json::array();
        for (const StudyChoice::Candidate& candidate : choice.candidates)
            candidates.push_back({{"values", textsJson(candidate.values)}, {"metric", number(candidate.metric)}});
        list.push_back({{"scene", study.scenes[choice.scene].name},
                        {"entry", study.entries[choice.entry].name},
                        {"spp", choice.spp},
                        {"frame", study.tuning->frame},
                        {"metric", study.tuning->metric},
                        {"chosen", textsJson(choice.values)},
                        {"at_end", choice.atEnds},
                        {"candidates", std::move(candidates)}});
    }
    return list;
}

Json referencesJson(const Study& study, const StudyRecords& records) {
    Json list = Json::array();
    for (const StudyReferenceNote& note : records.references)
        list.push_back({{"scene", study.scenes[note.scene].name},
                        {"frame", note.frame},
                        {"spp", study.reference.spp},
                        {"file", note.file},
                        {"floor", valuesJson(note.floor)},
                        {"own", valuesJson(note.own)},
                        {"details", valuesJson(note.details)},
                        {"nonfinite_pixels", note.nonFinitePixels}});
    return list;
}

std::string csvText(const std::string& text) {
    if (text.find_first_of(",\"\n") == std::string::npos) return text;
    std::string quoted = "\"";
    for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
    return quoted + '"';
}

std::string csvNumber(const std::map<std::string, double>& values, const std::string& key) {
    const auto found = values.find(key);
    return found == values.end() || !std::isfinite(found->second) ? "" : fmt::format("{}", found->second);
}

}  // namespace

Json intervalJson(const Interval& interval) {
    return {{"mean", number(interval.mean)},
            {"standard_error", interval.known() ? number(interval.standardError) : Json(nullptr)},
            {"low", interval.known() ? number(interval.low) : Json(nullptr)},
            {"high", interval.known() ? number(interval.high) : Json(nullptr)},
            {"count", interval.count}};
}

Json checksJson(const Study& study, const std::vector<StudyCheckResult>& checks, bool timed) {
    Json list = Json::array();
    for (const StudyCheckResult& result : checks) {
        const StudyCheck& check = study.checks[result.check];
        if (check.timed() != timed) continue;
        Json entry = {{"claim", claimText(study, check)},
                      {"scene", sceneName(study, result.scene)},
                      {"spp", result.spp},
                      {"entry", check.entry},
                      {"metric", check.metric},
                      {"value", intervalJson(result.value)}};
        if (!result.against.empty()) entry["against"] = result.against, entry["ratio"] = intervalJson(result.ratio);
        entry[check.atLeast ? "at_least" : "at_most"] = check.bound;
        entry["verdict"] = verdictText(result.verdict);
        list.push_back(std::move(entry));
    }
    return list;
}

Json resultsJson(const Study& study, const StudyPlan& plan, const StudyRecords& records,
                 const StudySummaries& summaries, const std::vector<StudyCheckResult>& checks) {
    Json all;
    all["study"] = {{"name", study.name},
                    {"title", study.title},
                    {"paper", study.paper},
                    {"preset", study.preset},
                    {"file_digest", study.digest},
                    {"isa", isaName(activeIsa())},
                    {"reference_spp", study.reference.spp},
                    {"seeds", study.seeds},
                    {"interval_level", study.intervals.level}};
    if (study.size.width > 0) all["study"]["size"] = {study.size.width, study.size.height};
    all["rows"] = rowsJson(study, plan, records);
    all["references"] = referencesJson(study, records);
    if (!records.choices.empty()) all["tuning"] = tuningJson(study, records);
    all["summary"] = summaryJson(study, plan, summaries.metrics);
    all["summary_by_frame"] = summaryJson(study, plan, summaries.frames);
    all["rankings"] = rankingsJson(study, plan, summaries);
    all["bias_and_variance"] = biasJson(study, plan, summaries);
    all["convergence"] = slopesJson(study, plan, summaries);
    if (!study.ablations.empty()) all["ablations"] = stagesJson(study, plan, summaries);
    if (!study.checks.empty()) all["checks"] = checksJson(study, checks, false);
    all["nonfinite"] = nonFiniteJson(study, plan, summaries);
    if (!study.pairs.empty()) all["equivalent_samples"] = equivalentsJson(study, plan, summaries);
    return all;
}

std::string resultsCsv(const Study& study, const StudyPlan& plan, const StudyRecords& records) {
    std::set<std::string> metrics, corrected;
    for (const StudyRow& row : records.rows) {
        for (const auto& [id, value] : row.metrics) metrics.insert(id);
        for (const auto& [id, value] : row.corrected) corrected.insert(id);
    }
    std::string text = "scene,frame,entry,spp,seed";
    if (study.sweep)
        for (const StudyAxis& axis : study.sweep->axes) text += "," + csvText(axis.id);
    for (const std::string& id : metrics) text += "," + id;
    for (const std::string& id : corrected) text += "," + id + "_corrected";
    text += ",nonfinite_pixels\n";
    for (const StudyRow& row : records.rows) {
        const StudyMethod& method = plan.methods[row.method];
        text += fmt::format("{},{},{},{},{}", csvText(study.scenes[row.scene].name),
                            row.frame < 0 ? "sequence" : std::to_string(row.frame), csvText(method.name), row.spp,
                            row.seed);
        if (study.sweep)
            for (size_t i = 0; i < study.sweep->axes.size(); ++i)
                text += "," + (i < method.coordinates.size() ? csvText(method.coordinates[i]) : "");
        for (const std::string& id : metrics) text += "," + csvNumber(row.metrics, id);
        for (const std::string& id : corrected) text += "," + csvNumber(row.corrected, id);
        text += row.frame < 0 ? ",\n" : fmt::format(",{}\n", row.nonFinitePixels);
    }
    return text;
}

}  // namespace lumi
