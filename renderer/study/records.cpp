#include "study/records.h"

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>

#include "study/run_job.h"

namespace lumi {
using nlohmann::json;
namespace {

/// JSON has no NaN and no infinity: null stands for both.
double number(const json& value) {
    return value.is_number() ? value.get<double>() : std::numeric_limits<double>::quiet_NaN();
}

std::map<std::string, double> numbers(const json& object) {
    std::map<std::string, double> values;
    for (const auto& [key, value] : object.items()) values[key] = number(value);
    return values;
}

std::vector<std::pair<std::string, std::string>> texts(const json& object) {
    std::vector<std::pair<std::string, std::string>> values;
    for (const auto& [key, value] : object.items()) values.emplace_back(key, value.get<std::string>());
    return values;
}

size_t methodNamed(const StudyPlan& plan, const std::string& name) {
    const auto found =
        std::find_if(plan.methods.begin(), plan.methods.end(), [&](const auto& m) { return m.name == name; });
    return static_cast<size_t>(found - plan.methods.begin());
}

void addChoice(const StudyJob& job, const json& result, StudyRecords& records) {
    StudyChoice choice{job.scene, job.entry, job.spp, texts(result.at("chosen")), {}, {}};
    for (const json& candidate : result.at("candidates"))
        choice.candidates.push_back({texts(candidate.at("values")), number(candidate.at("metric"))});
    records.choices.push_back(std::move(choice));
}

void addTimes(const StudyPlan& plan, const StudyJob& job, const json& times, StudyRecords& records) {
    if (!times.is_object() || !times.contains("methods")) return;
    for (const auto& [name, method] : times.at("methods").items()) {
        StudyTime time{job.scene,
                       methodNamed(plan, name),
                       job.spp,
                       job.seed,
                       number(method.at("trace_ms")),
                       number(times.at("pose_ms")),
                       number(method.at("run_ms")),
                       number(method.at("rays_per_frame")),
                       numbers(method.at("stages_ms")),
                       number(times.at("build_ms"))};
        records.times.push_back(std::move(time));
    }
}

}  // namespace

double StudyRow::value(const std::string& metric) const {
    if (const auto found = corrected.find(metric); found != corrected.end()) return found->second;
    const auto found = metrics.find(metric);
    return found == metrics.end() ? std::numeric_limits<double>::quiet_NaN() : found->second;
}

void StudyRecords::add(const StudyPlan& plan, const StudyJob& job, const json& result, const json& jobTimes,
                       const std::filesystem::path& folder, const std::filesystem::path& out) {
    if (job.kind == StudyJob::Kind::Tune) return addChoice(job, result, *this);
    std::map<int64_t, std::string> files;
    for (const json& reference : result.at("references")) {
        StudyReferenceNote note{job.scene,
                                reference.at("frame"),
                                reference.at("file"),
                                reference.at("exposure"),
                                numbers(reference.at("floor")),
                                numbers(reference.at("own")),
                                reference.at("nonfinite_pixels"),
                                numbers(reference.at("details"))};
        files[note.frame] = note.file;
        const bool known =
            std::any_of(references.begin(), references.end(), [&](const auto& r) { return r.file == note.file; });
        if (!known) references.push_back(std::move(note));
    }
    for (const json& entry : result.at("rows")) {
        StudyRow row;
        row.scene = job.scene, row.method = methodNamed(plan, entry.at("method"));
        row.frame = entry.at("frame"), row.spp = job.spp, row.seed = job.seed;
        row.metrics = numbers(entry.at("metrics")), row.corrected = numbers(entry.at("corrected"));
        for (const auto& [id, reason] : entry.at("reasons").items()) row.reasons[id] = reason;
        row.nonFinitePixels = entry.at("nonfinite_pixels");
        row.image = folder / imageFileName(row.method, row.frame);
        row.reference = out / files.at(row.frame);
        rows.push_back(std::move(row));
    }
    for (const json& sequence : result.at("sequences")) {
        StudyRow row;
        row.scene = job.scene, row.method = methodNamed(plan, sequence.at("method")), row.spp = job.spp,
        row.seed = job.seed;
        for (const auto& [metric, value] : sequence.at("metrics").items()) {
            row.metrics[metric] = number(value.at("mean"));
            if (value.contains("reason") && !value.at("reason").get<std::string>().empty())
                row.reasons[metric] = value.at("reason");
            StudySeries one{row.scene, row.method, row.spp, row.seed, metric, value.at("begin"), {}};
            for (const json& frame : value.at("frames")) one.values.push_back(number(frame));
            series.push_back(std::move(one));
        }
        rows.push_back(std::move(row));
    }
    addTimes(plan, job, jobTimes, *this);
}

}  // namespace lumi
