#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace lumi {

/// One line of a view script: a word and its arguments. Lines beginning with # and empty lines are left out.
///
///     size 1280 800            of the window's content, pixels        scale 2            HiDPI
///     mouse X Y                move the pointer there                 hover NAME         onto an item of the UI
///     press left|right|middle  release left|right|middle              wheel N            N > 0 away from the user
///     click NAME               double-click NAME                      drag NAME DX DY    press, move, release
///     key CHORD                strike, as "ctrl+z"                    hold KEY, lift KEY
///     text WORDS               type                                   drop PATH          a file onto the window
///     set ID VALUE             a parameter, as --set                  pause N            N frames of the window
///     wait-load                until the scene shows its first frame  wait-frames N      N more frames of the engine
///     wait-spp N               until N samples a pixel                wait-message TEXT  until a message holds it
///     wait-frame N             until frame N is shown                wait-signals       until the signals are checked
///     wait-metrics             until the picture is measured against a reference
///     wait-shown               until the picture shows every change
///     shot NAME                NAME.png                               dump-ui NAME       NAME.json: where items are
///     dump-lineage NAME        NAME.json: which neighbours and which taps of the history made the pinned pixel
struct ScriptLine {
    std::string where;  ///< "script.txt:12"
    std::string command;
    std::vector<std::string> arguments;
    std::string rest;  ///< all after the command, as written
};

/// Throws Error(BadInput) for an unknown command or a wrong number of arguments, naming file and line.
std::vector<ScriptLine> readViewScript(const std::filesystem::path& path);
std::vector<ScriptLine> parseViewScript(const std::string& text, const std::string& name);

}  // namespace lumi
