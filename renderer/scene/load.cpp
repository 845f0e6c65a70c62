#include "scene/load.h"

#include <utility>

#include "base/error.h"
#include "base/files.h"
#include "image/hdr.h"
#include "scene/defaults.h"
#include "scene/gltf/load_gltf.h"
#include "scene/light_body.h"
#include "scene/obj/load_obj.h"
#include "scene/posed_scene.h"
#include "scene/reach.h"
#include "scene/scene_file.h"

namespace lumi {
namespace fs = std::filesystem;
namespace {

/// What an environment map is shown on: a rough, a glossy and a mirroring ball.
constexpr const char* kMaterialBalls = R"({
  "version": 1,
  "assets": {
    "ball": {"sphere": {"radius": 0.5}},
    "plate": {"cylinder": {"radius": 2.2, "height": 0.08, "segments": 256}}
  },
  "materials": {
    "matte": {"base-color": [0.5, 0.5, 0.5], "roughness": 1, "specular": 0},
    "lacquer": {"base-color": [0.55, 0.06, 0.04], "roughness": 0.15},
    "mirror": {"base-color": [0.95, 0.95, 0.95], "metallic": 1, "roughness": 0.02},
    "plate": {"base-color": [0.32, 0.32, 0.32], "roughness": 0.6}
  },
  "instances": [
    {"name": "matte ball", "asset": "ball", "material": "matte", "translate": [-1.15, 0.5, 0]},
    {"name": "lacquer ball", "asset": "ball", "material": "lacquer", "translate": [0, 0.5, 0.25]},
    {"name": "mirror ball", "asset": "ball", "material": "mirror", "translate": [1.15, 0.5, 0]},
    {"name": "plate", "asset": "plate", "material": "plate", "translate": [0, -0.04, 0]}
  ],
  "cameras": {"main": {"eye": [0, 1.35, 4.6], "look-at": [0, 0.42, 0], "fov-y-deg": 35}}
})";

Scene loadUnderSky(const fs::path& path, MessageLog& log, const LoadOptions& options) {
    const std::vector<uint8_t> bytes = readFile(path);
    Scene scene = parseSceneFile(kMaterialBalls, path.string(), path.parent_path(), log, options);
    scene.environment.image = std::make_shared<const Image>(loadImage(path));
    scene.environment.file = path.string();
    scene.title = "Material balls under " + path.filename().string();
    scene.contentDigest = digest(bytes);
    return scene;
}

/// Only glTF files have several scenes, variants of materials and animations.
void refuseChoices(const fs::path& path, const LoadOptions& options) {
    const auto refuse = [&](const char* what, const std::string& id, const std::string& wanted) {
        throwUsage({what, path.filename().string(), id + " for a .gltf or .glb", wanted});
    };
    const SceneChoice& choice = options.choice;
    if (choice.index >= 0) refuse("holds one scene alone", "scene.index", std::to_string(choice.index));
    if (!choice.variant.empty()) refuse("has no material variants to choose from", "scene.variant", choice.variant);
    if (!choice.animation.empty()) refuse("has no animations to choose from", "scene.animation", choice.animation);
}

}  // namespace

std::shared_ptr<const Scene> loadScene(const fs::path& path, MessageLog& log, const LoadOptions& options) {
    const std::string extension = lowerExtension(path);
    const bool ours = extension == ".json";
    const bool gltf = extension == ".gltf" || extension == ".glb";
    if (!gltf) refuseChoices(path, options);
    if (options.progress) options.progress(0, "reading " + path.filename().string());
    auto scene = std::make_shared<Scene>();
    try {
        if (ours) *scene = loadSceneFile(path, log, options);
        else if (gltf) *scene = loadGltf(path, log, options);
        else if (extension == ".obj") *scene = loadObj(path, log, options);
        else if (extension == ".hdr" || extension == ".exr") *scene = loadUnderSky(path, log, options);
        else if (!fs::exists(path)) throwBadInput({"no such file", path.string(), "", ""});
        else
            throwBadInput({fs::is_directory(path) ? "is a directory" : "unknown kind of scene", path.string(),
                           ".json, .gltf, .glb, .obj, .hdr or .exr", extension});
    } catch (const std::bad_alloc&) {
        throw Error(ErrorKind::Resources, {"not enough memory to load the scene", path.string(), "", ""});
    }
    if (scene->path.empty()) scene->path = path.string();
    addLightBodies(*scene);
    // What cannot be posed is not taken over.
    warnOfStretchedLights(*poseScene(scene, {}, nullptr, options.stop), log);
    warnOfDistance(*scene, log);
    addDefaults(*scene, log, !ours, options.stop);
    if (options.progress) options.progress(1, "done");
    return scene;
}

}  // namespace lumi
