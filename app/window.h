#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "math/vector.h"
#include "scene/scene_choice.h"

namespace lumi {

/// One document value as typed.
struct TypedValue {
    std::string id, text;
    std::string option;  ///< where it was given, for messages: "--set", "--size"
};

/// What the window and its offscreen twin show when they open.
struct StartOptions {
    std::filesystem::path scene;       ///< a file that exists, as findScene() gives it; empty: an empty window
    SceneChoice choice;                ///< glTF
    std::vector<std::string> modules;  ///< instance of each pane; two open the panes side by side
    /// Parameters in the order given: `--set`, and the options that are parameters (`render.width`, ...).
    std::vector<TypedValue> set;
};

struct WindowOptions {
    StartOptions start;
    Extent2 size{1280, 800};      ///< of the window, in screen coordinates
    std::filesystem::path uiMap;  ///< if not empty: where every item of the UI is, as JSON, rewritten when it changes
    std::filesystem::path captures;  ///< folder for screenshots; empty: the current folder
};

/// Opens the window and returns when the user closes it; the value is the program's exit code.
/// Throws Error(NoDisplay) when there is no window system or no OpenGL 3.3, and what StartCheck throws.
int runWindow(const WindowOptions& options);

}  // namespace lumi
