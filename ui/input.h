#pragma once
#include <deque>
#include <filesystem>
#include <string>
#include <variant>
#include <vector>

#include "math/vector.h"
#include "ui/keys.h"

namespace lumi {

enum class MouseButton { Left, Right, Middle };

struct MouseMoved {
    Vec2 position;  ///< framebuffer pixels, top-left origin
};
struct MouseButtonChanged {
    MouseButton button;
    bool down;
};
struct WheelTurned {
    Vec2 ticks;  ///< y > 0 away from the user
};
struct KeyChanged {
    Key key;
    bool down;
};
struct TextTyped {
    std::string utf8;
};
struct FilesDropped {
    std::vector<std::filesystem::path> paths;
};
struct FocusLost {};
using InputEvent =
    std::variant<MouseMoved, MouseButtonChanged, WheelTurned, KeyChanged, TextTyped, FilesDropped, FocusLost>;

/// What reached the UI in one frame besides the state that ImGui holds.
struct FrameInput {
    std::vector<KeyChord> pressed;  ///< in order; the modifiers as they were then
    std::vector<std::filesystem::path> dropped;
};

/// Events from a window or a script on their way to ImGui. A click or key stroke that begins and ends within one frame
/// is spread over two, so that none is lost however slow the frames are.
class InputQueue {
public:
    void add(InputEvent event) { events_.push_back(std::move(event)); }
    bool empty() const { return events_.empty(); }

    /// Hands as many events to ImGui's IO as fit in one frame. Call before ImGui::NewFrame().
    FrameInput applyFrame();

private:
    std::deque<InputEvent> events_;
};

/// Names ImGui's editing keys; once after a context is made.
void mapImGuiKeys();

}  // namespace lumi
