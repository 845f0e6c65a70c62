#pragma once
#include <functional>
#include <stop_token>

#include "scene/bounds.h"
#include "scene/node_pose.h"

namespace lumi {

/// Calls visit(box) with the world-space box of each instance in one pose of the nodes, in order; meshes without
/// vertices have empty ones. `meshBounds` remembers boxes of meshes at rest from pose to pose.
void eachBounds(const Scene& scene, const NodePose& pose, MeshBounds& meshBounds,
                const std::function<void(const Bounds3&)>& visit);

/// The box of all that stands at time 0, and of where it comes while animation plays. Looked at are 17 moments, equally
/// spaced, of each length that animations have (the four longest): between two of them, what turns round once in that
/// time strays by 2% of its distance to the axis at most. Where a pose takes more than 2^18 nodes and vertices that
/// bend, 5 moments. What would make the box more than four times as large as at time 0 is left out: it leaves the
/// picture rather than making everything a speck. Scenes without animation: Scene::restBounds(). Throws
/// Error(Interrupted) once stopped.
Bounds3 boundsOverTime(const Scene& scene, std::stop_token stop = {});

/// Throws Error(Interrupted) if `stop` is requested: the scene is still being loaded.
void checkLoadStop(const Scene& scene, const std::stop_token& stop);

}  // namespace lumi
