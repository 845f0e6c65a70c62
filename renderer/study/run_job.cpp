#include "study/run_job.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "image/exr.h"
#include "math/statistics.h"
#include "measure/lag.h"
#include "measure/measure.h"
#include "study/frame_runner.h"
#include "study/statistics.h"
#include "study/temporal_metrics.h"

namespace lumi {
using nlohmann::json;
namespace {

/// Wall-clock times by stage, gathered frame by frame, for their medians over all frames of the job. The first frame
/// counts like every other, though its caches are cold. The frame's signals are traced once, all that any of the
/// methods reads.
class JobTimes {
public:
    void add(const FrameOutput& frame) {
        ++frames_;
        double builtMs = 0;  // what stays as it was is not built
        for (const auto& [stage, ms] : frame.stagesMs)
            if (stage == "build") builtMs += ms;
            else stages_[stage].push_back(ms);
        stages_["build"].push_back(builtMs);
        for (const auto& [instance, ms] : frame.runMs) runs_[instance].push_back(ms);
        // What nobody reads is traced for the metrics of sequences alone: it is no part of such a method's frame.
        for (const auto& [instance, reads] : frame.readsSignals) {
            reads_[instance] = reads_[instance] || reads;
            rays_[instance] += frame.runRays.at(instance).total() + (reads ? frame.rays.total() : 0);
        }
    }
    json toJson(const JobContext& context, const StudyJob& job) const {
        const auto of = [&](const char* stage) { return stages_.count(stage) ? median(stages_.at(stage)) : 0.0; };
        json methods = json::object();
        for (const size_t index : job.methods) {
            const StudyMethod& method = context.plan.methods[index];
            json stages = json::object();
            for (const auto& [stage, values] : stages_)
                if (stage.starts_with(method.instance + "."))
                    stages[stage.substr(method.instance.size() + 1)] = median(values);
            methods[method.name] = {
                {"run_ms", median(runs_.at(method.instance))},
                {"stages_ms", stages},
                {"trace_ms", reads_.at(method.instance) ? of("trace") : 0.0},
                {"rays_per_frame", frames_ ? static_cast<double>(rays_.at(method.instance)) / frames_ : 0}};
        }
        return {{"frames", frames_}, {"pose_ms", of("pose")}, {"build_ms", of("build")}, {"methods", methods}};
    }

private:
    int frames_ = 0;
    std::map<std::string, std::vector<double>> stages_, runs_;
    std::map<std::string, uint64_t> rays_;
    std::map<std::string, bool> reads_;
};

json measureRow(const JobContext& context, const Image& image, const StudyReferenceFrame& reference, float exposureEv) {
    ImagePair pair{image, reference.image, {}, exposureEv, context.study.metricSettings};
    pair.prepare();
    json metrics = json::object(), corrected = json::object(), reasons = json::object();
    for (const std::string& id : context.study.metrics) {
        const Measurement measured = findMetric(id).measure(pair, false);
        metrics[id] = measured.value;
        if (isSquaredError(id)) corrected[id] = withoutReferenceNoise(id, measured.value, reference.floor.at(id));
        if (!measured.reason.empty()) reasons[id] = measured.reason;
    }
    return {{"metrics", metrics},
            {"corrected", corrected},
            {"reasons", reasons},
            {"nonfinite_pixels", pair.nonFiniteImage}};
}

/// The study's statistics of one method's frame, beside the metrics.
void addStatistics(const JobContext& context, size_t method, const FrameOutput& frame, const Image& image,
                   FrameRunner& runner, json& row) {
    const StudyMethod& own = context.plan.methods[method];
    const auto against = [&](const std::string& metric, int spp) {
        ImagePair pair{image, runner.reference({}, spp)->image, {}, runner.exposure(), context.study.metricSettings};
        pair.prepare();
        return findMetric(metric).measure(pair, false).value;
    };
    for (const auto& [name, value] :
         frameStatistics(context.study, context.study.entries[own.entry], own.instance, frame, against))
        row["metrics"][name] = value;
}

/// 1 where a surface is seen that does not shine itself, nor does a pixel beside it: emission and sky, which methods
/// pass by, follow a step at once, and are so bright that they would drown what is filtered.
Image litSurfaces(const Signals& signals) {
    const Image &emission = signals[Signal::Emission], &depth = signals[Signal::Depth];
    Image mask(depth.extent(), 1);
    mask.fill(1);
    for (int y = 0; y < depth.height(); ++y)
        for (int x = 0; x < depth.width(); ++x) {
            const bool shines = emission.at(0, x, y) > 0 || emission.at(1, x, y) > 0 || emission.at(2, x, y) > 0;
            if (!shines && std::isfinite(depth.at(0, x, y))) continue;
            for (int v = std::max(y - 1, 0); v <= std::min(y + 1, depth.height() - 1); ++v)
                for (int u = std::max(x - 1, 0); u <= std::min(x + 1, depth.width() - 1); ++u) mask.at(0, u, v) = 0;
        }
    return mask;
}

/// Metrics of sequences, a method each: differences of consecutive frames, and how a step in the light is followed.
class SequenceMeter {
public:
    SequenceMeter(const Study& study, size_t methods) : study_(study), values_(methods) {}

