#include "ui/input.h"

#include <imgui.h>

#include <array>
#include <set>

namespace lumi {

namespace {

bool& keyDown(Key key) { return ImGui::GetIO().KeysDown[static_cast<int>(key)]; }

void updateModifiers() {
    ImGuiIO& io = ImGui::GetIO();
    io.KeyCtrl = keyDown(Key::LeftControl) || keyDown(Key::RightControl);
    io.KeyShift = keyDown(Key::LeftShift) || keyDown(Key::RightShift);
    io.KeyAlt = keyDown(Key::LeftAlt) || keyDown(Key::RightAlt);
    io.KeySuper = keyDown(Key::LeftSuper) || keyDown(Key::RightSuper);
}

bool isModifier(Key key) { return key >= Key::LeftShift && key <= Key::RightSuper; }

/// Applies events; false if one must wait for the next frame.
class Applier {
public:
    explicit Applier(FrameInput& frame) : frame_(frame) {}

    bool operator()(const MouseMoved& event) {
        if (!buttons_.empty()) return false;  // a click belongs to the place where it was made
        ImGui::GetIO().MousePos = ImVec2(event.position.x, event.position.y);
        return true;
    }
    bool operator()(const MouseButtonChanged& event) {
        const int index = static_cast<int>(event.button);
        if (!buttons_.insert(index).second) return false;
        ImGui::GetIO().MouseDown[index] = event.down;
        return true;
    }
    bool operator()(const WheelTurned& event) {
        ImGui::GetIO().MouseWheel += event.ticks.y;
        ImGui::GetIO().MouseWheelH += event.ticks.x;
        return true;
    }
    bool operator()(const KeyChanged& event) {
        if (!keys_.insert(event.key).second) return false;
        keyDown(event.key) = event.down;
        updateModifiers();
        const ImGuiIO& io = ImGui::GetIO();
        if (event.down && !isModifier(event.key))
            frame_.pressed.push_back({event.key, io.KeyCtrl, io.KeyShift, io.KeyAlt});
        return true;
    }
    bool operator()(const TextTyped& event) {
        ImGui::GetIO().AddInputCharactersUTF8(event.utf8.c_str());
        return true;
    }
    bool operator()(const FilesDropped& event) {
        frame_.dropped.insert(frame_.dropped.end(), event.paths.begin(), event.paths.end());
        return true;
    }
    bool operator()(const FocusLost&) {
        ImGuiIO& io = ImGui::GetIO();
        std::fill(std::begin(io.KeysDown), std::end(io.KeysDown), false);
        std::fill(std::begin(io.MouseDown), std::end(io.MouseDown), false);
        updateModifiers();
        return true;
    }

private:
    FrameInput& frame_;
    std::set<int> buttons_;
    std::set<Key> keys_;
};

}  // namespace

FrameInput InputQueue::applyFrame() {
    FrameInput frame;
    Applier applier(frame);
    while (!events_.empty() && std::visit(applier, events_.front())) events_.pop_front();
    return frame;
}

void mapImGuiKeys() {
    struct Pair {
        ImGuiKey imgui;
        Key key;
    };
    constexpr std::array kPairs{
        Pair{ImGuiKey_Tab, Key::Tab},
        Pair{ImGuiKey_LeftArrow, Key::Left},
        Pair{ImGuiKey_RightArrow, Key::Right},
        Pair{ImGuiKey_UpArrow, Key::Up},
        Pair{ImGuiKey_DownArrow, Key::Down},
        Pair{ImGuiKey_PageUp, Key::PageUp},
        Pair{ImGuiKey_PageDown, Key::PageDown},
        Pair{ImGuiKey_Home, Key::Home},
        Pair{ImGuiKey_End, Key::End},
        Pair{ImGuiKey_Insert, Key::Insert},
        Pair{ImGuiKey_Delete, Key::Delete},
        Pair{ImGuiKey_Backspace, Key::Backspace},
        Pair{ImGuiKey_Space, Key::Space},
        Pair{ImGuiKey_Enter, Key::Enter},
        Pair{ImGuiKey_Escape, Key::Escape},
        Pair{ImGuiKey_KeyPadEnter, Key::KeypadEnter},
        Pair{ImGuiKey_A, Key::A},
        Pair{ImGuiKey_C, Key::C},
        Pair{ImGuiKey_V, Key::V},
        Pair{ImGuiKey_X, Key::X},
        Pair{ImGuiKey_Y, Key::Y},
        Pair{ImGuiKey_Z, Key::Z},
    };
    for (const Pair& pair : kPairs) ImGui::GetIO().KeyMap[pair.imgui] = static_cast<int>(pair.key);
}

}  // namespace lumi
