#include "scene/gltf/choices.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/files.h"
#include "scene/gltf/glb.h"
#include "scene/gltf/json_guard.h"
#include "scene/gltf/json_walk.h"

namespace lumi::gltf {
namespace {

using Json = nlohmann::json;

/// The names of an array's objects.
std::vector<std::string> namesIn(const Json& parent, const char* array) {
    std::vector<std::string> names;
    const auto found = parent.is_object() ? parent.find(array) : parent.end();
    if (!parent.is_object() || found == parent.end() || !found->is_array()) return names;
    for (const Json& entry : *found) {
        const bool named = entry.is_object() && entry.contains("name") && entry["name"].is_string();
        names.push_back(named ? entry["name"].get<std::string>() : std::string());
    }
    return names;
}

}  // namespace

Choices readChoices(const std::filesystem::path& path) {
    const std::vector<uint8_t> file = readFile(path);
    const std::string name = path.filename().string();
    const std::string_view json = isBinary(file)
                                      ? jsonChunk(file, name)
                                      : std::string_view(reinterpret_cast<const char*>(file.data()), file.size());
    inspectJson(json, name);
    // Accessors and nodes, most of a file, are dropped as they are read, and what an animation moves.
    const Json tree = Json::parse(json.begin(), json.end(), [](int depth, Json::parse_event_t event, Json& parsed) {
        if (event != Json::parse_event_t::key) return true;
        if (depth == 3) return parsed != "channels" && parsed != "samplers";
        return depth != 1 || parsed == "scene" || parsed == "scenes" || parsed == "extensions" ||
               parsed == "animations";
    });
    Choices choices;
    if (!tree.is_object()) return choices;
    choices.scenes = namesIn(tree, "scenes");
    if (tree.contains("scene"))
        if (const uint64_t scene = wholeNumber(tree["scene"]).value_or(0); scene < choices.scenes.size())
            choices.defaultScene = static_cast<int>(scene);
    choices.animations = namesIn(tree, "animations");
    for (size_t i = 0; i < choices.animations.size(); ++i)
        if (choices.animations[i].empty()) choices.animations[i] = std::to_string(i);
    if (tree.contains("extensions") && tree["extensions"].is_object() &&
        tree["extensions"].contains("KHR_materials_variants"))
        choices.variants = namesIn(tree["extensions"]["KHR_materials_variants"], "variants");
    return choices;
}

std::string listedNames(const std::vector<std::string>& names) {
    constexpr size_t kMost = 20;
    const auto end = names.begin() + static_cast<std::ptrdiff_t>(std::min(names.size(), kMost));
    const std::string text = fmt::format("{}", fmt::join(names.begin(), end, ", "));
    return names.size() > kMost ? fmt::format("{} and {} more", text, names.size() - kMost) : text;
}

}  // namespace lumi::gltf
