#pragma once
#include "ui/input.h"

struct GLFWwindow;

namespace lumi {

/// Sends a window's events to `queue` until the window is destroyed; takes the window's user pointer.
void connectInput(GLFWwindow* window, InputQueue& queue);

}  // namespace lumi
