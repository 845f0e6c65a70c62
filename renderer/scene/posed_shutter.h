#pragma once
#include <span>
#include <stop_token>
#include <vector>

#include "scene/node_pose.h"
#include "scene/posed_scene.h"
#include "scene/shared_shapes.h"

namespace lumi {

/// Node tree and joints at one moment.
struct PosedMoment {
    NodePose nodes;
    std::vector<std::vector<Mat4>> joints;  ///< for each skin
    std::vector<Mat4> worldFromLight;       ///< for each light, see PosedLight
    std::shared_ptr<SharedShapes> shapes = std::make_shared<SharedShapes>();
};

PosedMoment poseMoment(const Scene& scene, float time);

/// What of a moment places an instance and gives it its shape.
bool isSkinned(const Instance& instance);
bool deforms(const Instance& instance);
Mat4 placementOf(const Instance& instance, const PosedMoment& moment);
std::span<const float> morphWeightsOf(const Instance& instance, const PosedMoment& moment);
std::span<const Mat4> jointsOf(const Instance& instance, const PosedMoment& moment);
bool deformsAlike(const Instance& instance, const PosedMoment& a, const PosedMoment& b);
std::shared_ptr<const DeformedVertices> deformAt(const Instance& instance, const PosedMoment& moment);

/// Moments from `open` to `close` seconds by straightSegments(): between two of them every instance goes straight,
/// within a thousandth of its size, and every light, within a thousandth of the scene's size and of its unit axis.
/// `meshBounds` as in PosedScene. Throws Error(Interrupted) once stopped.
std::vector<PosedMoment> shutterMoments(const Scene& scene, float open, float close,
                                        std::span<const Bounds3> meshBounds, const std::stop_token& stop);

/// An instance's track over such moments, with as few of them as it needs; null if it stands still. `deformed` is its
/// shape at the first of them, if it has one already.
std::shared_ptr<const ShutterTrack> shutterTrack(const Instance& instance, std::span<const PosedMoment> moments,
                                                 const Bounds3& meshBounds,
                                                 std::shared_ptr<const DeformedVertices> deformed);

/// The frames of light number `light` over the moments; empty if it stands still.
std::vector<Mat4> shutterFrames(size_t light, std::span<const PosedMoment> moments);

}  // namespace lumi
