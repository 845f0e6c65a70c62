#include "study/run_job.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "image/exr.h"
#include "math/statistics.h"
#include "measure/measure.h"
#include "study/frame_runner.h"
#include "study/temporal_metrics.h"

namespace lumi {
using nlohmann::json;
namespace {

/// Wall-clock times by stage, gathered frame by frame; the first frame builds the scene and counts in none but `build`.
class JobTimes {
public:
    void add(const FrameOutput& frame) {
        ++frames_;
        for (const auto& [stage, ms] : frame.stagesMs) stages_[stage].push_back(ms);
        for (const auto& [instance, ms] : frame.runMs) runs_[instance].push_back(ms);
        rays_ += frame.rays.total();
    }
    json toJson(const JobContext& context, const StudyJob& job) const {
        json methods = json::object();
        for (const size_t index : job.methods) {
            const StudyMethod& method = context.plan.methods[index];
            json stages = json::object();
            for (const auto& [stage, values] : stages_)
                if (stage.starts_with(method.instance + "."))
                    stages[stage.substr(method.instance.size() + 1)] = median(values);
            methods[method.name] = {{"run_ms", median(runs_.at(method.instance))}, {"stages_ms", stages}};
        }
        const auto of = [&](const char* stage) { return stages_.count(stage) ? median(stages_.at(stage)) : 0.0; };
        return {{"frames", frames_}, {"trace_ms", of("trace")}, {"pose_ms", of("pose")}, {"build_ms", of("build")},
                {"rays_per_frame", frames_ ? static_cast<double>(rays_) / frames_ : 0}, {"methods", methods}};
    }

private:
    int frames_ = 0;
    uint64_t rays_ = 0;
    std::map<std::string, std::vector<double>> stages_, runs_;
};

json measureRow(const JobContext& context, const Image& image, const StudyReferenceFrame& reference, float exposureEv) {
    ImagePair pair{image, reference.image, {}, exposureEv};
    pair.prepare();
    json metrics = json::object(), corrected = json::object();
    for (const std::string& id : context.study.metrics) {
        const double value = findMetric(id).measure(pair, false).value;
        metrics[id] = value;
        if (isSquaredError(id)) corrected[id] = withoutReferenceNoise(id, value, reference.floor.at(id));
    }
    return {{"metrics", metrics}, {"corrected", corrected}, {"nonfinite_pixels", pair.nonFinitePixels}};
}

/// Differences of consecutive frames, a method each.
class TemporalSeries {
public:
    TemporalSeries(const Study& study, size_t methods) : study_(study), values_(methods) {}

