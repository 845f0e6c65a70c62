#pragma once
#include <memory>

#include "scene/gltf/document.h"
#include "scene/gltf/materials.h"
#include "scene/mesh.h"

namespace lumi::gltf {

/// The meshes of the file whose `used` flag is set (others stay null), in parallel: one Mesh for each glTF mesh, its
/// primitives merged, a material for each triangle. Meshes without any triangle stay null too. `materials` are those
/// of loadMaterials(): the last is glTF's default. Tangents are computed where a normal map or
/// anisotropy needs them, and then for the whole mesh.
std::vector<std::shared_ptr<const Mesh>> loadMeshes(const Document& document, const std::vector<bool>& used,
                                                    const MaterialSet& materials);

}  // namespace lumi::gltf
