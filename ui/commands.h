#pragma once
#include "ui/app_state.h"
#include "ui/shortcuts.h"

namespace lumi {

/// Carries out what a key or a button asks for.
void runCommand(AppState& state, UiCommand command, int index = 0);

/// `<folder>/<scene>.window.png`.
std::filesystem::path windowShotPath(const AppState& state);

}  // namespace lumi
