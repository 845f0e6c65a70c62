#include "app/cli.h"

#include <CLI/CLI.hpp>
#include <algorithm>

#include "app/help_text.h"
#include "app/option_text.h"
#include "base/error.h"

namespace lumi {
namespace {

/// An option that may stand several times, each with one value.
void addRepeatable(CLI::App& app, const char* name, std::vector<std::string>& values, const char* type, const char* help) {
    app.add_option(name, values, help)->type_name(type)->expected(1)->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
}

void addShared(CLI::App& app, SharedText& text, SceneOptions& scene) {
    addRepeatable(app, "--module", scene.modules, "INSTANCE", "Method that makes the image, as `list modules` names it");
    addRepeatable(app, "--set", text.set, "ID=VALUE", "Set any parameter of `list parameters`; repeatable");
    app.add_option("--size", text.size, "Size of the rendered image (the scene's, else 1280x720)")->type_name("WxH")->take_last();
    app.add_option("--spp", text.spp, "Samples a pixel in each frame (1)")->type_name("N")->take_last();
    app.add_option("--fps", text.fps, "Frames a second: frame f shows time f/F (60)")->type_name("F")->take_last();
    app.add_option("--camera", text.camera, "Camera of the scene by name or number (the first)")
        ->type_name("NAME|INDEX")->take_last();
    app.add_option("--seed", text.seed, "Another set of random numbers (0)")->type_name("N")->take_last();
    app.add_option("--exposure", text.exposure, "Exposure of PNG, video and screen, in stops (the scene's)")
        ->type_name("EV")->take_last();
}

void addCameraPath(CLI::App& app, SceneOptions& scene) {
    app.add_option("--camera-path", scene.cameraPath, "Keys for the camera: our own JSON or instant-ngp's")
        ->type_name("FILE")->take_last();
}

void addMachine(CLI::App& app, MachineOptions& machine, bool computes) {
    app.add_flag("--json", machine.json, "Print the result as one JSON value on standard output");
    app.add_flag("--quiet", machine.quiet, "Print nothing but errors");
    if (!computes) return;
    app.add_option("--threads", machine.threads, "Threads to use (one for each core); never changes the image")
        ->type_name("N")
        ->check(CLI::Range(1, 1024).description(""));
    app.add_option("--isa", machine.isa, "Instruction set to use: baseline, v3 or v4 (the best)")->type_name("NAME");
    app.add_option("--memory-limit", machine.memoryLimit, "Refuse to use more, as 8G or 50% (75%)")->type_name("SIZE");
}

void addFrames(CLI::App& app, std::string& frames, std::string& warmUp) {
    app.add_option("--frames", frames, "Frames 0..N-1, or A..B without B; history is empty at A (1)")
        ->type_name("N|A..B")->take_last();
    app.add_option("--warm-up", warmUp, "Frames to run before the first without writing them (0)")
        ->type_name("N")->take_last();
}

/// Says which option was meant, where CLI11 only says which one it does not know.
[[noreturn]] void throwParseError(const CLI::App& app, const CLI::ParseError& error) {
    const CLI::App* active = &app;
    if (!app.get_subcommands().empty()) active = app.get_subcommands().front();
    std::vector<std::string> known;
    for (const CLI::Option* option : active->get_options())
        for (const std::string& name : option->get_lnames()) known.push_back("--" + name);
    for (const std::string& word : active->remaining()) {
        if (word.compare(0, 2, "--") != 0) continue;
        const std::string near = nearestName(word.substr(0, word.find('=')), known);
        throwUsage({"unknown option " + word, "", near.empty() ? "one of those in --help" : near, ""});
    }
    std::string text = error.what();
    std::replace(text.begin(), text.end(), '\n', ' ');
    throwUsage({text + " (see --help)", "", "", ""});
}

/// One object with a member for each value that CLI11 fills.
class Parser {
public:
    Parser() : app_("Path-traces scenes and reconstructs clean, stable images from few samples.", "lumiscope") {
        app_.set_version_flag("--version", versionText());
        app_.set_help_flag("-h,--help", "Print this help");
        app_.footer(mainFooter);
        app_.require_subcommand(0, 1);
        app_.get_formatter()->column_width(34);
        addWindow();
        addRender();
        addReference();
        addMerge();
        addCompare();
        addStudy();
        addBench();
        addInfo();
        addList();
        addView();
    }

