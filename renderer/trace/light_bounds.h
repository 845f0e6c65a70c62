#pragma once
#include "math/vector.h"

namespace lumi {

/// Bounds of where lights are and where they shine to. Directions that a light faces lie within `cosSpread` of the axis
/// (and of its opposite if `bothSides`), and it shines up to `cosReach` from each of them: a sphere has spread -1 and
/// reach 0, a triangle 1 and 0, a spot 1 and the cosine of its cone.
struct LightBounds {
    Bounds3 box;
    Vec3 axis{0, 0, 1};
    float cosSpread = 1, cosReach = 0;
    bool bothSides = false;
    float intensity = 0;  ///< W/sr, luminance, where it shines most
};

/// The bounds of both.
LightBounds unite(const LightBounds& a, const LightBounds& b);

/// What a group costs: how likely it is to be visited, times what is missed by taking it for one light. Without an area
/// (lights along a line or at one place) its length counts a little, so that orientation and intensity still tell.
float costOf(const LightBounds& bounds);

}  // namespace lumi
