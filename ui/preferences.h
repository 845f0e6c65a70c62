#pragma once
#include <filesystem>

#include "ui/app_state.h"

namespace lumi {

/// `$XDG_CONFIG_HOME/lumiscope/window.json`, or below ~/.config; empty if there is no home.
std::filesystem::path preferencesPath();

/// Recent scenes and camera bookmarks. A file that is missing or damaged leaves the state as it is.
void loadPreferences(AppState& state, const std::filesystem::path& path);
/// Failures are warnings in the log: what a user keeps here is a comfort.
void savePreferences(const AppState& state, const std::filesystem::path& path);

}  // namespace lumi
