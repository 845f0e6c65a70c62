#pragma once
#include <optional>
#include <span>
#include <string>

#include "ui/keys.h"

namespace lumi {

/// Everything a key or a button can ask for.
enum class UiCommand {
    // Picture
    ShowBuffer,
    PickBuffer,
    NextModule,
    PreviousModule,
    CycleLayout,
    SwapPanes,
    ExposureDown,
    ExposureUp,
    Fit,
    ActualSize,
    Loupe,
    ShowReference,
    MakeReference,
    ToggleErrorMap,
    // Camera
    MoveForward,
    MoveBack,
    MoveLeft,
    MoveRight,
    MoveUp,
    MoveDown,
    ToggleOrbit,
    StoreBookmark,
    RecallBookmark,
    CopyCamera,
    // Time
    PlayTime,
    PauseRendering,
    Step,
    StepBack,
    Restart,
    // Files
    OpenScene,
    ReloadScene,
    SavePicture,
    SaveBuffers,
    SaveWindow,
    // Window
    Undo,
    Redo,
    ResetAll,
    ToggleUi,
    TogglePanel,
    ToggleMessages,
    ToggleSignals,
    CheckSignals,
    Help,
    Close,
    Quit
};

/// One row of the table that both dispatches keys and fills the help overlay.
struct Shortcut {
    UiCommand command;
    KeyChord chord;
    int keys = 1;       ///< so many consecutive keys, counted by the command's index: 1..9
    bool held = false;  ///< acts while it is held (flying), not when it is pressed
    const char* group;
    const char* text;
};
std::span<const Shortcut> shortcuts();

struct DispatchedCommand {
    UiCommand command;
    int index = 0;
};
/// What a key stroke asks for. Movement keys, which are held, are not dispatched.
std::optional<DispatchedCommand> commandFor(const KeyChord& chord);

/// The first key of a command, for tooltips: "F12"; empty if it has none.
std::string shortcutText(UiCommand command);

/// What the mouse does, for the help overlay.
struct Gesture {
    const char* how;
    const char* text;
};
std::span<const Gesture> gestures();

}  // namespace lumi
