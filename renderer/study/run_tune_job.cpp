#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>

#include "base/error.h"
#include "measure/measure.h"
#include "study/frame_runner.h"
#include "study/run_job.h"
#include "study/tuning.h"

namespace lumi {
using nlohmann::json;
namespace {

/// Runs an entry's candidates on the tuning frame, several side by side on the same samples.
class CandidateRuns {
public:
    CandidateRuns(const JobContext& context, const StudyJob& job)
        : context_(context),
          job_(job),
          entry_(context.study.entries[job.entry]),
          metric_(findMetric(context.study.tuning->metric)),
          expectedRuns_(static_cast<double>(tuningEffort(entry_.tune).runs)) {}

    /// The metric of each.
    std::vector<double> measure(const std::vector<TuningPlace>& places) {
        const Study& study = context_.study;
        std::vector<RunningMethod> methods;
        for (const TuningPlace& place : places) methods.push_back(methodAt(place, methods.size()));
        FrameRunner runner(context_, job_, methods);
        std::optional<FrameOutput> frame;
        const double all = static_cast<double>(study.tuning->frame - study.frames.begin + 1);
        while (runner.next() <= study.tuning->frame) {
            report(static_cast<double>(runner.next() - study.frames.begin) / all, 0, "tuning " + entry_.name);
            frame = runner.advance({});
        }
        runs_ += 1;
        if (!reference_)
            reference_ = runner.reference([&](uint64_t samples, uint64_t target) {
                report(0, static_cast<double>(samples),
                       fmt::format("reference of frame {}, {} of {} spp", study.tuning->frame, samples, target));
            });
        std::vector<double> values;
        for (const RunningMethod& method : methods) {
            ImagePair pair{
                *frame->results.at(method.instance), reference_->image, {}, runner.exposure(), study.metricSettings};
            pair.prepare();
            values.push_back(metric_.measure(pair, false).value);
        }
        return values;
    }

private:
    RunningMethod methodAt(const TuningPlace& place, size_t index) const {
        RunningMethod method{fmt::format("{}@t{}", entry_.module, index), {}};
        for (const StudyValue& value : entry_.set)
            if (!isDocumentId(entry_.module, value.id)) method.set.push_back(value);
        for (StudyValue& value : tuningValues(entry_.tune, place)) method.set.push_back(std::move(value));
        return method;
    }
    void report(double share, double samples, const std::string& step) {
        sampled_ = std::max(sampled_, samples);
        context_.progress(std::min((runs_ + share) / expectedRuns_, 1.0), sampled_, step);
    }

    const JobContext& context_;
    const StudyJob& job_;
    const StudyEntry& entry_;
    const Metric& metric_;
    const double expectedRuns_;
    std::shared_ptr<const StudyReferenceFrame> reference_;
    double runs_ = 0, sampled_ = 0;
};

}  // namespace

json runTuneJob(const JobContext& context, const StudyJob& job) {
    const StudyEntry& entry = context.study.entries[job.entry];
    const StudyTuning& tuning = *context.study.tuning;
    std::vector<size_t> counts;
    for (const StudyAxis& axis : entry.tune) counts.push_back(axis.values.size());
    CandidateRuns runs(context, job);
    const TuningSearch search =
        searchTuning(counts, findMetric(tuning.metric).higherIsBetter,
                     [&](const std::vector<TuningPlace>& places) { return runs.measure(places); });
    json result = {{"candidates", json::array()}};
    for (size_t i = 0; i < search.places.size(); ++i) {
        json values = json::object();
        for (const StudyValue& value : tuningValues(entry.tune, search.places[i])) values[value.id] = value.text;
        result["candidates"].push_back({{"values", values}, {"metric", search.values[i]}});
        if (i == search.best) result["chosen"] = values;
    }
    if (search.best == search.places.size())
        throwBadInput({fmt::format("no combination of \"{}\" has a value of {} on frame {}", entry.name, tuning.metric,
                                   tuning.frame),
                       context.study.path.string(), "images that can be measured", ""});
    return result;
}

}  // namespace lumi
