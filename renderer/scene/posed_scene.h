#pragma once
#include <memory>
#include <vector>

#include "scene/scene.h"

namespace lumi {

/// Vertices of a deforming mesh at one moment, object space (world space for skinned meshes).
struct DeformedVertices {
    std::vector<Vec3> positions, normals, tangents;  ///< tangents may be empty; their handedness is the mesh's
};

/// How an instance moves while the shutter is open: what it is at equally spaced moments from opening to closing, linear
/// between them.
struct ShutterTrack {
    std::vector<Mat4> worldFromObject;  ///< one for each moment, or a single one if it stays in its place
    std::vector<std::shared_ptr<const DeformedVertices>> deformed;  ///< one for each moment; empty if its shape stays

    Mat4 worldFromObjectAt(float time) const;  ///< `time` from 0 (opening) to 1 (closing)
};

/// Where `time` in [0, 1] lies among `count` equally spaced moments: between `first` and the one after it.
struct TrackPlace {
    size_t first = 0;
    float fraction = 0;
};
inline TrackPlace trackPlace(size_t count, float time) {
    if (count < 2) return {};
    const float at = time * static_cast<float>(count - 1);
    const size_t first = at > 0 ? glm::min(static_cast<size_t>(at), count - 2) : 0;
    return {first, at - static_cast<float>(first)};
}

/// One instance at the moments a frame needs.
struct PosedInstance {
    Mat4 worldFromObject{1};          ///< at shutter open
    Mat4 worldFromObjectClose{1};     ///< at shutter close; equal to the former while the shutter is instantaneous
    Mat4 worldFromObjectPrevious{1};  ///< at the previous frame's shutter open
    Mat3 normalFromObject{1};         ///< normalMatrix(worldFromObject)
    bool moves = false;               ///< any of the three differ
    /// For meshes that deform; null otherwise. `previous` equals `deformed` (same pointer) on a cut.
    std::shared_ptr<const DeformedVertices> deformed, deformedClose, deformedPrevious;
    /// Between opening and closing, and the same of the previous frame; null where it stands still meanwhile.
    std::shared_ptr<const ShutterTrack> track, previousTrack;
};

struct PosedLight {
    Mat4 worldFromLight{1}, worldFromLightPrevious{1};
    std::vector<Mat4> track, previousTrack;  ///< at equally spaced moments of the open shutter; empty: it stands still
    Mat4 worldFromLightAt(float time) const;
};

/// A scene at one moment: shutter open and close, and the previous frame's open, which motion vectors refer to.
/// The shutter's length of time in frames is the camera's (`shutter`). All members are read-only after poseScene().
class PosedScene {
public:
    std::shared_ptr<const Scene> scene;
    float time = 0, previousTime = 0;  ///< seconds, shutter open
    float closeTime = 0;               ///< seconds, shutter close
    std::vector<PosedInstance> instances;
    std::vector<PosedLight> lights;
    Bounds3 bounds;  ///< at shutter open
    bool anythingMoves = false;  ///< against the previous frame
    /// Object-space bounds of each instance's mesh at rest; shared from frame to frame.
    std::shared_ptr<const std::vector<Bounds3>> meshBounds;

    const Mesh& mesh(uint32_t instance) const { return *scene->instances[instance].mesh; }
    const Material& material(uint32_t instance, uint32_t primitive) const {
        return scene->materials[materialIndex(instance, primitive)];
    }
    uint32_t materialIndex(uint32_t instance, uint32_t primitive) const {
        const Instance& i = scene->instances[instance];
        return i.material >= 0 ? static_cast<uint32_t>(i.material) : i.mesh->materialOf(primitive);
    }
    size_t byteCount() const;
};

/// Moments of one frame in seconds. On a cut (first frame, teleport in time) `previousOpen` equals `open`.
struct ShutterTimes {
    float open = 0, close = 0, previousOpen = 0;
};

/// Evaluates node animation, skinning and morphing at the three moments, in parallel over instances.
/// `earlier` (may be null) is the previous frame's posed scene; deformed vertices are shared where they fit.
std::shared_ptr<const PosedScene> poseScene(std::shared_ptr<const Scene> scene, ShutterTimes times,
                                            const PosedScene* earlier = nullptr);

}  // namespace lumi
