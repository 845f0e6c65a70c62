#pragma once
#include <map>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "params/parameter.h"
#include "scene/animation.h"
#include "scene/camera.h"
#include "scene/light.h"
#include "scene/material.h"
#include "scene/mesh.h"

namespace lumi {

/// A place in the node tree. Parents stand before their children.
struct Node {
    std::string name;
    int parent = -1;
    Transform local;         ///< rest pose; animation replaces its parts
    bool hasMatrix = false;  ///< glTF matrices that are no TRS (shear) are kept as they are
    Mat4 matrix{1};
    std::vector<float> morphWeights;  ///< rest weights of the node's mesh
    bool sharesMorphWeights = false;  ///< its weights are its parent's, whatever moves them
};

/// Joints of a skinned mesh: node indices, and the matrix from mesh space to each joint's rest space.
struct Skin {
    std::vector<int> joints;
    std::vector<Mat4> inverseBind;
};

/// A mesh placed in the world: what Embree instances, and what objectId - 1 and SurfacePoint::instance count.
struct Instance {
    std::string name;
    std::shared_ptr<const Mesh> mesh;
    int node = -1;
    int skin = -1;      ///< index into Scene::skins; skinned meshes ignore their node's transform (glTF)
    int material = -1;  ///< replaces the mesh's own materials when >= 0
    int light = -1;     ///< index into Scene::lights when this is the visible body of a light
};

/// A camera with what moves it: either a node of a glTF tree, or keys of its own (scene file).
struct SceneCamera {
    struct Key {
        float time = 0;
        Vec3 eye{0}, target{0};
        float fovYDeg = 45, focus = 5;
    };
    Camera camera;
    int node = -1;  ///< the camera's frame, looking along local -Z; `camera.eye`/`target` hold the rest pose
    std::vector<Key> keys;
    Interpolation interpolation = Interpolation::CatmullRom;
};

/// How a scene wants to be rendered when nobody says otherwise ("render" in the scene file).
struct RenderDefaults {
    Extent2 size{1280, 720};
    float fps = 60;
    float exposureEv = 0;
    std::string module = "accumulate";
    std::vector<std::pair<std::string, std::string>> set;  ///< parameter id, text as on the command line
};

/// A loaded scene. Immutable once loaded: an edit makes a new Scene that shares what did not change. Meshes are in
/// object space, nodes in parents-first order, every light's and camera's node exists.
struct Scene {
    std::string title;
    std::string path;           ///< the file it came from; empty if built in memory
    std::string contentDigest;  ///< of every byte that was loaded: file, buffers, images
    uint64_t version = 0;       ///< grows with each edit

    std::vector<Node> nodes;
    std::vector<Material> materials;  ///< at least one
    std::vector<Instance> instances;
    std::vector<Skin> skins;
    std::vector<Light> lights;
    std::vector<SceneCamera> cameras;  ///< at least one after loading
    std::vector<Animation> animations;
    Environment environment;
    RenderDefaults render;

    bool isAnimated() const;
    /// Seconds after which all looping animations and camera paths have played once; 0 for still scenes.
    float duration() const;
    Bounds3 restBounds() const;
    int64_t triangleCount() const;  ///< instances counted
    size_t byteCount() const;
};

/// Camera `index` at `time`, animation applied. The Document's edits replace it while the user flies.
Camera cameraAt(const Scene& scene, int index, float time);

}  // namespace lumi
