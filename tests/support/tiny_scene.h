#pragma once
#include <memory>
#include <vector>

#include "scene/scene.h"

namespace lumi::test {

/// A floor lit by a point light and a dim sky, seen by two cameras; named things with awkward names. 16 x 12 pixels.
inline Scene makeTinyScene() {
    Scene scene;
    scene.title = "Tiny";
    scene.path = "tiny.json";
    scene.contentDigest = "0123456789abcdef";
    scene.nodes.resize(2);
    scene.nodes[1].local.translation = {0, 3, 0};
    for (const char* name : {"Floor Paint", "floor.paint", ""}) {
        Material material;
        material.name = name;
        scene.materials.push_back(material);
    }
    Light lamp;
    lamp.name = "Lamp";
    lamp.intensity = Vec3(20);
    lamp.node = 1;
    scene.lights.push_back(lamp);
    scene.environment.constant = Vec3(0.1f);
    auto floor = std::make_shared<Mesh>();
    floor->positions = {{-4, 0, -4}, {-4, 0, 4}, {4, 0, 4}, {4, 0, -4}};
    floor->triangles = {{0, 1, 2}, {0, 2, 3}};
    Instance instance;
    instance.name = "floor";
    instance.mesh = floor;
    instance.node = 0;
    scene.instances.push_back(instance);
    for (const char* name : {"main", "Side View"}) {
        SceneCamera camera;
        camera.camera.name = name;
        camera.camera.eye = scene.cameras.empty() ? Vec3(0, 2, 5) : Vec3(5, 2, 0);
        scene.cameras.push_back(camera);
    }
    scene.render.size = {16, 12};
    return scene;
}

inline std::shared_ptr<const Scene> tinyScene() { return std::make_shared<Scene>(makeTinyScene()); }

/// The same, with the camera moving along keys for two seconds.
inline std::shared_ptr<const Scene> movingScene() {
    auto scene = std::make_shared<Scene>(makeTinyScene());
    scene->cameras[0].keys = {{.time = 0, .eye = {0, 2, 5}, .target = {0, 0, 0}},
                              {.time = 2, .eye = {1, 2, 5}, .target = {0, 0, 0}}};
    return scene;
}

}  // namespace lumi::test
