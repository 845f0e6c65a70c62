#pragma once
#include <tiny_obj_loader.h>

#include "scene/material.h"
#include "scene/obj/obj_textures.h"

namespace lumi {

/// Metallic-roughness materials for those of an .mtl, in their order, and then a plain grey one for faces without.
/// Shininess becomes the GGX roughness of equal peak width [Walter 2007, section 5.2]; black Kd under a bright Ks is
/// metal; illumination models 4, 6, 7 and 9 are glass; the PBR extension (Pr, Pm) wins over both.
std::vector<Material> convertMaterials(const std::vector<tinyobj::material_t>& sources, ObjImages& images,
                                       std::stop_token stop);

/// Warns, once for each kind, of textures that no material is made of. Not of map_Ka: there is no ambient light.
void warnOfOtherTextures(const std::vector<tinyobj::material_t>& sources, FileWarnings& warnings);

}  // namespace lumi
