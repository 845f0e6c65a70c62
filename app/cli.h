#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/compare_command.h"
#include "app/frame_range.h"
#include "app/view.h"

namespace lumi {

/// Options of every command that sets up the machine or what is printed.
struct MachineOptions {
    int threads = 0;          ///< 0: one for each core
    std::string isa;          ///< empty: the best
    std::string memoryLimit;  ///< empty: the default
    bool json = false, quiet = false;
};

/// What is rendered and how, as document values in the order in which they apply.
struct SceneOptions {
    std::string scene;                 ///< name or path as typed; may be empty
    std::vector<std::string> modules;  ///< instances
    /// Parameter id and text: the options that are parameters, then those of --set.
    std::vector<TypedValue> values;
    std::filesystem::path cameraPath;  ///< that the camera follows, for render, reference and info; may be empty
};

struct RenderOptions {
    SceneOptions scene;
    std::filesystem::path replay;
    FrameRange frames;
    int64_t warmUp = 0;
    std::vector<std::string> out;
    std::string buffers;
    bool half = false;
    bool stereo = false;  ///< both eyes, each to files of its own
    Progress progress = Progress::Auto;
};

struct ReferenceCommand {
    SceneOptions scene;
    FrameRange frames;
    double error = 0;  ///< above 0: converge to this instead of to a number of samples
    std::optional<std::pair<uint64_t, uint64_t>> samples;  ///< half-open: only the sums of these
    std::vector<std::string> out;
    std::string buffers;
    bool half = false;
    Progress progress = Progress::Auto;
};

struct MergeCommand {
    std::vector<std::string> parts;
    std::string out;
};

struct StudyCommandOptions {
    std::string file;  ///< a study's name or path
    std::string preset;
    std::filesystem::path out;  ///< empty: `<study>-<preset>` in the current folder
    Progress progress = Progress::Auto;
};

struct ListOptions {
    std::string what;    ///< scenes, modules, buffers, parameters, metrics, studies
    std::string module;  ///< only what belongs to it
};

enum class Command { Window, Render, Reference, Merge, Compare, Study, Bench, Info, List, View, PrintAndExit };

struct CommandLine {
    Command command = Command::Window;
    MachineOptions machine;
    RenderOptions render;                   ///< Render
    ReferenceCommand reference;             ///< Reference
    MergeCommand merge;                     ///< Merge
    CompareOptions compare;                 ///< Compare
    SceneOptions scene;                     ///< Window, Info, View
    bool check = false;                     ///< Info
    std::filesystem::path writeCameraPath;  ///< Info; may be empty
    StudyCommandOptions study;              ///< Study
    std::string filter;                     ///< Bench: regular expression over names
    ListOptions list;                       ///< List
    ViewOptions view;  ///< View: script, out, samples, size; View and Window fill `start` from `scene`
    std::filesystem::path uiMap, captures;  ///< Window
    std::string text;                       ///< PrintAndExit: help or version
};

/// Throws Error(Usage).
CommandLine parseCommandLine(int argc, const char* const* argv);

}  // namespace lumi
