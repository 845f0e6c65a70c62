#pragma once
#include <cmath>
#include <limits>
#include <span>

#include "scene/posed_scene.h"

namespace lumi {

/// Stands among the normals of a mesh's first morph target for "the face's own": such vertices belong to one triangle
/// that is flat since the file gives it no normals, and flat it stays however it bends.
inline const Vec3 kFaceNormal(std::numeric_limits<float>::quiet_NaN());
inline bool isFaceNormal(const Vec3& delta) { return std::isnan(delta.x); }

/// Vertices of `mesh` after morphing by `weights` (one for each target; missing ones are 0) and then, if `joints` is
/// not empty, linear blend skinning with one matrix for each joint. Normals and tangents come out unit; normals go with
/// the cofactors of the blended matrix, tangents and bitangents with the matrix itself. Those of flat triangles
/// (kFaceNormal) are the deformed face's, and their tangents and bitangents go with its edges. Joints mirror a mesh if
/// they mirror more than half of its vertices. Parallel over vertices; the result does not depend on the thread count.
DeformedVertices deform(const Mesh& mesh, std::span<const float> weights, std::span<const Mat4> joints);

}  // namespace lumi
