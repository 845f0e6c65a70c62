#pragma once
#include <string>

#include "params/parameter.h"
#include "scene/texture.h"

namespace lumi {

enum class AlphaMode : uint8_t { Opaque, Mask, Blend };

/// A glTF 2.0 metallic-roughness material with the KHR extensions that this renderer shades. Factors multiply their
/// texture. Colours are linear Rec.709. Of glTF's core only occlusionTexture is left out, and never decoded: light
/// transport computes occlusion.
struct Material {
    std::string name;

    Vec3 baseColor{1};
    float alpha = 1;
    Texture baseColorTexture;  ///< RGB colour (sRGB), A alpha
    float metallic = 0;
    float roughness = 0.5f;            ///< the user's; ggxAlpha is its square
    Texture metallicRoughnessTexture;  ///< G roughness, B metallic
    Texture normalTexture;
    float normalScale = 1;

    Vec3 emission{0};  ///< radiance, W/(m^2 sr), strength included
    Texture emissionTexture;
    bool unlit = false;  ///< KHR_materials_unlit: the mesh's colours multiply the emission

    AlphaMode alphaMode = AlphaMode::Opaque;
    float alphaCutoff = 0.5f;
    /// If not, only the front faces emit, and the camera does not see the back faces of what does not transmit. All
    /// other rays meet both, and shading is always two-sided.
    bool doubleSided = true;

    float ior = 1.5f;
    float specular = 1;  ///< KHR_materials_specular: weight of the dielectric reflection
    Vec3 specularColor{1};
    Texture specularTexture;       ///< A
    Texture specularColorTexture;  ///< RGB (sRGB)

    float transmission = 0;       ///< KHR_materials_transmission: share of the diffuse base that transmits
    Texture transmissionTexture;  ///< R
    float thickness = 0;          ///< KHR_materials_volume: 0 is a thin wall (no refraction), above 0 a closed solid
    Vec3 attenuationColor{1};
    float attenuationDistance = kInfinity;  ///< metres in which light takes on attenuationColor

    float clearcoat = 0;       ///< KHR_materials_clearcoat: share of the surface under a varnish of index 1.5
    Texture clearcoatTexture;  ///< R
    float clearcoatRoughness = 0;
    Texture clearcoatRoughnessTexture;  ///< G
    Texture clearcoatNormalTexture;     ///< without one the varnish follows the smooth normal, not normalTexture
    float clearcoatNormalScale = 1;

    Vec3 sheenColor{0};         ///< KHR_materials_sheen: reflectance of fibres at grazing angles
    Texture sheenColorTexture;  ///< RGB (sRGB)
    float sheenRoughness = 0;
    Texture sheenRoughnessTexture;  ///< A

    float anisotropy = 0;          ///< KHR_materials_anisotropy: how far the highlight is stretched along its direction
    float anisotropyRotation = 0;  ///< radians, counter-clockwise from the tangent
    Texture anisotropyTexture;     ///< RG direction in tangent space, -1 to 1; B multiplies anisotropy

    float iridescence = 0;       ///< KHR_materials_iridescence: share of the surface under a thin film
    Texture iridescenceTexture;  ///< R
    float iridescenceIor = 1.3f;
    float iridescenceThicknessMin = 100, iridescenceThicknessMax = 400;  ///< nm; without a texture the latter counts
    Texture iridescenceThicknessTexture;                                 ///< G goes from the least to the most

    bool emits() const { return !isBlack(emission); }
    bool isSolid() const { return thickness > 0; }
    bool hasSheen() const { return !isBlack(sheenColor); }
    bool isLayered() const { return clearcoat > 0 || hasSheen() || anisotropy > 0 || iridescence > 0; }
    bool hasAlpha() const { return alphaMode != AlphaMode::Opaque; }
    /// Everything a user can move: base-color, metallic, roughness, emission, ior, ...
    void describe(ParameterVisitor&);
    bool operator==(const Material&) const = default;

private:
    void describeTransmission(ParameterVisitor&);
    void describeLayers(ParameterVisitor&);
};

}  // namespace lumi
