#include "ui/shortcuts.h"

#include <array>

namespace lumi {

namespace {

constexpr KeyChord plain(Key key) { return {key}; }
constexpr KeyChord control(Key key) { return {key, true}; }
constexpr KeyChord shift(Key key) { return {key, false, true}; }
constexpr KeyChord alt(Key key) { return {key, false, false, true}; }

constexpr auto kPicture = "Picture", kCamera = "Camera", kTime = "Time and rendering", kFiles = "Files",
               kWindow = "Window";

constexpr std::array kShortcuts{
    Shortcut{UiCommand::ShowBuffer, plain(Key::Digit1), 9, false, kPicture, "Show buffer 1 to 9 of the list"},
    Shortcut{UiCommand::PickBuffer, plain(Key::B), 1, false, kPicture, "Choose a buffer by name"},
    Shortcut{UiCommand::NextModule, plain(Key::PageDown), 1, false, kPicture, "Next module"},
    Shortcut{UiCommand::PreviousModule, plain(Key::PageUp), 1, false, kPicture, "Previous module"},
    Shortcut{UiCommand::CycleLayout, plain(Key::V), 1, false, kPicture, "One view, side by side, wipe"},
    Shortcut{UiCommand::SwapPanes, plain(Key::X), 1, false, kPicture, "Swap the two views"},
    Shortcut{UiCommand::ExposureDown, plain(Key::LeftBracket), 1, false, kPicture, "Darker by a quarter stop"},
    Shortcut{UiCommand::ExposureUp, plain(Key::RightBracket), 1, false, kPicture, "Brighter by a quarter stop"},
    Shortcut{UiCommand::Fit, plain(Key::F), 1, false, kPicture, "Fit the picture"},
    Shortcut{UiCommand::ActualSize, shift(Key::F), 1, false, kPicture, "One pixel for each pixel"},
    Shortcut{UiCommand::Loupe, plain(Key::Z), 1, false, kPicture, "Loupe under the pointer"},
    Shortcut{UiCommand::ShowReference, plain(Key::G), 1, false, kPicture, "The reference in the picture's place"},
    Shortcut{UiCommand::MakeReference, shift(Key::G), 1, false, kPicture, "Make a reference of what is shown"},
    Shortcut{UiCommand::ToggleErrorMap, plain(Key::M), 1, false, kPicture, "Error map against the reference"},

    Shortcut{UiCommand::MoveForward, plain(Key::W), 1, true, kCamera, "forward"},
    Shortcut{UiCommand::MoveLeft, plain(Key::A), 1, true, kCamera, "left"},
    Shortcut{UiCommand::MoveBack, plain(Key::S), 1, true, kCamera, "back"},
    Shortcut{UiCommand::MoveRight, plain(Key::D), 1, true, kCamera, "right"},
    Shortcut{UiCommand::MoveDown, plain(Key::Q), 1, true, kCamera, "down"},
    Shortcut{UiCommand::MoveUp, plain(Key::E), 1, true, kCamera, "up"},
    Shortcut{UiCommand::ToggleOrbit, plain(Key::O), 1, false, kCamera, "Left drag orbits, or moves the picture"},
    Shortcut{UiCommand::StoreBookmark, control(Key::Digit1), 9, false, kCamera, "Store the camera as a bookmark"},
    Shortcut{UiCommand::RecallBookmark, alt(Key::Digit1), 9, false, kCamera, "Go to a bookmark"},
    Shortcut{UiCommand::CopyCamera, plain(Key::C), 1, false, kCamera, "Copy the camera as command line"},

    Shortcut{UiCommand::PlayTime, plain(Key::Space), 1, false, kTime, "Play or pause time"},
    Shortcut{UiCommand::PauseRendering, control(Key::Space), 1, false, kTime, "Pause or resume rendering"},
    Shortcut{UiCommand::Step, plain(Key::Period), 1, false, kTime, "One frame forward (of time too, if it was played)"},
    Shortcut{UiCommand::StepBack, plain(Key::Comma), 1, false, kTime, "One frame back"},
    Shortcut{UiCommand::Restart, plain(Key::R), 1, false, kTime, "Restart at frame 0"},

    Shortcut{UiCommand::OpenScene, control(Key::O), 1, false, kFiles, "Open a scene"},
    Shortcut{UiCommand::ReloadScene, plain(Key::F5), 1, false, kFiles, "Load the scene again"},
    Shortcut{UiCommand::SavePicture, plain(Key::F12), 1, false, kFiles, "Save the view as PNG"},
    Shortcut{UiCommand::SaveBuffers, control(Key::F12), 1, false, kFiles, "Save all buffers as EXR"},
    Shortcut{UiCommand::SaveWindow, alt(Key::F12), 1, false, kFiles, "Save the whole window as PNG"},

    Shortcut{UiCommand::Undo, control(Key::Z), 1, false, kWindow, "Undo"},
    Shortcut{UiCommand::Redo, {Key::Z, true, true}, 1, false, kWindow, "Redo"},
    Shortcut{UiCommand::ResetAll, shift(Key::F5), 1, false, kWindow, "Reset all parameters"},
    Shortcut{UiCommand::ToggleUi, plain(Key::Tab), 1, false, kWindow, "Hide or show everything but the picture"},
    Shortcut{UiCommand::TogglePanel, plain(Key::N), 1, false, kWindow, "Hide or show the side panel"},
    Shortcut{UiCommand::ToggleMessages, control(Key::M), 1, false, kWindow, "Messages"},
    Shortcut{UiCommand::ToggleSignals, plain(Key::K), 1, false, kWindow, "Do the signals keep their contract?"},
    Shortcut{UiCommand::Help, plain(Key::F1), 1, false, kWindow, "This page"},
    Shortcut{UiCommand::Help, shift(Key::Slash), 1, false, kWindow, "This page"},
    Shortcut{UiCommand::Close, plain(Key::Escape), 1, false, kWindow, "Close what is open, stop a load, else quit"},
    Shortcut{UiCommand::Quit, control(Key::Q), 1, false, kWindow, "Quit"},
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

std::span<const Shortcut> shortcuts() { return kShortcuts; }
std::span<const Gesture> gestures() { return kGestures; }

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

std::string shortcutText(UiCommand command) {
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