    CommandLine parse(int argc, const char* const* argv) {
        try {
            app_.parse(argc, argv);
        } catch (const CLI::CallForVersion&) {
            return printed(std::string(versionText()) + "\n");
        } catch (const CLI::CallForHelp&) {
            const auto used = app_.get_subcommands();
            return printed(used.empty() ? app_.help() : used.front()->help("lumiscope"));
        } catch (const CLI::ParseError& error) {
            throwParseError(app_, error);
        }
        return finished();
    }

private:
    CommandLine printed(std::string text) {
        CommandLine line;
        line.command = Command::PrintAndExit;
        line.text = std::move(text);
        return line;
    }

    void addWindow() {
        app_.add_option("scene", line_.scene.scene, "Scene to open (atrium)")->type_name("SCENE");
        addShared(app_, windowText_, line_.scene);
        addMachine(app_, line_.machine, true);
        app_.add_option("--captures", line_.captures, "Folder for screenshots (the current one)")->type_name("DIR");
        app_.add_option("--ui-map", line_.uiMap, "Write where every item of the window is to this file, as JSON")
            ->type_name("FILE")->group("Testing");
    }

    void addRender() {
        CLI::App* app = render_ = app_.add_subcommand("render", "Render frames through one module, without a window");
        RenderOptions& render = line_.render;
        app->add_option("scene", render.scene.scene, "Scene to render: a name or a path")->type_name("SCENE");
        app->add_option("--replay", render.replay, "Make the image of a .exr, .png or .json again from the state inside")
            ->type_name("FILE");
        addShared(*app, renderText_, render.scene);
        addFrames(*app, frames_, warmUp_);
        addCameraPath(*app, render.scene);
        addRepeatable(*app, "--out", render.out, "PATH",
                      "File to write: .exr, .png or .mp4, %04d is the frame number; repeatable "
                      "(<scene>.<module>.exr, a free name)");
        app->add_option("--buffers", render.buffers, "Layers to add to .exr files, as `list buffers` names them, or all")
            ->type_name("NAME,...");
        app->add_flag("--half", render.half, "Store colours of .exr files as half");
        addProgress(*app);
        addMachine(*app, line_.machine, true);
        app->footer(renderFooter);
    }

    void addReference() {
        CLI::App* app = reference_ = app_.add_subcommand("reference", "Converge an image, kept and resumable");
        ReferenceCommand& reference = line_.reference;
        app->add_option("scene", reference.scene.scene, "Scene to render: a name or a path")->required()->type_name("SCENE");
        addShared(*app, referenceText_, reference.scene);
        app->get_option("--spp")->description("Samples a pixel (1024)");
        app->get_option("--module")->description("accumulate, which is what converges");
        app->add_option("--error", reference.error,
                        "Instead of --spp: go on until the relative standard error is at most this")
            ->type_name("E")->check(CLI::Range(1e-6, 1e3).description(""))
            ->excludes("--spp")
            ->take_last();
        app->add_option("--samples", samples_, "Only the sums of samples A to B-1, multiples of 16, for `merge`")
            ->type_name("A..B")
            ->excludes("--error")
            ->take_last();
        addCameraPath(*app, reference.scene);
        app->add_option("--frames", referenceFrames_, "A reference for each of frames 0..N-1, or A..B without B (1)")
            ->type_name("N|A..B")->take_last();
        addRepeatable(*app, "--out", reference.out, "PATH",
                      "File to write: .exr or .png, %04d is the frame number; repeatable (<scene>.reference.exr, a free name)");
        app->add_option("--buffers", reference.buffers, "Signals to add to .exr files as layers, or all")->type_name("NAME,...");
        app->add_flag("--half", reference.half, "Store colours of .exr files as half");
        addProgress(*app);
        addMachine(*app, line_.machine, true);
        app->footer(referenceFooter());
    }

