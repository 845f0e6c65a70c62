#include "ui/preferences.h"

#include <cstdlib>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/files.h"
#include "params/json_text.h"

namespace lumi {

namespace {

using nlohmann::json;

json bookmarksJson(const AppState::Bookmarks& bookmarks) {
    json list = json::object();
    for (size_t i = 0; i < bookmarks.size(); ++i)
        if (bookmarks[i]) list[std::to_string(i + 1)] = *bookmarks[i];
    return list;
}

/// Values by id, as text; a file of the first version has a pose alone, as numbers.
CameraBookmark bookmarkFrom(const json& stored) {
    CameraBookmark bookmark;
    for (const auto& [id, value] : stored.items()) {
        if (value.is_string()) bookmark[id] = value.get<std::string>();
        else
            bookmark["camera." + id] =
                formatParameter(Vec3(value.at(0).get<float>(), value.at(1).get<float>(), value.at(2).get<float>()));
    }
    return bookmark;
}

void readInto(AppState& state, const json& root) {
    for (const json& path : root.value("recent", json::array()))
        state.recentScenes.emplace_back(path.get<std::string>());
    state.checkScenes = root.value("check-scenes", true);
    const json byScene = root.value("bookmarks", json::object());
    for (const auto& [scene, list] : byScene.items())
        for (const auto& [number, camera] : list.items()) {
            const auto index = static_cast<size_t>(std::stoi(number) - 1);
            state.bookmarksByScene[scene].at(index) = bookmarkFrom(camera);
        }
}

}  // namespace

std::filesystem::path preferencesPath() {
    if (const char* config = std::getenv("XDG_CONFIG_HOME"); config && *config)
        return std::filesystem::path(config) / "lumiscope" / "window.json";
    if (const char* home = std::getenv("HOME"); home && *home)
        return std::filesystem::path(home) / ".config" / "lumiscope" / "window.json";
    return {};
}

void loadPreferences(AppState& state, const std::filesystem::path& path) {
    std::error_code ignored;
    if (path.empty() || !std::filesystem::exists(path, ignored)) return;
    try {
        readInto(state, json::parse(readTextFile(path)));
    } catch (const std::exception& error) {
        state.log.warning(path.string() + ": preferences cannot be read: " + error.what());
    }
}

void savePreferences(const AppState& state, const std::filesystem::path& path) {
    if (path.empty()) return;
    json recent = json::array(), bookmarks = json::object();
    for (const auto& file : state.recentScenes) recent.push_back(file.string());
    for (const auto& [scene, list] : state.bookmarksByScene)
        if (const json stored = bookmarksJson(list); !stored.empty()) bookmarks[scene] = stored;
    try {
        writeFileAtomically(
            path,
            jsonText(
                json{{"version", 2}, {"recent", recent}, {"bookmarks", bookmarks}, {"check-scenes", state.checkScenes}},
                1));
    } catch (const std::exception& error) {
        state.log.warning(error.what());
    }
}

}  // namespace lumi
