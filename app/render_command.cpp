#include "app/render_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "app/render_resume.h"
#include "base/error.h"
#include "base/files.h"
#include "base/isa.h"
#include "base/memory.h"
#include "math/statistics.h"
#include "session/ray_rate.h"

namespace lumi {
namespace fs = std::filesystem;
using nlohmann::json;
namespace {

std::string fileName(const std::string& instance) {
    std::string name = instance;
    std::replace(name.begin(), name.end(), '@', '-');
    return name;
}

/// `<scene>.<module>.exr` in the current folder, with a number if that exists.
std::string defaultOutput(const fs::path& scene, const std::string& instance) {
    const std::string name = unusedPath(scene.stem().string() + "." + fileName(instance) + ".exr").string();
    std::string pattern;  // a name of --out, where % stands before the frame's number
    for (const char c : name) pattern += c == '%' ? "%%" : std::string(1, c);
    return pattern;
}

/// The instance whose image the last frame of a replay shows; `instance` is that of the first.
std::string lastInstance(const Replay& replay, int view, std::string instance) {
    const std::string id = fmt::format("view.{}.module", view);
    for (const auto& [frame, values] : replay.sets)
        if (frame <= replay.last && values.contains(id) && values[id].is_string())
            instance = values[id].get<std::string>();
    return instance;
}

/// What is told at the end, gathered frame by frame.
class Summary {
public:
    void add(const FrameOutput& frame) {
        ++frames_;
        const RayRate rate = rayRate(frame);
        rays_ += rate.rays, traceMs_ += rate.ms;
        nonFinite_ += frame.rays.nonFinite;
        for (const auto& [instance, rays] : frame.runRays) nonFinite_ += rays.nonFinite;
        moduleBytes_ = frame.moduleBytes;
        pixels_ = std::max<int64_t>(frame.camera.extent.area(), 1);
        for (const auto& [stage, ms] : frame.stagesMs) {
            if (!stages_.count(stage)) order_.push_back(stage);
            stages_[stage].push_back(ms);
        }
    }
    void print(const RenderOutputs& outputs, const MachineOptions& machine, MessageLog& log, double seconds) const {
        if (nonFinite_ > 0) log.warning(fmt::format("{} path contributions were not finite and were dropped", nonFinite_));
        const double mraysPerSecond = traceMs_ > 0 ? static_cast<double>(rays_) / traceMs_ / 1000 : 0;
        if (machine.json) {
            json stages = json::object();
            for (const std::string& stage : order_) stages[stage] = median(stages_.at(stage));
            const json result = {{"frames", frames_},        {"frames_kept", kept_}, {"stages_ms", stages},
                                 {"rays", rays_},            {"mrays_per_s", mraysPerSecond},
                                 {"files", outputs.files()}, {"peak_memory_bytes", peakResidentBytes()},
                                 {"module_bytes", moduleBytes_}, {"warnings", log.warnings()}};
            std::puts(result.dump(2).c_str());
        }
        if (machine.quiet) return;
        const size_t shown = std::min<size_t>(outputs.files().size(), 4);
        for (size_t i = 0; i < shown; ++i) std::fputs(("Wrote " + outputs.files()[i] + "\n").c_str(), stderr);
        if (shown < outputs.files().size())
            std::fputs(fmt::format("... and {} more files\n", outputs.files().size() - shown).c_str(), stderr);
        std::fputs(fmt::format("{} frame{}, {:.1f} Mrays at {:.2f} Mray/s, {:.1f} s, {}\n", frames_, frames_ == 1 ? "" : "s",
                               static_cast<double>(rays_) / 1e6, mraysPerSecond, seconds, formatBytes(peakResidentBytes()))
                       .c_str(),
                   stderr);
        for (const auto& [instance, bytes] : moduleBytes_)
            if (bytes > 0)
                std::fputs(fmt::format("{} holds {}, {:.0f} bytes a pixel\n", instance, formatBytes(bytes),
                                       static_cast<double>(bytes) / static_cast<double>(pixels_)).c_str(), stderr);
    }

