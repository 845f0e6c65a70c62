#pragma once
#include <memory>
#include <stop_token>
#include <vector>

#include "scene/scene.h"

namespace lumi {

/// Vertices of a deforming mesh at one moment, object space (world space for skinned meshes).
struct DeformedVertices {
    std::vector<Vec3> positions, normals, tangents;  ///< tangents may be empty; their handedness is the mesh's
    /// Of skinned meshes with tangents: where joints take the cross product of normal and tangent, unit; the handedness
    /// is the mesh's. Otherwise empty: it is that product of the two above.
    std::vector<Vec3> bitangents;
    /// The joints' matrix at the first vertex of the majority: of those that are mirrored, or of those that are not.
    Mat4 blend{1};

    /// The joints mirror the mesh: its front faces turn clockwise in the space of `positions`.
    bool isMirrored() const { return isMirroring(blend); }
};

/// How an instance moves while the shutter is open: what it is at equally spaced moments from opening to closing,
/// linear between them.
struct ShutterTrack {
    std::vector<Mat4> worldFromObject;  ///< one for each moment, or a single one if it stays in its place
    std::vector<std::shared_ptr<const DeformedVertices>> deformed;  ///< one for each moment; empty if its shape stays

    Mat4 worldFromObjectAt(float time) const;  ///< `time` from 0 (opening) to 1 (closing)
    /// Is the shape mirrored then? Only where it is `deformed`.
    bool isMirroredAt(float time) const;
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

/// What of an instance is otherwise than at shutter open. Most instances have none of it: see PosedInstance.
struct PosedMotion {
    bool moves = false;               ///< it differs at one of the three moments, or in between
    Mat4 worldFromObjectClose{1};     ///< at shutter close; as at open while the shutter is instantaneous
    Mat4 worldFromObjectPrevious{1};  ///< at the previous frame's shutter open
    std::shared_ptr<const DeformedVertices> deformedClose, deformedPrevious;
    /// Between opening and closing, and the same of the previous frame; null where it stands still meanwhile.
    std::shared_ptr<const ShutterTrack> track, previousTrack;
};

/// One instance at the moments a frame needs. There may be millions: what only those that move have stands apart.
struct PosedInstance {
    Mat4 worldFromObject{1};  ///< at shutter open
    /// For meshes that deform; null otherwise.
    std::shared_ptr<const DeformedVertices> deformed;
    std::shared_ptr<PosedMotion> motion;  ///< null: it is the same at all moments

    bool moves() const { return motion && motion->moves; }
    const Mat4& worldFromObjectClose() const { return motion ? motion->worldFromObjectClose : worldFromObject; }
    const Mat4& worldFromObjectPrevious() const { return motion ? motion->worldFromObjectPrevious : worldFromObject; }
    /// Equal to `deformed` (same pointer) where it has the same shape, the previous one on a cut too.
    const std::shared_ptr<const DeformedVertices>& deformedClose() const {
        return motion ? motion->deformedClose : deformed;
    }
    const std::shared_ptr<const DeformedVertices>& deformedPrevious() const {
        return motion ? motion->deformedPrevious : deformed;
    }
    const ShutterTrack* track() const { return motion ? motion->track.get() : nullptr; }
    const ShutterTrack* previousTrack() const { return motion ? motion->previousTrack.get() : nullptr; }
    Mat3 normalFromObject() const { return normalMatrix(worldFromObject); }
};

/// The matrix of a light's node; of lights without a body, which take no scale, never without axes.
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
    Bounds3 bounds;              ///< at shutter open
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
/// Throws Error(Interrupted) once stopped: it looks between instances and between moments of the shutter.
std::shared_ptr<const PosedScene> poseScene(std::shared_ptr<const Scene> scene, ShutterTimes times,
                                            const PosedScene* earlier = nullptr, std::stop_token stop = {});

}  // namespace lumi
