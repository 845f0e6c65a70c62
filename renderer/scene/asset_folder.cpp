#include "scene/asset_folder.h"

#include <cstdlib>
#include <optional>
#include <system_error>

#include "base/error.h"
#include "base/files.h"
#include "scene/json_tree.h"
#include "scene/scene_file.h"

namespace lumi {
namespace fs = std::filesystem;
namespace {

constexpr std::string_view kPrefix = "assets:";

fs::path assetFolder() {
    if (const char* variable = std::getenv("LUMISCOPE_ASSETS"); variable && *variable) return variable;
    return fs::path(LUMISCOPE_SOURCE_DIR).parent_path() / "shared" / "assets";
}

/// Calls found(name) for each asset that a JSON value names as a file, in document order.
template <class Found>
void forAssetNames(const JsonValue& value, const Found& found) {
    for (const JsonValue& item : value.items) forAssetNames(item, found);
    for (const JsonMember& member : value.members) {
        const bool namesFile = member.key == "file" || member.key == "gltf" || member.key == "obj";
        if (namesFile && member.value.isString() && isAssetName(member.value.text)) found(member.value.text);
        forAssetNames(member.value, found);
    }
}

std::string withoutPrefix(const std::string& name) { return name.substr(kPrefix.size()); }

/// Where the asset should be. Throws Error(BadInput) if that is not in the folder of assets.
fs::path pathOf(const std::string& name) {
    std::optional<fs::path> path = pathInside(assetFolder(), withoutPrefix(name));
    if (!path)
        throwBadInput({"the file name \"" + name + "\" leads out of the folder of assets", "",
                       "a path under $LUMISCOPE_ASSETS", ""});
    return *std::move(path);
}

ErrorText absence(const std::string& name) {
    return {"no such asset", pathOf(name).lexically_normal().string(),
            "$LUMISCOPE_ASSETS to name a folder that holds " + withoutPrefix(name), ""};
}

std::optional<fs::path> locate(const std::string& name) {
    fs::path file = pathOf(name);
    std::error_code ignored;
    if (fs::is_regular_file(file, ignored)) return file;
    return std::nullopt;
}

}  // namespace

bool isAssetName(const std::string& name) { return name.starts_with(kPrefix); }

fs::path findAsset(const std::string& name) {
    std::optional<fs::path> file = locate(name);
    if (!file) throwBadInput(absence(name));
    return *std::move(file);
}

std::string missingAsset(const fs::path& sceneFile) {
    std::string missing;
    try {
        const JsonTree tree = parseJsonTree(readTextFile(sceneFile, kMaxSceneFileBytes), sceneFile.string());
        forAssetNames(tree.root, [&](const std::string& name) {
            if (missing.empty() && !locate(name)) missing = Error(ErrorKind::BadInput, absence(name)).what();
        });
    } catch (const Error&) {
        // Opening the file says what is wrong with it.
    }
    return missing;
}

}  // namespace lumi
