#include "app/render_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "app/render_resume.h"
#include "app/render_summary.h"
#include "base/error.h"
#include "base/files.h"
#include "base/isa.h"
#include "base/memory.h"

namespace lumi {
namespace fs = std::filesystem;
using nlohmann::json;
namespace {

std::string fileName(const std::string& instance) {
    std::string name = instance;
    std::replace(name.begin(), name.end(), '@', '-');
    return name;
}

/// `<scene>.<module>.exr` in the current folder, with a number if that exists; `eye` goes before the extension.
std::string defaultOutput(const fs::path& scene, const std::string& instance, const std::string& eye) {
    const std::string name = unusedPath(scene.stem().string() + "." + fileName(instance) + eye + ".exr").string();
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

/// Runs frames and writes what is asked for.
class Renderer {
public:
    Renderer(const RenderOptions& options, const MachineOptions& machine, MessageLog& log, std::stop_token stop)
        : options_(options), machine_(machine), log_(log), stop_(stop) {}

    int render() {
        const fs::path file = findScene(options_.scene.scene);
        const auto scene = openScene(file, options_.scene, log_, stop_);
        std::vector<Sequence> sequences;
        if (!options_.stereo) sequences.push_back(sequenceOf(makeDocument(scene, options_.scene, log_), file, ""));
        for (const std::string eye : {"left", "right"}) {
            if (!options_.stereo) break;
            MessageLog toldAlready;  // with the first eye
            const SceneOptions seen = seenBy(eye);
            sequences.push_back(
                sequenceOf(makeDocument(scene, seen, sequences.empty() ? log_ : toldAlready), file, eye));
        }
        printMessages(log_, machine_);
        for (const Sequence& sequence : sequences) drawSequence(sequence, {options_.scene.scene, scene->contentDigest});
        return finish();
    }

    int replay() {
        const Replay replay = readReplay(options_.replay);
        if (machine_.isa.empty()) useIsa(replay.isa);
        const fs::path file = sceneOf(replay);
        LoadOptions load;
        load.stop = stop_;
        load.choice = replay.choice;
        auto scene = loadScene(file, log_, load);
        if (scene->contentDigest != replay.scene.digest)
            throwBadInput({"the scene changed since the image was made", file.string(),
                           "content " + replay.scene.digest, scene->contentDigest});
        Document document(scene);
        const std::string where = options_.replay.string();
        applyState(document, replay.start);
        choice_ = OutputChoice::parse(replay.output, where);
        Sequence sequence{document, "", nullptr};
        openOutputs(sequence, file, lastInstance(replay, choice_.view, document.view(choice_.view).module));
        printMessages(log_, machine_);
        start(sequence, replay.scene);
        first_ = replay.first, last_ = replay.last;
        for (FrameNumber number = replay.first; number <= replay.last; ++number) {
            if (const std::optional<json> values = replay.valuesOf(number)) applyState(document, *values);
            draw(document, number, number == replay.first, number == replay.last ? Fate::Written : Fate::Dropped);
        }
        endSequence(replay.last, replay.last + 1);
        return finish();
    }

private:
    enum class Fate { Dropped, Checked, Written };

    /// Frames of one document, or of one eye that sees it.
    struct Sequence {
        Document document;
        std::string eye;  ///< empty: no pair
        std::shared_ptr<RenderOutputs> outputs;
    };

    /// `instance` is the one whose image the last frame shows, for the default name.
    void openOutputs(Sequence& sequence, const fs::path& file, const std::string& instance) {
        const std::string eye = sequence.eye.empty() ? "" : "." + sequence.eye;
        std::vector<std::string> names = options_.out;
        for (std::string& name : names)
            if (!eye.empty())
                name = fs::path(name).replace_extension(eye + fs::path(name).extension().string()).string();
        if (names.empty()) names.push_back(defaultOutput(file, instance, eye));
        sequence.outputs = std::make_shared<RenderOutputs>(names, choice_, sequence.document.render().fps, log_);
    }

    Sequence sequenceOf(Document document, const fs::path& file, const std::string& eye) {
        choice_ = {0, options_.buffers, options_.half};
        const std::string instance = document.view(choice_.view).module;
        BufferSelection::parse(choice_.buffers, instance, "--buffers");
        Sequence sequence{std::move(document), eye, nullptr};
        openOutputs(sequence, file, instance);
        return sequence;
    }

    /// The options with that eye of the camera's pair, which goes before what --set says of it.
    SceneOptions seenBy(const std::string& eye) const {
        SceneOptions seen = options_.scene;
        auto place = seen.values.begin();
        for (auto value = seen.values.begin(); value != seen.values.end(); ++value)
            if (value->id == "camera.select") place = value + 1;
        TypedValue stereo;
        stereo.id = "camera.stereo", stereo.text = eye, stereo.option = "--stereo";
        seen.values.insert(place, stereo);
        return seen;
    }

    void start(const Sequence& sequence, SceneReference reference) {
        outputs_ = sequence.outputs;
        eye_ = sequence.eye;
        states_ = StateLog(std::move(reference));
        const RenderSettings& render = sequence.document.render();
        checkMemory(fmt::format("rendering {}x{}", render.width, render.height),
                    uint64_t(400) * static_cast<uint64_t>(render.width) * static_cast<uint64_t>(render.height));
        engine_.emplace(log_);
        sequenceTimer_.restart();
    }

    void drawSequence(const Sequence& sequence, const SceneReference& reference) {
        start(sequence, reference);
        const Document& document = sequence.document;
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
        const ResumePlan plan = planResume(*outputs_, reference, choice_, documentAt, first, range.begin, range.end);
        const std::string whose = eye_.empty() ? "" : " of the " + eye_ + " eye";
        if (plan.kept > 0) log_.info(fmt::format("{} frames{} are there already", plan.kept, whose));
        summary_.keep(plan.kept);
        last_ = range.end - 1, first_ = plan.from;
        for (int64_t number = plan.from; number < range.end; ++number) {
            // What is there is trusted when the last of it comes out again as it is.
            const bool check = plan.kept > 0 && number == range.begin + plan.kept - 1 && number < plan.write;
            draw(documentAt(number), number, number == plan.from,
                 number >= plan.write ? Fate::Written
                 : check              ? Fate::Checked
                                      : Fate::Dropped);
        }
        endSequence(range.begin, range.end);
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
            const double seconds = sequenceTimer_.elapsedMs() / 1000;
            const double left = fraction > 0.01 ? seconds / fraction - seconds : 0;
            return fmt::format("{}frame {} of {}..{}  {:3.0f}%  {} left", eye_.empty() ? "" : eye_ + " eye, ",
                               request.frame, first_, last_ + 1, 100 * fraction,
                               fraction > 0.01 ? formatDuration(left) : "?");
        });
        return engine_->advance(request, stop_, stop_);
    }

    void endSequence(int64_t begin, int64_t end) {
        outputs_->finish(begin, end, stop_);
        files_.insert(files_.end(), outputs_->files().begin(), outputs_->files().end());
    }
    int finish() {
        summary_.print(files_, machine_, log_, total_.elapsedMs() / 1000);
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
        else
            log_.warning(
                fmt::format("the image was made with instruction set {}, this machine has {}: last bits may differ",
                            name, isaName(detectIsa())));
    }

    const RenderOptions& options_;
    const MachineOptions& machine_;
    MessageLog& log_;
    std::stop_token stop_;
    std::optional<FrameEngine> engine_;  ///< made when the instruction set is known
    std::shared_ptr<RenderOutputs> outputs_;
    std::string eye_;  ///< that is being drawn
    OutputChoice choice_;
    StateLog states_;
    RenderSummary summary_;
    std::vector<std::string> files_;
    int64_t first_ = 0, last_ = 0;
    Timer total_, sequenceTimer_;
};

}  // namespace

int runRender(const RenderOptions& options, const MachineOptions& machine, MessageLog& log, std::stop_token stop) {
    Renderer renderer(options, machine, log, stop);
    return options.replay.empty() ? renderer.render() : renderer.replay();
}

}  // namespace lumi
