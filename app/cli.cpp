#include "app/cli.h"

#include <CLI/CLI.hpp>
#include <algorithm>

#include "app/help_text.h"
#include "app/options/shared_options.h"
#include "app/options/subcommand.h"
#include "base/error.h"

namespace lumi {
namespace {

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

/// The options of the window, and the commands.
class Parser {
public:
    Parser() : app_("Path-traces scenes and reconstructs clean, stable images from few samples.", "lumiscope") {
        app_.set_version_flag("--version", versionText());
        app_.set_help_flag("-h,--help", "Print this help");
        app_.footer(mainFooter);
        app_.require_subcommand(0, 1);
        app_.get_formatter()->column_width(34);
        addWindow();
        for (const auto make : {makeRenderOptions, makeReferenceOptions, makeMergeOptions, makeCompareOptions,
                                makeStudyOptions, makeBenchOptions, makeInfoOptions, makeListOptions, makeViewOptions})
            commands_.push_back(make(app_, line_));
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
        addShared(app_, text_, line_.scene);
        addMachine(app_, line_.machine, true);
        app_.add_option("--captures", line_.captures, "Folder for screenshots (the current one)")->type_name("DIR");
        app_.add_option("--ui-map", line_.uiMap, "Write where every item of the window is to this file, as JSON")
            ->type_name("FILE")
            ->group("Testing");
    }

    CommandLine finished() {
        const auto used = std::find_if(commands_.begin(), commands_.end(), [](const auto& c) { return c->used(); });
        if (used != commands_.end()) (*used)->finish();
        else addValues(text_, line_.scene);
        return line_;
    }

    CLI::App app_;
    CommandLine line_;
    SharedText text_;  ///< of the window
    std::vector<std::unique_ptr<Subcommand>> commands_;
};

}  // namespace

CommandLine parseCommandLine(int argc, const char* const* argv) { return Parser().parse(argc, argv); }

}  // namespace lumi
