#pragma once
#include <array>
#include <vector>

#include "scene/gltf/textures.h"
#include "scene/material.h"

namespace lumi::gltf {

/// Which TEXCOORD_n of the file a mesh's two sets of texture coordinates are.
using UvSets = std::array<int, 2>;

struct MaterialSet {
    std::vector<Material> materials;
    std::vector<UvSets> uvSets;  ///< of each material's meshes
};

/// All materials of the file, in its order, and then glTF's default material. Their textures' images are filled by
/// library.load(). Factors outside their range are clamped.
MaterialSet loadMaterials(const Document& document, TextureLibrary& library);

}  // namespace lumi::gltf
