#pragma once
#include "scene/gltf/textures.h"
#include "scene/material.h"

namespace lumi::gltf {

/// All materials of the file, in its order, and then glTF's default material. Their textures' images are filled by
/// library.load(). Factors outside their range are clamped.
std::vector<Material> loadMaterials(const Document& document, TextureLibrary& library);

}  // namespace lumi::gltf
