#pragma once
#include <filesystem>
#include <functional>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <stop_token>

#include "study/plan.h"
#include "study/references.h"

namespace lumi {

/// What a job needs besides the plan.
struct JobContext {
    const Study& study;
    const StudyPlan& plan;
    std::shared_ptr<const Scene> scene;  ///< the job's
    StudyReferences& references;
    MessageLog& log;
    std::stop_token stop;
    /// Values that tuning chose for an entry at a number of samples, in this scene.
    std::function<std::vector<StudyValue>(size_t entry, int spp)> tuned;
    /// Share of the job's frames that are done, samples a pixel of references, and what it is at; on any thread.
    std::function<void(double frames, double referenceSamples, const std::string& step)> progress;
};

/// What a job leaves is the same every time, as JSON and images; wall-clock times are apart.
///     Measure: {"rows": [{"frame", "method", "metrics": {id: value}, "corrected": {id: value}, "reasons": {id: why
///     there is no
///                         value}, "nonfinite_pixels"}],
///               "sequences": [{"method", "metrics": {id: {"mean", "begin", "frames": [values], "reason"}}}],
///               "references": [{"frame", "file", "exposure", "floor": {id: value}, "own": {id: value},
///               "nonfinite_pixels"}]}
///     Tune:    {"chosen": {id: value}, "candidates": [{"values": {id: value}, "metric": value}]}
/// Runs the job's frames from an empty history and measures; before it returns every image that is measured is in
/// `folder` as `<method>.<frame>.exr`, and its reference under `out`/references. `times`: {"frames", "pose_ms",
/// "build_ms", "methods": {name: {"run_ms", "stages_ms", "trace_ms", "rays_per_frame"}}}, medians over the frames.
/// Throws Error(BadInput) headed by the study file's position for a value that the scene's document does not take,
/// Error(Interrupted).
nlohmann::json runMeasureJob(const JobContext& context, const StudyJob& job, const std::filesystem::path& folder,
                             const std::filesystem::path& out, nlohmann::json& times);
nlohmann::json runTuneJob(const JobContext& context, const StudyJob& job);

/// How many references a job compares with; one may be several of them.
int64_t referencesOf(const Study& study, const StudyJob& job);

/// `<method>.<frame>.exr`.
std::string imageFileName(size_t method, int64_t frame);

/// The metrics of which the reference's own error can be taken off, since they are means of squares or roots of them.
bool isSquaredError(const std::string& metric);
/// `value` without the reference's part, by the metric's floor. What is left of a mean of squares may come out a little
/// below 0, so that its means stay unbiased; a root is 0 then.
double withoutReferenceNoise(const std::string& metric, double value, double floor);

}  // namespace lumi
