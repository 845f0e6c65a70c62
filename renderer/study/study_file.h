#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "study/study.h"

namespace lumi {

/// Presets of a study file; `quick` and `paper` are those that every shipped study has.
std::vector<std::string> studyPresets(const std::filesystem::path& path);

/// Reads a study with a preset: members of the preset take the place of the study's, objects member by member; an empty
/// name applies none. Every preset is checked, whichever is asked for. Module parameters are checked against the
/// catalogue; those of the document when a scene is there. Throws Error(BadInput) headed by file:line:column,
/// Error(Usage) for a preset that the file does not have.
Study loadStudy(const std::filesystem::path& path, const std::string& preset);
Study parseStudy(const std::string& text, const std::filesystem::path& path, const std::string& preset);

/// The schema of study files (JSON Schema 2020-12), as shipped in scenes/studies/study.schema.json.
std::string studyFileSchema();

/// The studies beside the built-in scenes: name, title, path, by name.
struct StudyListing {
    std::string name, title;
    std::filesystem::path path;
    std::vector<std::string> presets;
};
std::vector<StudyListing> listStudies();

/// A path that exists, or the name of a listed study. Throws Error(Usage) with the nearest name, Error(BadInput) "no
/// such file".
std::filesystem::path findStudy(const std::string& name);

/// Where a scene of a study is: beside the study file, a built-in name, or `assets:` and a path under
/// $LUMISCOPE_ASSETS (by default ../shared/assets beside the source folder). Throws what findScene() throws, headed by
/// the place in the study file.
std::filesystem::path findStudyScene(const Study& study, const StudyScene& scene);

/// Does a document's parameter define what a converged image shows (materials, lights, camera, path depth), or how
/// metrics see it (exposure), so that the reference follows it? All else belongs to the methods that are judged.
bool definesImage(const std::string& id);

}  // namespace lumi
