#pragma once
#include "ui/app_state.h"
#include "ui/shortcuts.h"

namespace lumi {

/// Carries out what a key or a button asks for.
void runCommand(AppState& state, UiCommand command, int index = 0);

/// Options that give the present camera on the command line: `--set camera.eye=1,2,3 --set camera.look-at=...`.
std::string cameraAsCommandLine(const Camera& camera);

/// `<folder>/<scene>.window.png`.
std::filesystem::path windowShotPath(const AppState& state);

}  // namespace lumi
