#pragma once
#include <algorithm>
#include <cmath>

#include "math/vector.h"
#include "trace/observer.h"

namespace lumi {

/// What lies over or changes the base of a material. All zero is none of it.
struct LayerInputs {
    float clearcoat = 0;  ///< share of the surface that a clear varnish of index 1.5 covers
    float clearcoatRoughness = 0;
    Vec3 clearcoatNormal{0, 0, 1};  ///< unit, local frame
    Vec3 sheenColor{0};
    float sheenRoughness = 0;
    float anisotropy = 0;  ///< stretches the highlight: alpha along the direction is mix(alpha, 1, anisotropy^2)
    Vec2 anisotropyDirection{1, 0};  ///< in the local x-y plane, any length above 0
    float iridescence = 0;           ///< share of the surface that a thin film covers
    float iridescenceIor = 1.3f;
    float iridescenceThickness = 0;  ///< nm
};

/// A material at a point, textures looked up: what the lobes are built from. Values out of range are clamped.
struct BsdfInputs {
    Vec3 baseColor{1};
    float metallic = 0;
    float roughness = 0.5f;
    float ior = 1.5f;  ///< of the material against its outside
    float specular = 1;
    Vec3 specularColor{1};
    float transmission = 0;           ///< share of the dielectric base that transmits instead of scattering diffusely
    bool solid = false;               ///< refracts (closed volume); else a thin wall: transmission goes straight on
    bool entering = true;             ///< wo is on the outside of a solid
    bool multipleScattering = false;  ///< reflection is given what facets scatter twice or more
    bool layered = false;             ///< `layers` take part
    LayerInputs layers;

    /// Makes every lobe at least this rough.
    void widen(float leastRoughness) {
        roughness = std::max(roughness, leastRoughness);
        layers.clearcoatRoughness = std::max(layers.clearcoatRoughness, leastRoughness);
    }
};

/// f times cosine of one direction, apart by lobe, and the density over all lobes.
struct BsdfValue {
    Vec3 diffuse{0};   ///< f |cos(wi)| of the diffuse lobe
    Vec3 specular{0};  ///< and of all other lobes together
    float pdf = 0;     ///< per solid angle, of sample() over all non-delta lobes
};

struct BsdfSample {
    Vec3 wi{0};      ///< local frame
    Vec3 weight{0};  ///< f |cos| / pdf summed over the lobes that can make wi (the one lobe for delta)
    float pdf = 0;   ///< over all non-delta lobes; 0 if delta
    bool delta = false;
    Lobe lobe = Lobe::None;  ///< the lobe that was drawn; None: absorbed
};

/// Of one lobe: f |cos| and the density of its own sampling.
struct LobeValue {
    Vec3 f{0};
    float pdf = 0;
};

/// wo is kept at least this far above the horizon.
constexpr float kMinCosine = 1e-4f;

/// Unit half vector on the side z > 0; z = 0 if there is none.
inline Vec3 halfVector(const Vec3& sum) {
    const float length2 = glm::dot(sum, sum);
    if (!(length2 > 1e-14f)) return Vec3(0);
    return sum * (std::copysign(1.0f, sum.z) / std::sqrt(length2));
}

}  // namespace lumi
