#pragma once
#include <algorithm>
#include <cmath>

#include "math/vector.h"

namespace lumi {

/// Isotropic GGX microfacets with Smith's masking [Walter 2007; Heitz 2014]. Directions are unit, in the frame whose z
/// is the surface normal; `w` may be on either side, `h` has z > 0.
struct Ggx {
    float alpha = 0.25f;  ///< roughness squared, above 0

    /// Density of facet normals, per solid angle and projected area.
    float distribution(const Vec3& h) const {
        // Written in sines: 1 - cos^2 would lose the digits that a narrow lobe needs.
        const float a2 = alpha * alpha;
        const float s = h.x * h.x + h.y * h.y + a2 * h.z * h.z;
        return a2 * kInvPi / (s * s);
    }

    float lambda(const Vec3& w) const {
        const float z2 = std::max(w.z * w.z, 1e-12f);
        return 0.5f * (std::sqrt(1 + alpha * alpha * (w.x * w.x + w.y * w.y) / z2) - 1);
    }
    /// Share of facets that `w` sees.
    float masking(const Vec3& w) const { return 1 / (1 + lambda(w)); }

    /// A facet normal seen from `wo` (z > 0), with density masking(wo) distribution(h) dot(wo, h) / wo.z
    /// [Dupuy & Benyoub 2023: a reflected cap of the unit sphere].
    Vec3 sampleVisibleNormal(const Vec3& wo, Vec2 u) const {
        const float phi = 2 * kPi * u.y;
        return visibleNormal(stretched(wo), u.x, std::cos(phi), std::sin(phi));
    }
    float visibleNormalPdf(const Vec3& wo, const Vec3& h) const {
        return masking(wo) * distribution(h) * std::max(glm::dot(wo, h), 0.0f) / wo.z;
    }

    /// `w` as seen from the configuration where the roughness is 1.
    Vec3 stretched(const Vec3& w) const { return glm::normalize(Vec3(alpha * w.x, alpha * w.y, w.z)); }
    /// The map behind sampleVisibleNormal(), for quadrature: `height` and the azimuth run over the unit square.
    Vec3 visibleNormal(const Vec3& stretchedWo, float height, float cosPhi, float sinPhi) const {
        const float z = (1 - height) * (1 + stretchedWo.z) - stretchedWo.z;
        const float r = std::sqrt(std::max(0.0f, 1 - z * z));
        const Vec3 h = stretchedWo + Vec3(r * cosPhi, r * sinPhi, z);
        return glm::normalize(Vec3(alpha * h.x, alpha * h.y, std::max(h.z, 1e-7f)));
    }
};

/// Masking and shadowing of reflection, correlated by height [Heitz 2014, eq. 99].
inline float maskingShadowing(float lambdaO, float lambdaI) { return 1 / (1 + lambdaO + lambdaI); }
/// And of transmission: the two sides are taken as independent [Walter 2007].
inline float maskingBothSides(float lambdaO, float lambdaI) { return 1 / ((1 + lambdaO) * (1 + lambdaI)); }

}  // namespace lumi
