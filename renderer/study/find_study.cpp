#include <algorithm>

#include "base/error.h"
#include "scene/asset_folder.h"
#include "scene/load.h"
#include "scene/scene_file.h"
#include "study/study_file.h"

namespace lumi {
namespace fs = std::filesystem;
namespace {

bool isFile(const fs::path& path) {
    std::error_code ignored;
    return fs::is_regular_file(path, ignored);
}

/// The folders of the built-in scenes, each once, in order of precedence.
std::vector<fs::path> studyFolders() {
    std::vector<fs::path> folders;
    for (const SceneEntry& scene : listScenes()) {
        const fs::path folder = scene.path.parent_path() / "studies";
        if (std::find(folders.begin(), folders.end(), folder) == folders.end()) folders.push_back(folder);
    }
    return folders;
}

/// What find() gives; what it throws is bad input at `where`.
template <class Find>
fs::path headed(const std::string& where, const Find& find) {
    try {
        return find();
    } catch (const Error& error) {
        ErrorText text = error.text();
        text.what += text.where.empty() ? "" : " (" + text.where + ")";
        text.where = where;
        throw Error(ErrorKind::BadInput, text);
    }
}

}  // namespace

std::vector<StudyListing> listStudies() {
    std::vector<StudyListing> studies;
    for (const fs::path& folder : studyFolders()) {
        std::error_code ignored;
        for (const fs::directory_entry& file : fs::directory_iterator(folder, ignored)) {
            const fs::path& path = file.path();
            const std::string name = path.stem().string();
            const bool known =
                std::any_of(studies.begin(), studies.end(), [&](const auto& s) { return s.name == name; });
            if (known || path.extension() != ".json" || path.stem().extension() == ".schema" || !isFile(path)) continue;
            StudyListing study{name, sceneFileTitle(path), path, {}};
            if (study.title.empty()) study.title = name;
            try {
                study.presets = studyPresets(path);
            } catch (const Error&) {
                // A list shows broken files too; running one says what is wrong with it.
            }
            studies.push_back(std::move(study));
        }
    }
    std::sort(studies.begin(), studies.end(), [](const auto& a, const auto& b) { return a.name < b.name; });
    return studies;
}

fs::path findStudy(const std::string& name) {
    if (isFile(name)) return name;
    const fs::path path(name);
    if (path.has_extension() || path.has_parent_path() || name.empty()) {
        std::error_code ignored;
        const fs::file_status status = fs::status(path, ignored);
        throwBadInput({!fs::exists(status)        ? "no such file"
                       : fs::is_directory(status) ? "is a directory"
                                                  : "is not a regular file",
                       name, "a study file", ""});
    }
    std::vector<std::string> names;
    std::string all;
    for (const StudyListing& study : listStudies()) {
        if (study.name == name) return study.path;
        names.push_back(study.name);
        all += (all.empty() ? "" : ", ") + study.name;
    }
    const std::string near = nearestName(name, names);
    throwUsage({"unknown study \"" + name + '"', "", near.empty() ? "a file or one of " + all : '"' + near + '"', ""});
}

fs::path findStudyScene(const Study& study, const StudyScene& scene) {
    if (isAssetName(scene.source)) return headed(scene.where, [&] { return findAsset(scene.source); });
    fs::path path = study.path.parent_path() / scene.source;
    if (!isFile(path)) path = headed(scene.where, [&] { return findScene(scene.source); });
    if (path.extension() != ".json") return path;
    if (const std::string missing = missingAsset(path); !missing.empty()) throwBadInput({missing, scene.where, "", ""});
    return path;
}

bool definesImage(const std::string& id) {
    static constexpr const char* kPrefixes[] = {"material.", "light.", "environment.", "scene.", "camera.", "view."};
    static constexpr const char* kIds[] = {"time", "path.max-depth", "path.max-diffuse-depth",
                                           "path.max-specular-depth", "path.multiple-scattering"};
    if (id == "camera.jitter") return false;
    return std::any_of(std::begin(kIds), std::end(kIds), [&](const char* known) { return id == known; }) ||
           std::any_of(std::begin(kPrefixes), std::end(kPrefixes), [&](const char* p) { return id.starts_with(p); });
}

}  // namespace lumi
