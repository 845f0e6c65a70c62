#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace lumi::gltf {

/// What a glTF file leaves to its reader: names, empty for unnamed things.
struct Choices {
    std::vector<std::string> scenes;
    int defaultScene = 0;                 ///< what SceneChoice::index of -1 shows
    std::vector<std::string> variants;    ///< KHR_materials_variants, what SceneChoice::variant names
    std::vector<std::string> animations;  ///< what SceneChoice::animation names; the number of one without a name
};

/// Reads them from the JSON of a .gltf or .glb, nothing else of it. Throws Error(BadInput) for what is no JSON.
Choices readChoices(const std::filesystem::path& path);

/// "a, b, c": the first 20 of them, and how many more there are.
std::string listedNames(const std::vector<std::string>& names);

}  // namespace lumi::gltf
