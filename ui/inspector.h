#pragma once
#include "ui/app_state.h"

namespace lumi {

/// Values of all buffers at the pinned pixel, or at the one under the pointer.
void drawInspector(AppState& state);

}  // namespace lumi
