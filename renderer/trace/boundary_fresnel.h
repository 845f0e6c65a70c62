#pragma once
#include <algorithm>

#include "math/vector.h"

namespace lumi {

/// How a boundary between dielectrics divides light where a specular weight and colour change its Fresnel term, as
/// KHR_materials_specular has it: F0 becomes min(F0 specularColor, 1) specular, F90 specular, and what is let through
/// is 1 less the greatest channel. The exact term takes the place of Schlick's:
///   F' = specular (f0 + (1 - f0) (F - F0) / (1 - F0)),  f0 = min(F0 specularColor, 1).
/// A specular of 0 is a boundary that bends light but reflects only what cannot be bent: total reflection stays whole.
///
/// F' is linear in F, so that means over facets follow from those of three boundaries: one that reflects `all`, one
/// under the `exact` term and a `clear` one, whose reflectance is 1 under total reflection and else 0.
class BoundaryFresnel {
public:
    BoundaryFresnel() = default;
    /// `f0` is F0 of the boundary's index, below 1; `layerF0` f0 above.
    BoundaryFresnel(float f0, const Vec3& layerF0, float specular)
        : base_((layerF0 - Vec3(f0)) * (specular / (1 - f0))),
          slope_(Vec3(specular) - base_),
          leastSlope_(minComponent(slope_)),
          clear_(1 - specular) {}

    Vec3 reflected(float all, float exact, float clear) const {
        return glm::max(base_ * all + slope_ * exact + Vec3(clear_ * clear), Vec3(0));
    }
    /// The greatest channel of that; also of what the three boundaries lose.
    float most(float all, float exact, float clear) const {
        return std::max(maxComponent(base_) * all + leastSlope_ * exact + clear_ * clear, 0.0f);
    }
    /// From what the latter two let through.
    float through(float exact, float clear) const { return leastSlope_ * exact + clear_ * clear; }

    bool usesAll() const { return !isBlack(base_); }
    bool usesClear() const { return clear_ > 0; }

private:
    Vec3 base_{0}, slope_{1};
    float leastSlope_ = 1;
    float clear_ = 0;
};

}  // namespace lumi
