#include "app/options/subcommand.h"

#include "app/help_text.h"
#include "app/options/shared_options.h"
#include "base/error.h"

namespace lumi {
namespace {

class ViewSubcommand : public Subcommand {
public:
    ViewSubcommand(CLI::App& parent, CommandLine& line)
        : Subcommand(parent, line, "view", "Draw the window's content into PNGs, without a display") {
        app_->add_option("scene", scene_.scene, "Scene to open: a name or a path")->required()->type_name("SCENE");
        app_->add_flag("--offscreen", offscreen_, "Draw without a display");
        app_->add_option("--out", line_.view.out, "Folder for the PNGs; made if missing")->type_name("DIR");
        app_->add_option("--script", line_.view.script, "Input events to play, one a line")->type_name("FILE");
        app_->add_option("--window", size_, "Size of the window's content (1280x800)")->type_name("WxH");
        app_->add_option("--samples", line_.view.samples, "Without a script: samples a pixel before the shot (16)")
            ->type_name("N")
            ->check(between(1, 1 << 20));
        frames_.add(*app_);
        app_->add_option("--buffers", line_.view.buffers,
                         "Write an .exr beside each PNG, with these layers, as `list buffers` names them, or all")
            ->type_name("NAME,...")
            ->take_last();
        app_->add_flag("--half", line_.view.half, "Store colours of .exr files as half");
        progress_.add(*app_);
        addShared(*app_, text_, scene_);
        addMachine(*app_, line_.machine, true);
        app_->footer(viewFooter());
    }

    void finish() override {
        line_.command = Command::View;
        line_.scene = scene_;
        addValues(text_, line_.scene);
        if (!offscreen_) throwUsage({"view draws without a display", "", "--offscreen", ""});
        if (line_.view.out.empty()) throwUsage({"view needs a folder", "", "--out DIR", ""});
        if (!size_.empty()) line_.view.size = parseSize(size_, "--window");
        line_.view.progress = progress_.progress();
        if (line_.view.half && line_.view.buffers.empty())
            throwUsage({"only .exr files have half colours", "--half", "--buffers", ""});
        finishViewFrames();
    }

private:
    void finishViewFrames() {
        ViewOptions& view = line_.view;
        if (frames_.frames.empty() && !frames_.warmUp.empty())
            throwUsage({"warms up for frames", "--warm-up", "--frames beside it", ""});
        if (frames_.frames.empty()) return;
        if (!view.script.empty())
            throwUsage({"a script says itself what is drawn", "--frames", "either of the two", ""});
        view.frames = parseFrames(frames_.frames);
        view.warmUp = parseWarmUp(frames_.warmUp, *view.frames);
    }

    SharedText text_;
    SceneOptions scene_;
    FramesText frames_;
    ProgressText progress_;
    std::string size_;
    bool offscreen_ = false;
};

}  // namespace

std::unique_ptr<Subcommand> makeViewOptions(CLI::App& parent, CommandLine& line) {
    return std::make_unique<ViewSubcommand>(parent, line);
}

}  // namespace lumi
