#pragma once
#include "trace/observer.h"

namespace lumi {

/// A material at a point, textures looked up: what the lobes are built from.
struct BsdfInputs {
    Vec3 baseColor{1};
    float metallic = 0;
    float roughness = 0.5f;
    float ior = 1.5f;          ///< of the material against its outside
    float specular = 1;
    Vec3 specularColor{1};
    float transmission = 0;    ///< share of the dielectric base that transmits instead of scattering diffusely
    bool solid = false;        ///< refracts (closed volume); else a thin wall: transmission goes straight on
    bool entering = true;      ///< wo is on the outside of a solid
};

/// f times cosine of one direction, apart by lobe, and the density over all lobes.
struct BsdfValue {
    Vec3 diffuse{0};      ///< f |cos(wi)| of the diffuse lobe
    Vec3 specular{0};     ///< and of reflection and transmission lobes together
    float pdf = 0;        ///< per solid angle, of sample() over all non-delta lobes
};

struct BsdfSample {
    Vec3 wi{0};           ///< local frame
    Vec3 weight{0};       ///< f |cos| / pdf summed over the lobes that can make wi (the one lobe for delta)
    float pdf = 0;        ///< over all non-delta lobes; 0 if delta
    bool delta = false;
    Lobe lobe = Lobe::None;  ///< the lobe that was drawn; None: absorbed
};

/// The scattering function at one point for one outgoing direction, in the local frame (z is the shading normal on
/// wo's side, wo.z > 0). Lobes:
///   diffuse: Lambert under the specular layer, weighted by what that layer lets through,
///     f = rho/pi (1 - E(wo)) (1 - E(wi)) / (1 - Eavg)  [Kelemen & Szirmay-Kalos 2001], rho = baseColor (1-metallic)(1-transmission);
///   specular reflection: GGX with visible normals [Heitz 2018], Schlick Fresnel from ior, specular, specularColor and
///     (metals) baseColor; exact dielectric Fresnel where the base transmits;
///   specular transmission: rough dielectric [Walter 2007] for solids, mirrored-reflection lobe for thin walls.
/// Roughness below kDeltaRoughness is a perfect mirror or window: a delta lobe.
class Bsdf {
public:
    static constexpr float kDeltaRoughness = 0.02f;

    Bsdf() = default;
    Bsdf(const BsdfInputs& inputs, const Vec3& wo);

    BsdfValue evaluate(const Vec3& wi) const;
    BsdfSample sample(float uLobe, Vec2 u) const;

    /// Directional albedo towards wo of one lobe, and of all specular lobes together. In [0,1].
    Vec3 albedo(Lobe lobe) const;
    Vec3 specularAlbedo() const { return albedo(Lobe::SpecularReflection) + albedo(Lobe::SpecularTransmission); }
    /// One lobe alone, f |cos|, for tests and for modules that replace a term.
    Vec3 evaluate(const Vec3& wi, Lobe lobe) const;
    /// True if every lobe is a delta: next-event estimation cannot contribute.
    bool isDelta() const;

private:
    friend struct BsdfParts;
    BsdfInputs inputs_;
    Vec3 wo_{0, 0, 1};
    float alpha_ = 0.25f;  ///< GGX, roughness squared
    // The implementation adds what it precomputes: lobe weights, F0, albedo look-ups.
};

}  // namespace lumi
