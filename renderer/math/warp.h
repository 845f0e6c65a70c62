#pragma once
#include "math/vector.h"

namespace lumi {

/// Maps from the unit square, each beside its density. Densities are per unit of the target's own measure.

/// Concentric map of the square onto the unit disk [Shirley 1997]; density 1/pi per area.
Vec2 sampleDisk(Vec2 u);

/// Directions around +Z in proportion to the cosine; density cos/pi per solid angle, 0 below the horizon.
Vec3 sampleCosineHemisphere(Vec2 u);
inline float pdfCosineHemisphere(float cosTheta) { return cosTheta > 0 ? cosTheta * kInvPi : 0; }

/// Directions on the whole sphere; density 1/(4 pi) per solid angle.
Vec3 sampleSphere(Vec2 u);
constexpr float pdfSphere() { return 0.25f * kInvPi; }

/// Directions around +Z within the angle of cosine `cosMax`. `oneMinusCosMax` is passed so that cones of a
/// thousandth of a degree keep their precision. Density 1/(2 pi (1 - cosMax)) per solid angle.
Vec3 sampleCone(Vec2 u, float oneMinusCosMax);
inline float pdfCone(float oneMinusCosMax) { return 1 / (2 * kPi * oneMinusCosMax); }

/// Barycentrics (b1, b2) of a triangle, uniform in area [Heitz 2019, "low-distortion map"].
Vec2 sampleTriangle(Vec2 u);

/// Equirectangular environment maps: the image centre is -Z, the left edge +Z, u grows towards +X, v from +Y down.
Vec3 directionFromLatLong(Vec2 uv);

Vec2 latLongFromDirection(const Vec3& direction);

}  // namespace lumi