    void addMerge() {
        CLI::App* app = merge_ = app_.add_subcommand("merge", "Add up parts that `reference --samples` wrote");
        app->add_option("parts", line_.merge.parts, "Parts whose samples follow each other, in any order")
            ->required()->type_name("PART...");
        app->add_option("--out", line_.merge.out, "Image (.exr, .png), or a larger part (.lumiref)")
            ->required()->type_name("FILE")->take_last();
        addMachine(*app, line_.machine, true);
        app->footer("Example:\n  lumiscope merge a.lumiref b.lumiref --out cornell.exr");
    }

    void addProgress(CLI::App& app) {
        app.add_option("--progress", progress_, "auto (if standard error is a terminal), always or never")
            ->type_name("WHEN")
            ->check(CLI::IsMember({"auto", "always", "never"}).description(""));
    }
    Progress progress() const {
        return progress_ == "always" ? Progress::Always : progress_ == "never" ? Progress::Never : Progress::Auto;
    }

    void addCompare() {
        CLI::App* app = compare_ = app_.add_subcommand("compare", "Measure how far an image is from its reference");
        CompareOptions& compare = line_.compare;
        app->add_option("image", compare.image, "Image to judge: .exr, .hdr, .png, .jpg, .bmp or .tga; frames as a.%04d.exr")
            ->required()->type_name("IMAGE");
        app->add_option("reference", compare.reference, "What it should be, of the same size")
            ->required()->type_name("REFERENCE");
        app->add_option("--metrics", metrics_, "Only these, as `list metrics` names them (all)")
            ->type_name("NAME,...")->take_last();
        app->add_option("--maps", compare.maps, "Folder for error maps, .exr and in false colour .png; made if missing")
            ->type_name("DIR")->take_last();
        app->add_option("--crop", crop_, "Only this part of both, in pixels from the top left")
            ->type_name("X,Y,W,H")->take_last();
        app->add_option("--mask", compare.mask, "Image of the same size: only where its luminance is above 0.5")
            ->type_name("FILE")->take_last();
        app->add_option("--exposure", compare.exposureEv, "Stops, for metrics that judge the image as shown (0)")
            ->type_name("EV")->check(CLI::Range(-100.0, 100.0).description(""))
            ->take_last();
        app->add_option("--flip-exposures", flipExposures_, "Exposure range of HDR-FLIP in stops (what the reference says)")
            ->type_name("START,STOP[,COUNT]")->take_last();
        app->add_option("--frames", compareFrames_, "Of frames: 0..N-1, or A..B without B (those there are)")
            ->type_name("N|A..B")->take_last();
        addMachine(*app, line_.machine, true);
        app->footer(compareFooter());
    }

    void addStudy() {
        CLI::App* app = study_ = app_.add_subcommand("study", "Run a study: scenes, methods and metrics, with a report");
        app->add_option("file", line_.study.file, "Study to run: a name or a path")->required()->type_name("FILE");
        app->add_option("--preset", line_.study.preset, "Size of the study: quick (if it has that), paper, or another")
            ->type_name("NAME")->take_last();
        app->add_option("--out", line_.study.out, "Folder for results, resumed if it holds some (<study>-<preset>)")
            ->type_name("DIR")->take_last();
        addProgress(*app);
        addMachine(*app, line_.machine, true);
        app->footer(studyFooter());
    }

    void addBench() {
        CLI::App* app = bench_ = app_.add_subcommand("bench", "Measure this machine's speed against bare Embree");
        app->add_option("--filter", line_.filter, "Only entries in whose name this regular expression is found")
            ->type_name("RE")->take_last();
        addMachine(*app, line_.machine, true);
        app->footer(benchFooter);
    }

