#include "ui/shortcuts.h"

#include <array>

namespace lumi {

namespace {

constexpr KeyChord plain(Key key) {
    return {key};
}
constexpr KeyChord control(Key key) {
    return {key, true};
}
constexpr KeyChord shift(Key key) {
    return {key, false, true};
}
constexpr KeyChord alt(Key key) {
    return {key, false, false, true};
}

constexpr auto kPicture = "Picture", kCamera = "Camera", kTime = "Time and rendering", kFiles = "Files",
               kWindow = "Window";

constexpr std::array kShortcuts{
    Shortcut{Command::ShowBuffer, plain(Key::Digit1), 9, false, kPicture, "Show buffer 1 to 9 of the list"},
    Shortcut{Command::PickBuffer, plain(Key::B), 1, false, kPicture, "Choose a buffer by name"},
    Shortcut{Command::NextModule, plain(Key::PageDown), 1, false, kPicture, "Next module"},
    Shortcut{Command::PreviousModule, plain(Key::PageUp), 1, false, kPicture, "Previous module"},
    Shortcut{Command::CycleLayout, plain(Key::V), 1, false, kPicture, "One view, side by side, wipe"},
    Shortcut{Command::SwapPanes, plain(Key::X), 1, false, kPicture, "Swap the two views"},
    Shortcut{Command::ExposureDown, plain(Key::LeftBracket), 1, false, kPicture, "Darker by a quarter stop"},
    Shortcut{Command::ExposureUp, plain(Key::RightBracket), 1, false, kPicture, "Brighter by a quarter stop"},
    Shortcut{Command::Fit, plain(Key::F), 1, false, kPicture, "Fit the picture"},
    Shortcut{Command::ActualSize, shift(Key::F), 1, false, kPicture, "One pixel for each pixel"},
    Shortcut{Command::Loupe, plain(Key::Z), 1, false, kPicture, "Loupe under the pointer"},

    Shortcut{Command::MoveForward, plain(Key::W), 1, true, kCamera, "Forward"},
    Shortcut{Command::MoveLeft, plain(Key::A), 1, true, kCamera, "Left"},
    Shortcut{Command::MoveBack, plain(Key::S), 1, true, kCamera, "Back"},
    Shortcut{Command::MoveRight, plain(Key::D), 1, true, kCamera, "Right"},
    Shortcut{Command::MoveDown, plain(Key::Q), 1, true, kCamera, "Down"},
    Shortcut{Command::MoveUp, plain(Key::E), 1, true, kCamera, "Up"},
    Shortcut{Command::ToggleOrbit, plain(Key::O), 1, false, kCamera, "Left drag orbits, or moves the picture"},
    Shortcut{Command::StoreBookmark, control(Key::Digit1), 9, false, kCamera, "Store the camera as a bookmark"},
    Shortcut{Command::RecallBookmark, alt(Key::Digit1), 9, false, kCamera, "Go to a bookmark"},
    Shortcut{Command::CopyCamera, plain(Key::C), 1, false, kCamera, "Copy the camera as command line"},

    Shortcut{Command::PlayTime, plain(Key::Space), 1, false, kTime, "Play or pause time"},
    Shortcut{Command::PauseRendering, control(Key::Space), 1, false, kTime, "Pause or resume rendering"},
    Shortcut{Command::Step, plain(Key::Period), 1, false, kTime, "One frame forward"},
    Shortcut{Command::StepBack, plain(Key::Comma), 1, false, kTime, "One frame back"},
    Shortcut{Command::Restart, plain(Key::R), 1, false, kTime, "Restart at frame 0"},

    Shortcut{Command::OpenScene, control(Key::O), 1, false, kFiles, "Open a scene"},
    Shortcut{Command::ReloadScene, plain(Key::F5), 1, false, kFiles, "Load the scene again"},
    Shortcut{Command::SavePicture, plain(Key::F12), 1, false, kFiles, "Save the view as PNG"},
    Shortcut{Command::SaveBuffers, control(Key::F12), 1, false, kFiles, "Save all buffers as EXR"},
    Shortcut{Command::SaveWindow, alt(Key::F12), 1, false, kFiles, "Save the whole window as PNG"},

    Shortcut{Command::Undo, control(Key::Z), 1, false, kWindow, "Undo"},
    Shortcut{Command::Redo, {Key::Z, true, true}, 1, false, kWindow, "Redo"},
    Shortcut{Command::ResetAll, shift(Key::F5), 1, false, kWindow, "Reset all parameters"},
    Shortcut{Command::ToggleUi, plain(Key::Tab), 1, false, kWindow, "Hide or show everything but the picture"},
    Shortcut{Command::TogglePanel, plain(Key::N), 1, false, kWindow, "Hide or show the side panel"},
    Shortcut{Command::ToggleMessages, control(Key::M), 1, false, kWindow, "Messages"},
    Shortcut{Command::Help, plain(Key::F1), 1, false, kWindow, "This page"},
    Shortcut{Command::Help, shift(Key::Slash), 1, false, kWindow, "This page"},
    Shortcut{Command::Close, plain(Key::Escape), 1, false, kWindow, "Close what is open, else quit"},
    Shortcut{Command::Quit, control(Key::Q), 1, false, kWindow, "Quit"},
};

constexpr std::array kGestures{
    Gesture{"Left drag", "Orbit (or move the picture, key O)"},
    Gesture{"Shift + left drag", "Move the camera sideways"},
    Gesture{"Right drag", "Look around; fly with W A S D Q E"},
    Gesture{"Right + wheel", "Flying speed"},
    Gesture{"Shift, Ctrl", "Fly ten times faster, four times slower"},
    Gesture{"Wheel", "Zoom the picture at the pointer"},
    Gesture{"Middle drag", "Move the picture"},
    Gesture{"Click", "Pin a pixel for the inspector"},
    Gesture{"Double click", "Orbit around that point"},
};

}  // namespace

std::span<const Shortcut> shortcuts() {
    return kShortcuts;
}
std::span<const Gesture> gestures() {
    return kGestures;
}

std::optional<DispatchedCommand> commandFor(const KeyChord& chord) {
    for (const Shortcut& row : kShortcuts) {
        if (row.held || row.chord.control != chord.control || row.chord.shift != chord.shift ||
            row.chord.alt != chord.alt)
            continue;
        const int index = static_cast<int>(chord.key) - static_cast<int>(row.chord.key);
        if (index >= 0 && index < row.keys) return DispatchedCommand{row.command, index};
    }
    return std::nullopt;
}

std::string shortcutText(Command command) {
    for (const Shortcut& row : kShortcuts) {
        if (row.command != command) continue;
        std::string text = formatChord(row.chord);
        if (row.keys > 1) {
            KeyChord last = row.chord;
            last.key = static_cast<Key>(static_cast<int>(last.key) + row.keys - 1);
            last.control = last.shift = last.alt = false;
            text += " … " + formatChord(last);
        }
        return text;
    }
    return {};
}

}  // namespace lumi
