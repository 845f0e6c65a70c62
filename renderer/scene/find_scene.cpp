#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <system_error>

#include "base/error.h"
#include "scene/asset_folder.h"
#include "scene/load.h"
#include "scene/scene_file.h"

namespace lumi {
namespace fs = std::filesystem;
namespace {

/// The scenes that a newcomer sees first, in the README's order; others follow by name.
constexpr std::array kFirstScenes{"cornell", "room", "atrium", "still-life", "parade"};

fs::path programFolder() {
    std::array<char, 4096> link{};
    const ssize_t length = ::readlink("/proc/self/exe", link.data(), link.size());
    return length > 0 ? fs::path(std::string(link.data(), static_cast<size_t>(length))).parent_path() : fs::path();
}

/// Folders that may hold scenes, in order of precedence.
std::vector<fs::path> sceneFolders() {
    std::vector<fs::path> folders;
    if (const char* variable = std::getenv("LUMISCOPE_SCENES")) {
        const std::string list = variable;
        for (size_t begin = 0; begin <= list.size();) {
            const size_t end = std::min(list.find(':', begin), list.size());
            if (end > begin) folders.emplace_back(list.substr(begin, end - begin));
            begin = end + 1;
        }
    }
    const fs::path program = programFolder();
    if (!program.empty()) {
        folders.push_back(program / "scenes");
        folders.push_back(program.parent_path() / "scenes");
    }
    folders.push_back(fs::path(LUMISCOPE_SOURCE_DIR) / "scenes");
    return folders;
}

bool isFile(const fs::path& path) {
    std::error_code ignored;
    return fs::is_regular_file(path, ignored);
}

bool isSceneFile(const fs::path& path) {
    return path.extension() == ".json" && path.stem().extension() != ".schema" && isFile(path);
}

}  // namespace

std::vector<SceneEntry> listScenes() {
    std::vector<SceneEntry> entries;
    for (const fs::path& folder : sceneFolders()) {
        std::error_code ignored;
        for (const fs::directory_entry& file : fs::directory_iterator(folder, ignored)) {
            const std::string name = file.path().stem().string();
            const bool known =
                std::any_of(entries.begin(), entries.end(), [&](const auto& e) { return e.name == name; });
            if (!known && isSceneFile(file.path())) entries.push_back({name, "", file.path(), ""});
        }
    }
    const auto rank = [](const SceneEntry& entry) {
        return std::find(kFirstScenes.begin(), kFirstScenes.end(), entry.name) - kFirstScenes.begin();
    };
    std::sort(entries.begin(), entries.end(), [&](const SceneEntry& a, const SceneEntry& b) {
        return rank(a) != rank(b) ? rank(a) < rank(b) : a.name < b.name;
    });
    for (SceneEntry& entry : entries) {
        entry.title = sceneFileTitle(entry.path);
        if (entry.title.empty()) entry.title = entry.name;
        entry.missing = missingAsset(entry.path);
    }
    return entries;
}

fs::path findScene(const std::string& name) {
    if (isFile(name)) return name;
    const fs::path path(name);
    const bool isBareName = !path.has_extension() && !path.has_parent_path() && !name.empty();
    if (!isBareName) {
        std::error_code ignored;
        const fs::file_status status = fs::status(path, ignored);
        if (!fs::exists(status)) throwBadInput({"no such file", name, "", ""});
        throwBadInput(
            {fs::is_directory(status) ? "is a directory" : "is not a regular file", name, "a scene file", ""});
    }
    for (const fs::path& folder : sceneFolders())
        if (const fs::path candidate = folder / (name + ".json"); isSceneFile(candidate)) return candidate;

    std::vector<std::string> names;
    for (const SceneEntry& entry : listScenes()) names.push_back(entry.name);
    const std::string near = nearestName(name, names);
    std::string all;
    for (const std::string& known : names) all += (all.empty() ? "" : ", ") + known;
    throwUsage({"unknown scene \"" + name + '"', "", near.empty() ? "a file or one of " + all : '"' + near + '"', ""});
}

}  // namespace lumi