    void addInfo() {
        CLI::App* app = info_ = app_.add_subcommand("info", "Tell what a scene holds, and every warning");
        app->add_option("scene", infoScene_, "Scene to read: a name or a path")->required()->type_name("SCENE");
        addRepeatable(*app, "--set", infoText_.set, "ID=VALUE", "Set any parameter, as scene.index=N; repeatable");
        app->add_option("--write-camera-path", line_.writeCameraPath,
                        "Write the camera's keys as JSON; a name in .ngp.json is for instant-ngp")
            ->type_name("FILE")->take_last();
        app->add_option("--camera", infoText_.camera, "Camera whose keys are written (the first)")
            ->type_name("NAME|INDEX")->take_last();
        app->add_flag("--check", line_.check,
                      "Trace two small frames and verify every rule that filters rely on; exit 1 if one is broken");
        addMachine(*app, line_.machine, true);
        app->footer("Examples:\n  lumiscope info atrium --json\n  lumiscope info model.glb --check");
    }

    void addList() {
        CLI::App* app = list_ = app_.add_subcommand("list", "List what there is: scenes, modules, buffers, parameters, metrics, studies");
        app->add_option("what", line_.list.what, "scenes, modules, buffers, parameters, metrics or studies")
            ->required()->type_name("WHAT")
            ->check(CLI::IsMember({"scenes", "modules", "buffers", "parameters", "metrics", "studies"}).description(""));
        app->add_option("--module", line_.list.module, "Only what belongs to this module")->type_name("INSTANCE");
        addMachine(*app, line_.machine, false);
        app->footer("Examples:\n  lumiscope list parameters --module accumulate\n  lumiscope list buffers --json");
    }

    void addView() {
        CLI::App* app = view_ = app_.add_subcommand("view", "Draw the window's content into PNGs, without a display");
        app->add_option("scene", viewScene_.scene, "Scene to open: a name or a path")->required()->type_name("SCENE");
        app->add_flag("--offscreen", offscreen_, "Draw without a display");
        app->add_option("--out", line_.view.out, "Folder for the PNGs; made if missing")->type_name("DIR");
        app->add_option("--script", line_.view.script, "Input events to play, one a line")->type_name("FILE");
        app->add_option("--window", windowSize_, "Size of the window's content (1280x800)")->type_name("WxH");
        app->add_option("--samples", line_.view.samples, "Without a script: samples a pixel before the shot (16)")
            ->type_name("N")->check(CLI::Range(1, 1 << 20).description(""));
        addFrames(*app, frames_, warmUp_);
        app->add_option("--buffers", line_.view.buffers,
                        "Write an .exr beside each PNG, with these layers, as `list buffers` names them, or all")
            ->type_name("NAME,...")->take_last();
        app->add_flag("--half", line_.view.half, "Store colours of .exr files as half");
        addProgress(*app);
        addShared(*app, viewText_, viewScene_);
        addMachine(*app, line_.machine, true);
        app->footer(viewFooter());
    }

    CommandLine finished() {
        if (render_->parsed()) finishRender();
        else if (reference_->parsed()) finishReference();
        else if (merge_->parsed()) line_.command = Command::Merge;
        else if (compare_->parsed()) finishCompare();
        else if (study_->parsed()) finishStudy();
        else if (bench_->parsed()) line_.command = Command::Bench;
        else if (info_->parsed()) finishInfo();
        else if (list_->parsed()) line_.command = Command::List;
        else if (view_->parsed()) finishView();
        else addValues(windowText_, line_.scene);
        return line_;
    }

    void finishRender() {
        line_.command = Command::Render;
        RenderOptions& render = line_.render;
        addValues(renderText_, render.scene);
        if (render.scene.modules.size() > 1)
            throwUsage({"render runs one module", "--module", "one instance", ""});
        if (!frames_.empty()) render.frames = parseFrames(frames_);
        render.warmUp = parseWarmUp(warmUp_, render.frames);
        checkTime(render);
        render.progress = progress();
        if (render.scene.scene.empty() && render.replay.empty())
            throwUsage({"render needs a scene", "", "lumiscope render SCENE, or --replay FILE", ""});
        if (!render.replay.empty() && (!render.scene.values.empty() || !frames_.empty() || !warmUp_.empty() ||
                                       !render.scene.cameraPath.empty() || !render.buffers.empty() || render.half))
            throwUsage({"everything about the image comes from the file", "--replay",
                        "only SCENE (where it is now), --out and options of the machine beside it", ""});
    }