    SignalSet signalsAt(int64_t frame) const {
        return lags() && frame == step() ? SignalSet{Signal::Emission, Signal::Depth} : SignalSet();
    }
    /// Is the motion of the reference wanted?
    bool wantsGeometry(int64_t frame) const {
        const bool follows = std::any_of(study_.temporalMetrics.begin(), study_.temporalMetrics.end(),
                                         [](const std::string& id) { return findTemporalMetric(id)->followsMotion; });
        return follows && (differs(frame) || differs(frame + 1));
    }
    /// Are the references of before (the frame before the step) and after it wanted?
    bool wantsReference(int64_t frame) const { return lags() && (frame == step() - 1 || frame == step()); }
    void addReference(const FrameOutput& frame, const Image& reference) {
        if (frame.number == step() - 1) {
            before_ = reference;
            return;
        }
        const Image mask = litSurfaces(*frame.signals);
        lags_.assign(values_.size(), LagMeter(before_, reference, &mask));
    }
    /// The results of a frame, a method each; `geometry` where it is wanted.
    void add(const FrameOutput& frame, const std::vector<std::shared_ptr<const Image>>& images,
             std::shared_ptr<const Signals> geometry, float exposureEv) {
        for (size_t i = 0; i < images.size() && differs(frame.number); ++i) {
            const TemporalInput input{*images[i], *previous_[i], geometry.get(), previousGeometry_.get(), exposureEv};
            for (const std::string& id : study_.temporalMetrics)
                if (const auto measure = findTemporalMetric(id)->measure) values_[i][id].push_back(measure(input));
        }
        for (size_t i = 0; i < lags_.size(); ++i) lags_[i].add(*images[i]);
        previous_ = images;
        previousGeometry_ = std::move(geometry);
    }
    json toJson(size_t method) const {
        json metrics = json::object();
        const auto before = static_cast<size_t>(study_.frames.temporalMeanFrom - study_.frames.temporalBegin);
        for (const auto& [id, values] : values_[method]) {
            double sum = 0;
            for (size_t i = before; i < values.size(); ++i) sum += values[i];
            metrics[id] = {{"mean", sum / static_cast<double>(values.size() - before)},
                           {"begin", study_.frames.temporalBegin},
                           {"frames", values}};
        }
        if (!lags_.empty()) {
            const Lag lag = lags_[method].lag(step());
            metrics["lag"] = {{"mean", lag.value}, {"begin", step()}, {"frames", lag.curve}, {"reason", lag.reason}};
        }
        return metrics;
    }

private:
    bool lags() const { return study_.measures("lag"); }
    int64_t step() const { return study_.frames.step->frame; }
    bool differs(int64_t frame) const {
        const bool any = study_.measures("temporal") || study_.measures("temporal_reprojected");
        return any && frame >= study_.frames.temporalBegin && frame < study_.frames.temporalEnd;
    }
    const Study& study_;
    std::vector<std::shared_ptr<const Image>> previous_;
    std::shared_ptr<const Signals> previousGeometry_;
    std::vector<std::map<std::string, std::vector<double>>> values_;
    Image before_;
    std::vector<LagMeter> lags_;
};

void writeImage(const std::filesystem::path& path, const Image& image) {
    ExrLayers layers;
    layers.add("", "RGB", image);
    writeExr(path, layers);
}

/// Writes the reference's image, unless it is there.
json referenceJson(const Study& study, const StudyJob& job, int64_t frame, const StudyReferenceFrame& reference,
                   float exposureEv, const std::filesystem::path& out) {
    const std::string file =
        fmt::format("references/{}-{}.{:04}.exr", fileNameOf(study.scenes[job.scene].name), reference.key, frame);
    if (!std::filesystem::exists(out / file)) writeImage(out / file, reference.image);
    return {{"frame", frame},
            {"file", file},
            {"exposure", exposureEv},
            {"floor", reference.floor},
            {"own", reference.own},
            {"details", reference.details},
            {"nonfinite_pixels", reference.nonFinitePixels}};
}

}  // namespace

int64_t referencesOf(const Study& study, const StudyJob& job) {
    if (job.kind == StudyJob::Kind::Tune) return 1;
    return static_cast<int64_t>(study.frames.measure.size()) + (study.measures("lag") ? 2 : 0);
}

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
    SequenceMeter sequence(study, job.methods.size());
    JobTimes measuredTimes;
    json result = {{"rows", json::array()}, {"sequences", json::array()}, {"references", json::array()}};
    const int64_t last = lastFrame(study, job.kind);
    const double frames = static_cast<double>(last - study.frames.begin + 1);
    std::map<std::string, TapSet> taps;
    for (const size_t method : job.methods)
        taps[context.plan.methods[method].instance] =
            statisticTaps(study, study.entries[context.plan.methods[method].entry]);
    double done = 0, sampled = 0;
    const auto reference = [&](int64_t number) {
        auto made = runner.reference([&](uint64_t samples, uint64_t target) {
            context.progress(done / frames, sampled + static_cast<double>(samples),
                             fmt::format("reference of frame {}, {} of {} spp", number, samples, target));
        });
        sampled += study.reference.spp;
        context.progress(done / frames, sampled, fmt::format("frame {}", number));
        return made;
    };
    while (runner.next() <= last) {
        const int64_t number = runner.next();
        context.progress(done / frames, sampled, fmt::format("frame {}", number));
        const bool isMeasured = std::binary_search(study.frames.measure.begin(), study.frames.measure.end(), number);
        const FrameOutput frame =
            runner.advance(sequence.signalsAt(number), isMeasured ? taps : std::map<std::string, TapSet>{});
        measuredTimes.add(frame);
        done += 1;
        if (sequence.wantsReference(number)) sequence.addReference(frame, reference(number)->image);
        std::vector<std::shared_ptr<const Image>> images;
        for (const RunningMethod& method : runner.methods()) images.push_back(frame.results.at(method.instance));
        sequence.add(frame, images, sequence.wantsGeometry(number) ? runner.geometry() : nullptr, runner.exposure());
        if (!isMeasured) continue;
        const auto measured = reference(number);
        result["references"].push_back(referenceJson(study, job, number, *measured, runner.exposure(), out));
        for (size_t i = 0; i < images.size(); ++i) {
            json row = measureRow(context, *images[i], *measured, runner.exposure());
            addStatistics(context, job.methods[i], frame, *images[i], runner, row);
            row["frame"] = number;
            row["method"] = context.plan.methods[job.methods[i]].name;
            result["rows"].push_back(std::move(row));
            writeImage(folder / imageFileName(job.methods[i], number), *images[i]);
        }
    }
    if (!study.temporalMetrics.empty())
        for (size_t i = 0; i < job.methods.size(); ++i)
            result["sequences"].push_back(
                {{"method", context.plan.methods[job.methods[i]].name}, {"metrics", sequence.toJson(i)}});
    times = measuredTimes.toJson(context, job);
    return result;
}

}  // namespace lumi
