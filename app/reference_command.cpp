#include "app/reference_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <mutex>
#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "app/progress_line.h"
#include "app/reference_picture.h"
#include "app/render_command.h"
#include "base/error.h"
#include "base/files.h"
#include "base/memory.h"
#include "base/timer.h"
#include "params/json_text.h"
#include "reference/finished_reference.h"
#include "reference/reference_part.h"
#include "session/reference_spec.h"
#include "trace/tracer.h"

namespace lumi {
namespace fs = std::filesystem;
using nlohmann::json;
namespace {

/// The progress of one reference as text, written by the tracing thread and read by the line's own.
class ReferenceStatus {
public:
    ReferenceStatus(const std::string& head, double wantedError) : head_(head), wantedError_(wantedError) {}

    void set(const ReferenceProgress& progress) {
        std::lock_guard lock(mutex_);
        progress_ = progress;
    }
    std::string text() const {
        std::lock_guard lock(mutex_);
        if (progress_.waiting) return head_ + "waiting for another process that makes the same reference";
        const double samples = static_cast<double>(progress_.samples), seconds = timer_.elapsedMs() / 1000;
        double target = static_cast<double>(progress_.target);
        std::string text = fmt::format("{}{} ", head_, progress_.samples);
        if (progress_.target > 0) {
            text += fmt::format("of {} spp  {:3.0f}%", progress_.target, 100 * samples / target);
        } else {
            text += "spp";
            if (progress_.error > 0) {
                text += fmt::format(", error {:.3g} of {:.3g}", progress_.error, wantedError_);
                // it falls with the root of the samples
                target = samples * std::pow(progress_.error / wantedError_, 2);
            }
        }
        const double traced = samples - static_cast<double>(progress_.resumed);
        if (traced > 0 && target > samples)
            text += "  " + formatDuration(seconds / traced * (target - samples)) + " left";
        return text;
    }

private:
    mutable std::mutex mutex_;
    const std::string head_;
    const double wantedError_;
    ReferenceProgress progress_;
    Timer timer_;
};

/// The scene and its frames, the same in each process that works on them.
class ReferenceJob {
public:
    ReferenceJob(const ReferenceCommand& options, const MachineOptions& machine, MessageLog& log, std::stop_token stop)
        : options_(options),
          file_(findScene(options.scene.scene)),
          scene_(openScene(file_, options.scene, log, stop)),
          document_(makeDocument(scene_, options.scene, log)),
          path_(readCameraPathOf(options.scene)) {
        printMessages(log, machine);
        document_.set("view.0.module", std::string("accumulate"));
        const auto sppGiven = std::any_of(options.scene.values.begin(), options.scene.values.end(),
                                          [](const TypedValue& value) { return value.id == "render.spp"; });
        if (sppGiven) goal_.samples = static_cast<uint64_t>(document_.render().samplesPerPixel);
        goal_.error = options.error;
    }