    void keep(int64_t frames) { kept_ = frames; }

private:
    int64_t frames_ = 0, kept_ = 0;
    uint64_t rays_ = 0, nonFinite_ = 0;
    double traceMs_ = 0;
    std::map<std::string, size_t> moduleBytes_;  ///< after the last frame, by instance
    int64_t pixels_ = 1;
    std::map<std::string, std::vector<double>> stages_;
    std::vector<std::string> order_;
};

/// Runs frames and writes what is asked for.
class Renderer {
public:
    Renderer(const RenderOptions& options, const MachineOptions& machine, MessageLog& log, std::stop_token stop)
        : options_(options), machine_(machine), log_(log), stop_(stop) {}

    int render() {
        const fs::path file = findScene(options_.scene.scene);
        auto scene = openScene(file, options_.scene, log_, stop_);
        Document document = makeDocument(scene, options_.scene, log_);
        choice_ = {0, options_.buffers, options_.half};
        const std::string& instance = document.view(choice_.view).module;
        BufferSelection::parse(choice_.buffers, instance, "--buffers");
        start(document, file, instance, {options_.scene.scene, scene->contentDigest});

        const FrameRange& range = options_.frames;
        const Clock clock{0, 0, document.render().fps};
        const int64_t first = range.begin - options_.warmUp;
        const bool timed = range.end - first > 1 || first > 0;
        const std::optional<CameraPath> path = readCameraPathOf(options_.scene);
        const std::function<Document(int64_t)> documentAt = [&](int64_t number) {
            Document then = document;
            if (timed) then.setTime(clock.at(number));
            followCameraPath(then, path);
            return then;
        };
        const ResumePlan plan = planResume(*outputs_, {options_.scene.scene, scene->contentDigest}, choice_, documentAt, first,
                                           range.begin, range.end);
        if (plan.kept > 0) log_.info(fmt::format("{} frames are there already", plan.kept));
        summary_.keep(plan.kept);
        last_ = range.end - 1, first_ = plan.from;
        for (int64_t number = plan.from; number < range.end; ++number) {
            // What is there is trusted when the last of it comes out again as it is.
            const bool check = plan.kept > 0 && number == range.begin + plan.kept - 1 && number < plan.write;
            draw(documentAt(number), number, number == plan.from,
                 number >= plan.write ? Fate::Written : check ? Fate::Checked : Fate::Dropped);
        }
        return finish(range.begin, range.end);
    }

    int replay() {
        const Replay replay = readReplay(options_.replay);
        if (machine_.isa.empty()) useIsa(replay.isa);
        const fs::path file = sceneOf(replay);
        LoadOptions load;
        load.stop = stop_;
        load.sceneIndex = replay.start.value("scene.index", -1);
        load.variant = replay.start.value("scene.variant", "");
        auto scene = loadScene(file, log_, load);
        if (scene->contentDigest != replay.scene.digest)
            throwBadInput({"the scene changed since the image was made", file.string(), "content " + replay.scene.digest,
                           scene->contentDigest});
        Document document(scene);
        const std::string where = options_.replay.string();
        applyState(document, replay.start);
        choice_ = OutputChoice::parse(replay.output, where);
        start(document, file, lastInstance(replay, choice_.view, document.view(choice_.view).module), replay.scene);
        first_ = replay.first, last_ = replay.last;
        for (FrameNumber number = replay.first; number <= replay.last; ++number) {
            if (const std::optional<json> values = replay.valuesOf(number)) applyState(document, *values);
            draw(document, number, number == replay.first, number == replay.last ? Fate::Written : Fate::Dropped);
        }
        return finish(replay.last, replay.last + 1);
    }

private:
    enum class Fate { Dropped, Checked, Written };

    /// `instance` is the one whose image the last frame shows, for the default name.
    void start(const Document& document, const fs::path& file, const std::string& instance, SceneReference reference) {
        printMessages(log_, machine_);
        std::vector<std::string> names = options_.out;
        if (names.empty()) names.push_back(defaultOutput(file, instance));
        outputs_ = std::make_unique<RenderOutputs>(names, choice_, document.render().fps, log_);
        states_ = StateLog(std::move(reference));
        const RenderSettings& render = document.render();
        checkMemory(fmt::format("rendering {}x{}", render.width, render.height),
                    uint64_t(400) * static_cast<uint64_t>(render.width) * static_cast<uint64_t>(render.height));
        engine_.emplace(log_);
        total_.restart();
    }

