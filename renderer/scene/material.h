#pragma once
#include <string>

#include "params/parameter.h"
#include "scene/texture.h"

namespace lumi {

enum class AlphaMode : uint8_t { Opaque, Mask, Blend };

/// A glTF 2.0 metallic-roughness material with the KHR extensions that this renderer shades.
/// Factors multiply their texture. Colours are linear Rec.709.
struct Material {
    std::string name;

    Vec3 baseColor{1};
    float alpha = 1;
    Texture baseColorTexture;  ///< RGB colour (sRGB), A alpha
    float metallic = 0;
    float roughness = 0.5f;  ///< the user's; ggxAlpha is its square
    Texture metallicRoughnessTexture;  ///< G roughness, B metallic
    Texture normalTexture;
    float normalScale = 1;
    Texture occlusionTexture;  ///< read, not used by the path tracer: light transport computes occlusion

    Vec3 emission{0};  ///< radiance, W/(m^2 sr), strength included
    Texture emissionTexture;

    AlphaMode alphaMode = AlphaMode::Opaque;
    float alphaCutoff = 0.5f;
    bool doubleSided = true;  ///< only decides whether both faces emit; shading is always two-sided

    float ior = 1.5f;
    float specular = 1;  ///< KHR_materials_specular: weight of the dielectric reflection
    Vec3 specularColor{1};
    Texture specularTexture;       ///< A
    Texture specularColorTexture;  ///< RGB (sRGB)

    float transmission = 0;  ///< KHR_materials_transmission: share of the diffuse base that transmits
    Texture transmissionTexture;  ///< R
    float thickness = 0;  ///< KHR_materials_volume: 0 is a thin wall (no refraction), above 0 a closed solid
    Vec3 attenuationColor{1};
    float attenuationDistance = kInfinity;  ///< metres in which light takes on attenuationColor

    bool emits() const { return !isBlack(emission); }
    bool isSolid() const { return thickness > 0; }
    bool hasAlpha() const { return alphaMode != AlphaMode::Opaque; }
    /// Everything a user can move: base-color, metallic, roughness, emission, ior, ...
    void describe(ParameterVisitor&);
};

}  // namespace lumi