    /// body(number, document at that frame) until it returns false.
    template <class Body>
    void forEachFrame(Body body) {
        for (int64_t number = options_.frames.begin; number < options_.frames.end; ++number) {
            if (timed()) document_.setTime(timeOf(number));
            followCameraPath(document_, path_);
            if (!body(number, document_)) return;
        }
    }
    bool timed() const { return options_.frames.end > 1; }
    float timeOf(int64_t number) const {
        return static_cast<float>(static_cast<double>(number) / static_cast<double>(document_.render().fps));
    }
    /// The document a frame earlier, or as it is for the first.
    Document before(int64_t number) const {
        Document earlier = document_;
        if (number > 0 && timed()) earlier.setTime(timeOf(number - 1));
        followCameraPath(earlier, path_);
        return earlier;
    }
    const ReferenceGoal& goal() const { return goal_; }
    const fs::path& file() const { return file_; }
    const Document& document() const { return document_; }
    SceneReference sceneReference() const { return {options_.scene.scene, scene_->contentDigest}; }

private:
    const ReferenceCommand& options_;
    const fs::path file_;
    std::shared_ptr<const Scene> scene_;
    Document document_;
    std::optional<CameraPath> path_;
    ReferenceGoal goal_;
};

/// Signals for EXR layers: means of up to 16 samples, with motion against the frame before.
std::shared_ptr<const Signals> traceLayers(const ReferenceSpec& spec, const Document& before, const SignalSet& wanted,
                                           uint64_t samples, std::stop_token stop) {
    Tracer tracer;
    tracer.bind(poseScene(spec.scene, {spec.time, spec.time + spec.openSeconds, before.time()}, nullptr, stop), stop);
    FrameSampling sampling;
    sampling.extent = spec.camera.extent;
    sampling.camera = spec.camera;
    sampling.previousCamera = poseCamera(before.camera(), spec.camera.extent);
    sampling.samplesPerPixel = static_cast<int>(std::min<uint64_t>(samples, kLeafSamples));
    sampling.seed = spec.seed;
    sampling.jitter = spec.jitter;
    sampling.path = spec.path;
    sampling.shutterOpen = spec.camera.shutter > 0;
    sampling.cameraTrack = spec.cameraTrack;
    sampling.previousCameraTrack = before.cameraTrack();
    sampling.wanted = wanted | SignalSet{Signal::Depth};
    auto signals = std::make_shared<Signals>();
    if (!tracer.sample(sampling, *signals, stop)) throw Error(ErrorKind::Interrupted, {"interrupted", "", "", ""});
    return signals;
}

class ReferenceRenderer {
public:
    ReferenceRenderer(const ReferenceCommand& options, const MachineOptions& machine, MessageLog& log,
                      std::stop_token stop, BlockTeam* team)
        : options_(options), machine_(machine), log_(log), stop_(stop), team_(team), job_(options, machine, log, stop) {
        checkNames();
        const BufferSelection selection = BufferSelection::parse(options.buffers, "accumulate", "--buffers");
        if (!selection.taps.empty() && !(selection.taps == BufferSelection::all("accumulate").taps))
            throwUsage(
                {"a reference has no taps of modules", "--buffers", "signals from `lumiscope list buffers`", ""});
        layers_ = selection.signals;
    }

    int run() {
        job_.forEachFrame([&](int64_t number, Document& document) {
            if (options_.samples) tracePart(document);
            else converge(number, document);
            if (team_) team_->nextImage();
            return true;
        });
        print();
        return 0;
    }

private:
    void checkNames() {
        names_ = options_.out;
        const std::string stem = job_.file().stem().string();
        if (options_.samples) {
            const auto [begin, end] = *options_.samples;
            if (names_.empty()) names_.push_back(fmt::format("{}.{}-{}.lumiref", stem, begin, end));
            if (names_.size() > 1) throwUsage({"a part is one file", "--out", "one name", ""});
            const std::string extension = lowerExtension(names_[0]);
            if (extension == ".exr" || extension == ".png" || extension == ".mp4")
                throwUsage(
                    {"a part holds sums for `lumiscope merge`, no image", names_[0], "a name like part.lumiref", ""});
            return requireWritable(numberedName(names_[0], options_.frames.begin));
        }
        const bool many = options_.frames.end - options_.frames.begin > 1;
        if (names_.empty()) {
            const std::string name = unusedPath(stem + ".reference.exr").string();
            std::string pattern;
            for (const char c : name) pattern += c == '%' ? "%%" : std::string(1, c);
            names_.push_back(many ? pattern.substr(0, pattern.size() - 4) + ".%04d.exr" : pattern);
        }
        for (const std::string& name : names_) {
            bool numbered = false;
            numberedName(name, 0, &numbered);
            const std::string extension = lowerExtension(name);
            if (extension != ".exr" && extension != ".png")
                throwUsage({"cannot write this kind of file", name, ".exr or .png", '"' + extension + '"'});
            if (many && !numbered) throwUsage({"each frame is a file of its own", name, "%04d in the name", ""});
            std::error_code failure;
            if (fs::is_directory(name, failure)) throwUsage({"is a folder", name, "a file name", ""});
            requireWritable(numberedName(name, options_.frames.begin));
        }
    }

    ReferenceOptions referenceOptions(ReferenceStatus& status) const {
        ReferenceOptions options;
        options.cache = defaultReferenceCache();
        options.log = &log_;
        options.progress = [&status](const ReferenceProgress& progress) { status.set(progress); };
        options.stop = stop_;
        options.team = team_;
        return options;
    }
    bool showsProgress() const {
        return !machine_.quiet &&
               (options_.progress == Progress::Always || (options_.progress == Progress::Auto && stderrIsTerminal()));
    }