    SignalSet signalsAt(int64_t frame) const {
        return measures(frame) || measures(frame + 1) ? temporalSignals() : SignalSet();
    }
    /// The results of a frame, a method each.
    void add(const FrameOutput& frame, const std::vector<std::shared_ptr<const Image>>& images, float exposureEv) {
        for (size_t i = 0; i < images.size() && measures(frame.number); ++i) {
            const TemporalInput input{*images[i], *previous_[i], *frame.signals, *previousSignals_, exposureEv};
            for (const std::string& id : study_.temporalMetrics) values_[i][id].push_back(findTemporalMetric(id)->measure(input));
        }
        previous_ = images;
        previousSignals_ = frame.signals;
    }
    json toJson(size_t method) const {
        json metrics = json::object();
        for (const std::string& id : study_.temporalMetrics) {
            const std::vector<double>& values = values_[method].at(id);
            double sum = 0;
            for (const double value : values) sum += value;
            metrics[id] = {{"mean", sum / static_cast<double>(values.size())}, {"frames", values}};
        }
        return metrics;
    }

private:
    bool measures(int64_t frame) const {
        return !study_.temporalMetrics.empty() && frame >= study_.frames.temporalBegin && frame < study_.frames.temporalEnd;
    }
    const Study& study_;
    std::vector<std::shared_ptr<const Image>> previous_;
    std::shared_ptr<const Signals> previousSignals_;
    std::vector<std::map<std::string, std::vector<double>>> values_;
};

void writeImage(const std::filesystem::path& path, const Image& image) {
    ExrLayers layers;
    layers.add("", "RGB", image);
    writeExr(path, layers);
}

}  // namespace

bool isSquaredError(const std::string& metric) { return metric == "mse" || metric == "rmse" || metric == "relmse"; }

double withoutReferenceNoise(const std::string& metric, double value, double floor) {
    if (metric == "rmse") return std::sqrt(std::max(value * value - floor * floor, 0.0));
    return value - floor;
}

std::string imageFileName(size_t method, int64_t frame) { return fmt::format("m{}.{:04}.exr", method, frame); }

json runMeasureJob(const JobContext& context, const StudyJob& job, const std::filesystem::path& folder,
                   const std::filesystem::path& out, json& times) {
    const Study& study = context.study;
    FrameRunner runner(context, job, methodsOf(context, job));
    TemporalSeries temporal(study, job.methods.size());
    JobTimes measuredTimes;
    json result = {{"rows", json::array()}, {"sequences", json::array()}, {"references", json::array()}};
    const int64_t last = lastFrame(study, job.kind);
    const double references = static_cast<double>(study.frames.measure.size());
    const double all = jobWork(study, job) + references * context.referenceWork;
    double done = 0;
    while (runner.next() <= last) {
        const int64_t number = runner.next();
        context.progress(done / all, fmt::format("frame {}", number));
        const FrameOutput frame = runner.advance(temporal.signalsAt(number));
        measuredTimes.add(frame);
        done += jobWork(study, job) / static_cast<double>(last - study.frames.begin + 1);
        const bool measured = std::binary_search(study.frames.measure.begin(), study.frames.measure.end(), number);
        std::shared_ptr<const StudyReferenceFrame> reference;
        if (measured) {
            reference = runner.reference([&](uint64_t samples, uint64_t target) {
                const double part = context.referenceWork * static_cast<double>(samples) / static_cast<double>(target);
                context.progress((done + part) / all, fmt::format("reference of frame {}, {} of {} spp", number, samples, target));
            });
            done += context.referenceWork;
            const std::string file = fmt::format("references/{}-{}.{:04}.exr", fileNameOf(study.scenes[job.scene].name),
                                                 reference->key, number);
            if (!std::filesystem::exists(out / file)) writeImage(out / file, reference->image);
            result["references"].push_back({{"frame", number}, {"file", file}, {"exposure", runner.exposure()}, {"floor", reference->floor}});
        }
        std::vector<std::shared_ptr<const Image>> images;
        for (const RunningMethod& method : runner.methods()) images.push_back(frame.results.at(method.instance));
        temporal.add(frame, images, runner.exposure());
        for (size_t i = 0; i < images.size() && measured; ++i) {
            json row = measureRow(context, *images[i], *reference, runner.exposure());
            row["frame"] = number;
            row["method"] = context.plan.methods[job.methods[i]].name;
            result["rows"].push_back(std::move(row));
            writeImage(folder / imageFileName(job.methods[i], number), *images[i]);
        }
    }
    if (!study.temporalMetrics.empty())
        for (size_t i = 0; i < job.methods.size(); ++i)
            result["sequences"].push_back({{"method", context.plan.methods[job.methods[i]].name}, {"metrics", temporal.toJson(i)}});
    times = measuredTimes.toJson(context, job);
    return result;
}

json runTuneJob(const JobContext& context, const StudyJob& job) {
    const Study& study = context.study;
    const StudyEntry& entry = study.entries[job.entry];
    const std::vector<std::vector<StudyValue>> candidates = combinations(entry.tune);
    std::vector<RunningMethod> methods;
    for (const std::vector<StudyValue>& candidate : candidates) {
        RunningMethod method{fmt::format("{}@t{}", entry.module, methods.size()), {}};
        for (const StudyValue& value : entry.set)
            if (!isDocumentId(entry.module, value.id)) method.set.push_back(value);
        method.set.insert(method.set.end(), candidate.begin(), candidate.end());
        methods.push_back(std::move(method));
    }
    FrameRunner runner(context, job, methods);
    std::optional<FrameOutput> frame;
    const double all = static_cast<double>(study.tuning->frame - study.frames.begin + 1);
    while (runner.next() <= study.tuning->frame) {
        context.progress(static_cast<double>(runner.next() - study.frames.begin) / all, "tuning " + entry.name);
        frame = runner.advance({});
    }
    const auto reference = runner.reference({});
    const Metric& metric = findMetric(study.tuning->metric);
    json result = {{"candidates", json::array()}};
    double best = std::numeric_limits<double>::quiet_NaN();
    for (size_t i = 0; i < candidates.size(); ++i) {
        ImagePair pair{*frame->results.at(methods[i].instance), reference->image, {}, runner.exposure()};
        pair.prepare();
        const double value = metric.measure(pair, false).value;
        json values = json::object();
        for (const StudyValue& chosen : candidates[i]) values[chosen.id] = chosen.text;
        result["candidates"].push_back({{"values", values}, {"metric", value}});
        // The first of equals stays, so that the choice never depends on chance.
        if (i > 0 && !(metric.higherIsBetter ? value > best : value < best)) continue;
        best = value;
        result["chosen"] = values;
    }
    return result;
}

}  // namespace lumi
