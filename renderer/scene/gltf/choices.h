#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace lumi::gltf {

/// What a glTF file leaves to its reader: names, empty for unnamed things.
struct Choices {
    std::vector<std::string> scenes;
    int defaultScene = 0;               ///< what LoadOptions::sceneIndex of -1 shows
    std::vector<std::string> variants;  ///< KHR_materials_variants, what LoadOptions::variant names
};

/// Reads them from the JSON of a .gltf or .glb, nothing else of it. Throws Error(BadInput) for what is no JSON.
Choices readChoices(const std::filesystem::path& path);

}  // namespace lumi::gltf
