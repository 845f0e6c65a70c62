#pragma once
#include "scene/gltf/nodes.h"

namespace lumi::gltf {

/// What a triangle takes in a Mesh: its corners and its material.
constexpr size_t kTriangleBytes = 4 * sizeof(uint32_t);

/// Refuses files that ask for absurdly more than they hold, before memory is taken: a count is only a number where an
/// accessor has no bufferView (its elements are zeros), and where instances share their transforms. Limits over the
/// whole file, where `bytes` are those of the file, its buffers and what its views decompress to:
/// - vertices without data: 2^16 + bytes;
/// - elements of other attributes, morph targets, keys and transforms without data: 2^20 + 16 bytes (a face with
///   hundreds of sparse expressions needs 8);
/// - instances of EXT_mesh_gpu_instancing, with data or without: 2^16 + 4 bytes (a translation takes 12; up to 48 nodes
///   may share it);
/// - triangles that are no Draco's: 2^22 + 8 bytes (a strip takes 1 for each; primitives may share indices).
/// Looks at the meshes and nodes of the chosen scene and at all animations. Throws Error(BadInput) with the JSON path
/// of what passes a limit, and the limit; Error(Resources) if the triangles of all primitives, which may share their
/// indices, do not fit in memory.
void checkCounts(const Document& document, const NodeTree& tree);

}  // namespace lumi::gltf
