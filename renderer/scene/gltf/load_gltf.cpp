#include "scene/gltf/load_gltf.h"

#include <algorithm>
#include <map>
#include <unordered_set>

#include "base/error.h"
#include "base/files.h"
#include "base/parallel.h"
#include "scene/gltf/animations.h"
#include "scene/gltf/counts.h"
#include "scene/gltf/materials.h"
#include "scene/gltf/meshes.h"
#include "scene/gltf/nodes.h"
#include "scene/gltf/textures.h"
#include "scene/node_pose.h"

namespace lumi {
namespace {

/// Gives things that share a name a number, so that each can be addressed.
template <class Things, class Name>
void makeNamesUnique(Things& things, const Name& nameOf) {
    std::map<std::string, int> count;
    for (auto& thing : things) {
        std::string& name = nameOf(thing);
        const int number = ++count[name];
        if (number > 1) name += "-" + std::to_string(number);
    }
}

/// The default material stands last; it goes if nothing uses it.
void dropUnusedDefault(Scene& scene) {
    const uint32_t last = static_cast<uint32_t>(scene.materials.size() - 1);
    if (last == 0) return;
    std::unordered_set<const Mesh*> seen;
    for (const Instance& instance : scene.instances) {
        if (!seen.insert(instance.mesh.get()).second) continue;
        const std::vector<uint32_t>& table = instance.mesh->triangleMaterial;
        if (table.empty() ? instance.mesh->material == last
                          : std::find(table.begin(), table.end(), last) != table.end())
            return;
    }
    scene.materials.pop_back();
}

/// Node cameras have no target of their own: they look at, and focus on, the depth of the scene's middle.
void placeCameras(Scene& scene) {
    if (scene.cameras.empty()) return;
    const Bounds3 bounds = scene.restBounds();
    const NodePose pose = poseNodes(scene, 0.0f);
    for (SceneCamera& placed : scene.cameras) {
        Camera& camera = placed.camera;
        placeAtNode(camera, pose.worldFromNode[static_cast<size_t>(placed.node)]);
        const Vec3 forward = glm::normalize(camera.target - camera.eye);
        float distance = bounds.empty() ? 1 : glm::dot(bounds.centre() - camera.eye, forward);
        if (!(distance > 1e-3f)) distance = std::max(1e-3f, bounds.empty() ? 1 : bounds.radius());
        camera.target = camera.eye + forward * distance;
        camera.focus = distance;
    }
}

}  // namespace

Scene loadGltf(const std::filesystem::path& path, MessageLog& log, const LoadOptions& options) {
    const gltf::Document document(path, log, options);
    Scene scene;
    scene.title = path.stem().string();
    scene.path = path.string();
    gltf::NodeTree tree(document, scene);
    gltf::checkCounts(document, tree);

    document.progress(0.1f, "Decoding textures, reading meshes");
    gltf::TextureLibrary library(document);
    gltf::MaterialSet materials = gltf::loadMaterials(document, library);
    std::vector<std::shared_ptr<const Mesh>> meshes;
    parallelInvoke(
        [&] {
            library.load(
                [&](float done) { document.progress(0.1f + 0.8f * done, "Decoding textures, reading meshes"); });
        },
        [&] { meshes = gltf::loadMeshes(document, tree.usedMeshes(), materials); });
    scene.materials = std::move(materials.materials);

    document.progress(0.9f, "Placing objects");
    tree.populate(meshes);
    gltf::loadAnimations(document, tree, scene);
    dropUnusedDefault(scene);
    makeNamesUnique(scene.materials, [](Material& m) -> std::string& { return m.name; });
    makeNamesUnique(scene.lights, [](Light& l) -> std::string& { return l.name; });
    makeNamesUnique(scene.cameras, [](SceneCamera& c) -> std::string& { return c.camera.name; });
    placeCameras(scene);
    const uint64_t parts[2] = {document.contentDigest(), library.digest()};
    scene.contentDigest = digest({reinterpret_cast<const uint8_t*>(parts), sizeof(parts)});
    document.tellOfMore();
    document.progress(1, "Loaded " + path.filename().string());
    return scene;
}

}  // namespace lumi