    /// The frames' numbers give the time.
    static void checkTime(const RenderOptions& render) {
        if (render.frames.end <= 1) return;
        for (const TypedValue& value : render.scene.values)
            if (value.id == "time")
                throwUsage({"the number of a frame gives its time", value.option, "time only without --frames", ""});
    }

    void finishReference() {
        line_.command = Command::Reference;
        ReferenceCommand& reference = line_.reference;
        addValues(referenceText_, reference.scene);
        for (const std::string& module : reference.scene.modules)
            if (module != "accumulate")
                throwUsage({"a reference is the mean of its samples", "--module", "accumulate", '"' + module + '"'});
        if (!referenceFrames_.empty()) reference.frames = parseFrames(referenceFrames_);
        reference.progress = progress();
        if (samples_.empty()) return;
        reference.samples = parseSamples(samples_, "--samples");
        if (reference.frames.end - reference.frames.begin > 1)
            throwUsage({"a part is one of one image", "--samples", "one frame", ""});
        if (!referenceText_.spp.empty() || !reference.buffers.empty())
            throwUsage({"a part holds just its samples", "--samples", "no --spp and no --buffers beside it", ""});
    }

    void finishCompare() {
        line_.command = Command::Compare;
        line_.compare.metrics = splitList(metrics_);
        if (!crop_.empty()) line_.compare.crop = parseCrop(crop_, "--crop");
        if (!flipExposures_.empty()) line_.compare.flipExposures = parseFlipExposures(flipExposures_, "--flip-exposures");
        if (!compareFrames_.empty()) {
            const FrameRange frames = parseFrames(compareFrames_);
            line_.compare.frames = {frames.begin, frames.end};
        }
        line_.compare.json = line_.machine.json;
        line_.compare.quiet = line_.machine.quiet;
    }

    void finishStudy() {
        line_.command = Command::Study;
        line_.study.progress = progress();
    }

    void finishInfo() {
        line_.command = Command::Info;
        line_.scene = {};
        line_.scene.scene = infoScene_;
        addValues(infoText_, line_.scene);
    }

    void finishView() {
        line_.command = Command::View;
        line_.scene = viewScene_;
        addValues(viewText_, line_.scene);
        if (!offscreen_) throwUsage({"view draws without a display", "", "--offscreen", ""});
        if (line_.view.out.empty()) throwUsage({"view needs a folder", "", "--out DIR", ""});
        if (!windowSize_.empty()) line_.view.size = parseSize(windowSize_, "--window");
        line_.view.progress = progress();
        if (line_.view.half && line_.view.buffers.empty()) throwUsage({"only .exr files have half colours", "--half", "--buffers", ""});
        finishViewFrames();
    }

    void finishViewFrames() {
        ViewOptions& view = line_.view;
        if (frames_.empty() && !warmUp_.empty()) throwUsage({"warms up for frames", "--warm-up", "--frames beside it", ""});
        if (frames_.empty()) return;
        if (!view.script.empty()) throwUsage({"a script says itself what is drawn", "--frames", "either of the two", ""});
        view.frames = parseFrames(frames_);
        view.warmUp = parseWarmUp(warmUp_, *view.frames);
    }

    CLI::App app_;
    CLI::App *render_ = nullptr, *reference_ = nullptr, *merge_ = nullptr, *compare_ = nullptr, *study_ = nullptr,
             *bench_ = nullptr, *info_ = nullptr, *list_ = nullptr, *view_ = nullptr;
    CommandLine line_;
    SharedText windowText_, renderText_, referenceText_, infoText_, viewText_;
    SceneOptions viewScene_;
    std::string flipExposures_, compareFrames_, infoScene_, samples_, referenceFrames_, metrics_, crop_, frames_, warmUp_, progress_ = "auto", windowSize_;
    bool offscreen_ = false;
};

}  // namespace

CommandLine parseCommandLine(int argc, const char* const* argv) { return Parser().parse(argc, argv); }

}  // namespace lumi