    void draw(const Document& document, FrameNumber number, bool cut, Fate fate) {
        const bool last = number == last_;
        FrameRequest request{document, number, cut, {}, {}};
        if (fate != Fate::Dropped && outputs_->wantsLayers(last)) {
            // A replay may have changed the module since its first frame.
            const std::string& instance = document.view(choice_.view).module;
            const BufferSelection buffers = buffersOf(instance);
            request.signals = buffers.signals;
            request.signals.add(Signal::Depth);
            request.taps[instance] = buffers.taps;
        }
        const std::optional<FrameOutput> frame = drawWithProgress(request);
        if (!frame) throw Error(ErrorKind::Interrupted, {"interrupted", "", "", ""});
        states_.record(*frame, std::make_shared<Document>(document));
        summary_.add(*frame);
        if (fate == Fate::Written) outputs_->write(*frame, document, states_, last);
        else if (fate == Fate::Checked) outputs_->verify(*frame, document, states_);
    }

    std::optional<FrameOutput> drawWithProgress(const FrameRequest& request) {
        const bool shown = !machine_.quiet && (options_.progress == Progress::Always ||
                                               (options_.progress == Progress::Auto && stderrIsTerminal()));
        const RenderSettings& render = request.document.render();
        const double frameRays = static_cast<double>(render.width) * render.height * render.samplesPerPixel;
        const double frames = static_cast<double>(last_ - first_ + 1);
        ProgressLine line(shown, [&] {
            const double part = std::min(static_cast<double>(engine_->tracedSoFar().cameraRays) / frameRays, 1.0);
            const double fraction = (static_cast<double>(request.frame - first_) + part) / frames;
            const double seconds = total_.elapsedMs() / 1000;
            const double left = fraction > 0.01 ? seconds / fraction - seconds : 0;
            return fmt::format("frame {} of {}..{}  {:3.0f}%  {} left", request.frame, first_, last_ + 1, 100 * fraction,
                               fraction > 0.01 ? formatDuration(left) : "?");
        });
        return engine_->advance(request, stop_);
    }

    int finish(int64_t begin, int64_t end) {
        outputs_->finish(begin, end);
        summary_.print(*outputs_, machine_, log_, total_.elapsedMs() / 1000);
        return 0;
    }

    /// What does not fit is the replayed file's fault, not the command's.
    template <class Body>
    auto blamingFile(Body body) const {
        try {
            return body();
        } catch (const Error& error) {
            const bool fromFile = !options_.replay.empty() && error.kind() == ErrorKind::Usage;
            throw Error(fromFile ? ErrorKind::BadInput : error.kind(), error.text());
        }
    }
    void applyState(Document& document, const json& values) const {
        blamingFile([&] { document.apply(values, options_.replay.string()); });
    }
    BufferSelection buffersOf(const std::string& instance) const {
        const std::string where = options_.replay.empty() ? "--buffers" : options_.replay.string();
        return blamingFile([&] { return BufferSelection::parse(choice_.buffers, instance, where); });
    }

    /// Where the replayed scene is now: as given beside --replay, as it was called then, or beside the file.
    fs::path sceneOf(const Replay& replay) const {
        if (!options_.scene.scene.empty()) return findScene(options_.scene.scene);
        const fs::path beside = options_.replay.parent_path() / replay.scene.name;
        if (!fs::exists(replay.scene.name) && fs::exists(beside)) return beside;
        return findScene(replay.scene.name);
    }

    void useIsa(const std::string& name) const {
        const Isa isa = parseIsa(name);
        if (isa <= detectIsa()) setIsa(isa);
        else log_.warning(fmt::format("the image was made with instruction set {}, this machine has {}: last bits may differ",
                                      name, isaName(detectIsa())));
    }

    const RenderOptions& options_;
    const MachineOptions& machine_;
    MessageLog& log_;
    std::stop_token stop_;
    std::optional<FrameEngine> engine_;  ///< made when the instruction set is known
    std::unique_ptr<RenderOutputs> outputs_;
    OutputChoice choice_;
    StateLog states_;
    Summary summary_;
    int64_t first_ = 0, last_ = 0;
    Timer total_;
};

}  // namespace

int runRender(const RenderOptions& options, const MachineOptions& machine, MessageLog& log, std::stop_token stop) {
    Renderer renderer(options, machine, log, stop);
    return options.replay.empty() ? renderer.render() : renderer.replay();
}

}  // namespace lumi
