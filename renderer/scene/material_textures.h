#pragma once
#include "scene/material.h"

namespace lumi {

/// Every texture that a material can have.
inline constexpr Texture Material::*kMaterialTextures[] = {
    &Material::baseColorTexture,       &Material::metallicRoughnessTexture, &Material::normalTexture,
    &Material::emissionTexture,        &Material::specularTexture,          &Material::specularColorTexture,
    &Material::transmissionTexture,    &Material::clearcoatTexture,         &Material::clearcoatRoughnessTexture,
    &Material::clearcoatNormalTexture, &Material::sheenColorTexture,        &Material::sheenRoughnessTexture,
    &Material::anisotropyTexture,      &Material::iridescenceTexture,       &Material::iridescenceThicknessTexture};

}  // namespace lumi
