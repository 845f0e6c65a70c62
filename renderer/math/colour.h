#pragma once
#include <cmath>

#include "math/vector.h"

namespace lumi {

/// sRGB transfer function (IEC 61966-2-1) between linear and encoded values; defined for any finite input,
/// negative values by odd symmetry.
inline float srgbFromLinear(float x) {
    const float a = std::abs(x);
    return std::copysign(a <= 0.0031308f ? 12.92f * a : 1.055f * std::pow(a, 1 / 2.4f) - 0.055f, x);
}
inline float linearFromSrgb(float x) {
    const float a = std::abs(x);
    return std::copysign(a <= 0.04045f ? a / 12.92f : std::pow((a + 0.055f) / 1.055f, 2.4f), x);
}
inline Vec3 linearFromSrgb(const Vec3& c) { return {linearFromSrgb(c.x), linearFromSrgb(c.y), linearFromSrgb(c.z)}; }
inline Vec3 srgbFromLinear(const Vec3& c) { return {srgbFromLinear(c.x), srgbFromLinear(c.y), srgbFromLinear(c.z)}; }

/// Linear value of each of the 256 encoded bytes.
const float* linearFromSrgbTable();

}  // namespace lumi
