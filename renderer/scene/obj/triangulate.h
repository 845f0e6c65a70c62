#pragma once
#include <span>
#include <vector>

#include "math/vector.h"

namespace lumi {

/// Cuts a polygon of three corners or more into corners-2 triangles, by ear clipping in the plane of its Newell normal;
/// the corners keep their direction. A polygon without area, or one that crosses itself, becomes a fan from where no
/// ear is left. Corner numbers, not vertices.
std::vector<UVec3> triangulatePolygon(std::span<const Vec3> corners);

}  // namespace lumi
