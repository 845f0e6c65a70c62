#pragma once
#include <algorithm>
#include <cmath>

#include "math/sin_cos.h"
#include "math/vector.h"

namespace lumi {

/// GGX microfacets with Smith's masking [Walter 2007; Heitz 2014]. Directions are unit, in the frame whose z is the
/// surface normal; `w` may be on either side, `h` has z > 0. Anisotropic facets are stretched along x.
struct Ggx {
    float alpha = 0.25f;  ///< roughness squared, above 0; geometric mean of those along x and y
    float stretch = 1;    ///< alphaX / alpha = alpha / alphaY
    float shrink = 1;     ///< 1 / stretch

    static Ggx anisotropic(float alphaX, float alphaY) {
        return {std::sqrt(alphaX * alphaY), std::sqrt(alphaX / alphaY), std::sqrt(alphaY / alphaX)};
    }
    bool isAnisotropic() const { return stretch != 1; }

    /// Density of facet normals, per solid angle and projected area.
    float distribution(const Vec3& h) const {
        // Written in sines: 1 - cos^2 would lose the digits that a narrow lobe needs.
        const float a2 = alpha * alpha;
        const float s = sqr(h.x * shrink) + sqr(h.y * stretch) + a2 * h.z * h.z;
        return a2 * kInvPi / (s * s);
    }

    float lambda(const Vec3& w) const {
        const float z2 = std::max(w.z * w.z, 1e-12f);
        return 0.5f * (std::sqrt(1 + alpha * alpha * (sqr(w.x * stretch) + sqr(w.y * shrink)) / z2) - 1);
    }
    /// Share of facets that `w` sees.
    float masking(const Vec3& w) const { return 1 / (1 + lambda(w)); }

    /// A facet normal seen from `wo` (z > 0), with density masking(wo) distribution(h) dot(wo, h) / wo.z
    /// [Dupuy & Benyoub 2023: a reflected cap of the unit sphere].
    Vec3 sampleVisibleNormal(const Vec3& wo, Vec2 u) const {
        const SinCos phi = sinCosTurns(u.y);
        return visibleNormal(stretched(wo), u.x, phi.cosine, phi.sine);
    }
    float visibleNormalPdf(const Vec3& wo, const Vec3& h) const {
        return masking(wo) * distribution(h) * std::max(glm::dot(wo, h), 0.0f) / wo.z;
    }

    /// `w` as seen from the configuration where the roughness is 1.
    Vec3 stretched(const Vec3& w) const {
        return glm::normalize(Vec3(alpha * (w.x * stretch), alpha * (w.y * shrink), w.z));
    }
    /// The map behind sampleVisibleNormal(), for quadrature: `height` and the azimuth run over the unit square.
    Vec3 visibleNormal(const Vec3& stretchedWo, float height, float cosPhi, float sinPhi) const {
        const float z = (1 - height) * (1 + stretchedWo.z) - stretchedWo.z;
        const float r = std::sqrt(std::max(0.0f, 1 - z * z));
        const Vec3 h = stretchedWo + Vec3(r * cosPhi, r * sinPhi, z);
        return glm::normalize(Vec3(alpha * (h.x * stretch), alpha * (h.y * shrink), std::max(h.z, 1e-7f)));
    }
};

/// Masking and shadowing of reflection, correlated by height [Heitz 2014, eq. 99].
inline float maskingShadowing(float lambdaO, float lambdaI) { return 1 / (1 + lambdaO + lambdaI); }
/// And of transmission: the two sides are taken as independent [Walter 2007].
inline float maskingBothSides(float lambdaO, float lambdaI) { return 1 / ((1 + lambdaO) * (1 + lambdaI)); }

}  // namespace lumi
