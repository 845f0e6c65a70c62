#pragma once
#include <cmath>

#include "math/vector.h"

namespace lumi {

/// unitOr() in fewer steps, for what is done at each hit: a vector whose square vanishes or overflows has no direction.
inline Vec3 quickUnitOr(const Vec3& v, const Vec3& otherwise) {
    const float length2 = glm::dot(v, v);
    return length2 > 0 && std::isfinite(length2) ? v * (1 / std::sqrt(length2)) : otherwise;
}

}  // namespace lumi
