#pragma once
#include "ui/app_state.h"
#include "ui/shortcuts.h"

namespace lumi {

/// Carries out what a key or a button asks for.
void runCommand(AppState& state, UiCommand command, int index = 0);

/// Options that give the present camera on the command line: `--set camera.eye=1,2,3 --set camera.look-at=...`.
std::string cameraAsCommandLine(const Camera& camera);

/// `<folder>/<scene>.window.png`, a name that is not taken.
std::filesystem::path windowShotPath(const AppState& state);

/// `<folder>/<scene>.<instance>.<buffer>.<frame:04>.<extension>`, a name that is not taken.
std::filesystem::path capturePath(const AppState& state, const std::string& extension);

}  // namespace lumi
