#pragma once
#include <vector>

#include "scene/mesh.h"

namespace lumi {

/// Drops vertices that no triangle uses; the order of the others stays.
void compactVertices(Mesh& mesh);

/// New vertex i is old vertex source[i], with all its attributes; triangles stay as they are.
void gatherVertices(Mesh& mesh, const std::vector<uint32_t>& source);

/// Gives each triangle its own three vertices with the triangle's normal, so that it shades flat.
void makeFlat(Mesh& mesh);

/// One mesh of several: vertices and triangles one after another. An attribute that only some have is filled up with
/// its default (uv 0, white, an arbitrary tangent frame, no displacement, joint 0); normals must be on all or none.
Mesh mergeMeshes(std::vector<Mesh> parts);

}  // namespace lumi