    void converge(int64_t number, const Document& document) {
        const ReferenceSpec spec = referenceSpec(document);
        const bool many = options_.frames.end - options_.frames.begin > 1;
        ReferenceStatus status(
            many ? fmt::format("frame {} of {}..{}  ", number, options_.frames.begin, options_.frames.end) : "",
            options_.error);
        Reference reference;
        {
            const ProgressLine line(showsProgress(), [&status] { return status.text(); });
            reference = makeReference(spec, job_.goal(), referenceOptions(status));
        }
        std::shared_ptr<const Signals> signals;
        if (!layers_.empty()) signals = traceLayers(spec, job_.before(number), layers_, reference.samples, stop_);
        const ReferencePicture picture =
            ReferencePicture::of(document, job_.sceneReference(), options_.buffers, options_.half);
        for (const std::string& name : names_) {
            files_.push_back(numberedName(name, number));
            picture.write(files_.back(), reference, options_.buffers, signals).warn(log_);
        }
        json entry = {{"frame", number},
                      {"samples", reference.samples},
                      {"error", std::isfinite(reference.error) ? json(reference.error) : json()},
                      {"cached", reference.cached},
                      {"cache_file", reference.file.string()}};
        if (!machine_.quiet && !machine_.json)
            std::fputs(fmt::format("{}{} samples a pixel{}{}\n", many ? fmt::format("frame {}: ", number) : "",
                                   reference.samples,
                                   std::isfinite(reference.error)
                                       ? fmt::format(", relative standard error {:.3g}", reference.error)
                                       : "",
                                   reference.cached ? ", from the cache" : "")
                           .c_str(),
                       stderr);
        entries_.push_back(std::move(entry));
    }

    void tracePart(const Document& document) {
        const SampleRange range{options_.samples->first, options_.samples->second};
        const ReferencePicture picture = ReferencePicture::of(document, job_.sceneReference(), "", options_.half);
        ReferenceStatus status("", 0);
        const std::string name = numberedName(names_[0], options_.frames.begin);
        const ProgressLine line(showsProgress(), [&status] { return status.text(); });
        makeReferencePart(referenceSpec(document), range, name, picture.text(), referenceOptions(status));
        files_.push_back(name);
        entries_.push_back(
            {{"frame", options_.frames.begin}, {"first_sample", range.begin}, {"samples", range.count()}});
    }

    void print() const {
        if (machine_.json) {
            const json result = {{"references", entries_},
                                 {"files", files_},
                                 {"peak_memory_bytes", peakResidentBytes()},
                                 {"warnings", log_.warnings()}};
            std::puts(jsonText(result, 2).c_str());
        }
        if (machine_.quiet) return;
        for (size_t i = 0; i < std::min<size_t>(files_.size(), 4); ++i)
            std::fputs(("Wrote " + files_[i] + "\n").c_str(), stderr);
        if (files_.size() > 4) std::fputs(fmt::format("... and {} more files\n", files_.size() - 4).c_str(), stderr);
    }

    const ReferenceCommand& options_;
    const MachineOptions& machine_;
    MessageLog& log_;
    std::stop_token stop_;
    BlockTeam* team_;
    ReferenceJob job_;
    SignalSet layers_;
    std::vector<std::string> names_, files_;
    json entries_ = json::array();
};

}  // namespace

int runReference(const ReferenceCommand& options, const MachineOptions& machine, MessageLog& log, std::stop_token stop,
                 BlockTeam* team) {
    return ReferenceRenderer(options, machine, log, stop, team).run();
}

int serveReference(const ReferenceCommand& options, const MachineOptions& machine, MessageLog& log,
                   std::stop_token stop, const std::function<bool(BlockTracer&)>& serve) {
    MachineOptions silent = machine;
    silent.quiet = true;  // the first process tells what there is to tell
    ReferenceJob job(options, silent, log, stop);
    job.forEachFrame([&](int64_t, Document& document) {
        BlockTracer tracer(referenceSpec(document));
        return serve(tracer);
    });
    return 0;
}

}  // namespace lumi
