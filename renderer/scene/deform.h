#pragma once
#include <span>

#include "scene/posed_scene.h"

namespace lumi {

/// Vertices of `mesh` after morphing by `weights` (one for each target; missing ones are 0) and then, if `joints` is
/// not empty, linear blend skinning with one matrix for each joint. Normals and tangents come out unit; normals go with
/// the cofactors of the blended matrix. Parallel over vertices; the result does not depend on the thread count.
DeformedVertices deform(const Mesh& mesh, std::span<const float> weights, std::span<const Mat4> joints);

}  // namespace lumi
