#include "app/options/subcommand.h"

#include "app/help_text.h"
#include "app/options/shared_options.h"
#include "base/error.h"

namespace lumi {
namespace {

class RenderSubcommand : public Subcommand {
public:
    RenderSubcommand(CLI::App& parent, CommandLine& line)
        : Subcommand(parent, line, "render", "Render frames through one module, without a window") {
        RenderOptions& render = line_.render;
        app_->add_option("scene", render.scene.scene, "Scene to render: a name or a path")->type_name("SCENE");
        app_->add_option("--replay", render.replay,
                         "Make the image of a .exr, .png or .json again from the state inside")
            ->type_name("FILE");
        addShared(*app_, text_, render.scene);
        frames_.add(*app_);
        addCameraPath(*app_, render.scene);
        addRepeatable(*app_, "--out", render.out, "PATH",
                      "File to write: .exr, .png or .mp4, %04d is the frame number; repeatable "
                      "(<scene>.<module>.exr, a free name)");
        app_->add_option("--buffers", render.buffers,
                         "Layers to add to .exr files, as `list buffers` names them, or all")
            ->type_name("NAME,...");
        app_->add_flag("--stereo", render.stereo,
                       "Render both eyes of the camera's pair: NAME.left.EXT and NAME.right.EXT; camera.interaxial is "
                       "their distance");
        app_->add_flag("--half", render.half, "Store colours of .exr files as half");
        progress_.add(*app_);
        addMachine(*app_, line_.machine, true);
        app_->footer(renderFooter);
    }

    void finish() override {
        line_.command = Command::Render;
        RenderOptions& render = line_.render;
        addValues(text_, render.scene);
        if (render.scene.modules.size() > 1) throwUsage({"render runs one module", "--module", "one instance", ""});
        if (!frames_.frames.empty()) render.frames = parseFrames(frames_.frames);
        render.warmUp = parseWarmUp(frames_.warmUp, render.frames);
        checkTime(render);
        checkStereo(render);
        render.progress = progress_.progress();
        if (render.scene.scene.empty() && render.replay.empty())
            throwUsage({"render needs a scene", "", "lumiscope render SCENE, or --replay FILE", ""});
        if (!render.replay.empty() &&
            (!render.scene.values.empty() || !frames_.frames.empty() || !frames_.warmUp.empty() ||
             !render.scene.cameraPath.empty() || !render.buffers.empty() || render.half || render.stereo))
            throwUsage({"everything about the image comes from the file", "--replay",
                        "only SCENE (where it is now), --out and options of the machine beside it", ""});
    }

private:
    /// The frames' numbers give the time.
    static void checkTime(const RenderOptions& render) {
        if (render.frames.end <= 1) return;
        for (const TypedValue& value : render.scene.values)
            if (value.id == "time")
                throwUsage({"the number of a frame gives its time", value.option, "time only without --frames", ""});
    }

    /// Both eyes, or one.
    static void checkStereo(const RenderOptions& render) {
        for (const TypedValue& value : render.scene.values)
            if (render.stereo && value.id == "camera.stereo")
                throwUsage({"both eyes are rendered", value.option, "camera.stereo only without --stereo", ""});
    }

    SharedText text_;
    FramesText frames_;
    ProgressText progress_;
};

}  // namespace

std::unique_ptr<Subcommand> makeRenderOptions(CLI::App& parent, CommandLine& line) {
    return std::make_unique<RenderSubcommand>(parent, line);
}

}  // namespace lumi
