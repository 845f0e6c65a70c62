#include "scene/scene.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <span>

#include "scene/material_textures.h"
#include "scene/node_pose.h"
#include "scene/pose_bounds.h"

namespace lumi {
namespace {

void addTexture(const Texture& texture, std::set<const TextureImage*>& images) {
    if (texture) images.insert(texture.image.get());
}

/// Of keys in order of time those that the place at `time` depends on: two before it and two after it.
std::span<const SceneCamera::Key> keysAround(std::span<const SceneCamera::Key> keys, float time) {
    const auto later = std::upper_bound(keys.begin(), keys.end(), time,
                                        [](float t, const SceneCamera::Key& key) { return t < key.time; });
    const auto at = static_cast<size_t>(later - keys.begin()), first = at > 2 ? at - 2 : 0;
    return keys.subspan(first, std::min(at + 2, keys.size()) - first);
}

/// Keys as animation channels, so that every curve in a scene is evaluated by one function.
float keyed(std::span<const SceneCamera::Key> keys, Interpolation interpolation, float time,
            float (*read)(const SceneCamera::Key&)) {
    AnimationChannel channel;
    channel.components = 1;
    channel.interpolation = interpolation == Interpolation::CubicSpline ? Interpolation::CatmullRom : interpolation;
    for (const SceneCamera::Key& key : keys) {
        channel.times.push_back(key.time);
        channel.values.push_back(read(key));
    }
    float value = 0;
    channel.evaluate(time, &value);
    return value;
}

void placeByKeys(Camera& camera, const SceneCamera& source, float time) {
    using Key = SceneCamera::Key;
    const std::span<const Key> keys = keysAround(source.keys, time);
    const auto at = [&](float (*read)(const Key&)) { return keyed(keys, source.interpolation, time, read); };
    camera.eye = {at([](const Key& k) { return k.eye.x; }), at([](const Key& k) { return k.eye.y; }),
                  at([](const Key& k) { return k.eye.z; })};
    camera.target = {at([](const Key& k) { return k.target.x; }), at([](const Key& k) { return k.target.y; }),
                     at([](const Key& k) { return k.target.z; })};
    camera.fovYDeg = std::clamp(at([](const Key& k) { return k.fovYDeg; }), 1.0f, 170.0f);
    camera.focus = std::max(at([](const Key& k) { return k.focus; }), 1e-3f);
}

}  // namespace

bool Scene::isAnimated() const { return duration() > 0; }

float Scene::duration() const {
    float longest = 0;
    for (const Animation& animation : animations) longest = std::max(longest, animation.duration);
    for (const SceneCamera& camera : cameras)
        if (camera.keys.size() > 1) longest = std::max(longest, camera.keys.back().time);
    return longest;
}

Bounds3 Scene::restBounds() const {
    Bounds3 bounds;
    MeshBounds meshBounds;
    eachBounds(*this, poseNodes(*this, {}), meshBounds, [&](const Bounds3& box) { bounds.extend(box); });
    return bounds;
}

int64_t Scene::triangleCount() const {
    int64_t count = 0;
    for (const Instance& instance : instances) count += static_cast<int64_t>(instance.mesh->triangles.size());
    return count;
}

size_t Scene::byteCount() const {
    std::set<const Mesh*> meshes;
    std::set<const TextureImage*> images;
    for (const Instance& instance : instances) meshes.insert(instance.mesh.get());
    for (const Material& m : materials)
        for (const auto texture : kMaterialTextures) addTexture(m.*texture, images);
    for (const Light& light : lights) addTexture(light.radianceTexture, images);
    size_t bytes = environment.image ? environment.image->bytes() : 0;
    for (const Mesh* mesh : meshes) bytes += mesh->byteCount();
    for (const TextureImage* image : images) bytes += image->byteCount();
    for (const Animation& animation : animations)
        for (const AnimationChannel& channel : animation.channels)
            bytes += (channel.times.size() + channel.values.size()) * sizeof(float);
    return bytes;
}

Camera cameraAt(const Scene& scene, int index, float time) {
    const SceneCamera& source = scene.cameras.at(static_cast<size_t>(index));
    Camera camera = source.camera;
    if (source.node >= 0) placeAtNode(camera, worldFromNodeAt(scene, source.node, time));
    else if (!source.keys.empty()) placeByKeys(camera, source, time);
    return camera;
}

}  // namespace lumi
