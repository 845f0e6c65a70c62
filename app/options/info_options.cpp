#include "app/options/subcommand.h"

#include "app/options/shared_options.h"

namespace lumi {
namespace {

class InfoSubcommand : public Subcommand {
public:
    InfoSubcommand(CLI::App& parent, CommandLine& line)
        : Subcommand(parent, line, "info", "Tell what a scene holds, and every warning") {
        app_->add_option("scene", scene_, "Scene to read: a name or a path")->required()->type_name("SCENE");
        addRepeatable(*app_, "--set", text_.set, "ID=VALUE", "Set any parameter, as scene.index=N; repeatable");
        app_->add_option("--write-camera-path", line_.writeCameraPath,
                         "Write the camera's keys as JSON; a name in .ngp.json is for instant-ngp")
            ->type_name("FILE")
            ->take_last();
        app_->add_option("--camera", text_.camera, "Camera whose keys are written (the first)")
            ->type_name("NAME|INDEX")
            ->take_last();
        app_->add_flag("--check", line_.check,
                       "Trace two small frames and verify every rule that filters rely on; exit 1 if one is broken");
        addMachine(*app_, line_.machine, true);
        app_->footer("Examples:\n  lumiscope info atrium --json\n  lumiscope info model.glb --check");
    }

    void finish() override {
        line_.command = Command::Info;
        line_.scene = {};
        line_.scene.scene = scene_;
        addValues(text_, line_.scene);
    }

private:
    std::string scene_;
    SharedText text_;
};

class ListSubcommand : public Subcommand {
public:
    ListSubcommand(CLI::App& parent, CommandLine& line)
        : Subcommand(parent, line, "list",
                     "List what there is: scenes, modules, buffers, parameters, metrics, studies, benches") {
        app_->add_option("what", line_.list.what, "scenes, modules, buffers, parameters, metrics, studies or benches")
            ->required()
            ->type_name("WHAT")
            ->check(oneOf({"scenes", "modules", "buffers", "parameters", "metrics", "studies", "benches"}));
        app_->add_option("--module", line_.list.module, "Only what belongs to this module")->type_name("INSTANCE");
        addMachine(*app_, line_.machine, false);
        app_->footer("Examples:\n  lumiscope list parameters --module accumulate\n  lumiscope list buffers --json");
    }

    void finish() override { line_.command = Command::List; }
};

}  // namespace

std::unique_ptr<Subcommand> makeInfoOptions(CLI::App& parent, CommandLine& line) {
    return std::make_unique<InfoSubcommand>(parent, line);
}

std::unique_ptr<Subcommand> makeListOptions(CLI::App& parent, CommandLine& line) {
    return std::make_unique<ListSubcommand>(parent, line);
}

}  // namespace lumi
