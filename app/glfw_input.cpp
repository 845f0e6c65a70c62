#include "app/glfw_input.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

namespace lumi {

namespace {

InputQueue& queueOf(GLFWwindow* window) { return *static_cast<InputQueue*>(glfwGetWindowUserPointer(window)); }

Key keyFrom(int key) {
    if (key >= GLFW_KEY_SPACE && key <= GLFW_KEY_GRAVE_ACCENT) return static_cast<Key>(key);
    if (key >= GLFW_KEY_F1 && key <= GLFW_KEY_F12)
        return static_cast<Key>(static_cast<int>(Key::F1) + key - GLFW_KEY_F1);
    if (key >= GLFW_KEY_ESCAPE && key <= GLFW_KEY_END)  // GLFW's order is ours
        return static_cast<Key>(static_cast<int>(Key::Escape) + key - GLFW_KEY_ESCAPE);
    if (key >= GLFW_KEY_LEFT_SHIFT && key <= GLFW_KEY_RIGHT_SUPER)
        return static_cast<Key>(static_cast<int>(Key::LeftShift) + key - GLFW_KEY_LEFT_SHIFT);
    return key == GLFW_KEY_KP_ENTER ? Key::KeypadEnter : Key::None;
}

/// Characters above 0xFFFF and below alike, as UTF-8.
std::string utf8(unsigned int c) {
    std::string text;
    const auto tail = [&](int shift) { text += static_cast<char>(0x80 | ((c >> shift) & 0x3F)); };
    if (c < 0x80) {
        text += static_cast<char>(c);
    } else if (c < 0x800) {
        text += static_cast<char>(0xC0 | (c >> 6));
        tail(0);
    } else if (c < 0x10000) {
        text += static_cast<char>(0xE0 | (c >> 12));
        tail(6);
        tail(0);
    } else {
        text += static_cast<char>(0xF0 | (c >> 18));
        tail(12);
        tail(6);
        tail(0);
    }
    return text;
}

/// Framebuffer pixels for each of the window's units.
Vec2 pixelRatio(GLFWwindow* window) {
    int width = 1, height = 1, pixelWidth = 1, pixelHeight = 1;
    glfwGetWindowSize(window, &width, &height);
    glfwGetFramebufferSize(window, &pixelWidth, &pixelHeight);
    return {static_cast<float>(pixelWidth) / static_cast<float>(std::max(width, 1)),
            static_cast<float>(pixelHeight) / static_cast<float>(std::max(height, 1))};
}

void onButton(GLFWwindow* window, int button, int action, int) {
    if (button > GLFW_MOUSE_BUTTON_MIDDLE) return;
    queueOf(window).add(MouseButtonChanged{static_cast<MouseButton>(button), action == GLFW_PRESS});
}

void onKey(GLFWwindow* window, int glfwKey, int, int action, int) {
    const Key key = keyFrom(glfwKey);
    if (key != Key::None && action != GLFW_REPEAT) queueOf(window).add(KeyChanged{key, action == GLFW_PRESS});
}

void onDrop(GLFWwindow* window, int count, const char** paths) {
    queueOf(window).add(FilesDropped{{paths, paths + count}});
}

}  // namespace

void connectInput(GLFWwindow* window, InputQueue& queue) {
    static_assert(GLFW_MOUSE_BUTTON_LEFT == static_cast<int>(MouseButton::Left) &&
                  GLFW_MOUSE_BUTTON_RIGHT == static_cast<int>(MouseButton::Right) &&
                  GLFW_MOUSE_BUTTON_MIDDLE == static_cast<int>(MouseButton::Middle));
    static_assert(GLFW_KEY_END - GLFW_KEY_ESCAPE == static_cast<int>(Key::End) - static_cast<int>(Key::Escape));
    glfwSetWindowUserPointer(window, &queue);
    glfwSetCursorPosCallback(
        window, [](GLFWwindow* w, double x, double y) { queueOf(w).add(MouseMoved{Vec2(x, y) * pixelRatio(w)}); });
    glfwSetMouseButtonCallback(window, onButton);
    glfwSetScrollCallback(window, [](GLFWwindow* w, double x, double y) { queueOf(w).add(WheelTurned{Vec2(x, y)}); });
    glfwSetKeyCallback(window, onKey);
    glfwSetCharCallback(window, [](GLFWwindow* w, unsigned int c) { queueOf(w).add(TextTyped{utf8(c)}); });
    glfwSetDropCallback(window, onDrop);
    glfwSetWindowFocusCallback(window, [](GLFWwindow* w, int focused) {
        if (!focused) queueOf(w).add(FocusLost{});
    });
}

}  // namespace lumi
