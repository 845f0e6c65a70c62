#pragma once
#include <span>

#include "math/transform.h"

namespace lumi {

/// The box around `points`; empty for none.
Bounds3 boundsOf(std::span<const Vec3> points);

/// The box around the transformed corners of `bounds`: contains every transformed point of it. Empty stays empty.
Bounds3 transformedBounds(const Bounds3& bounds, const Mat4& m);

}  // namespace lumi
