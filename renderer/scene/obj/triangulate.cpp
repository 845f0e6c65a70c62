#include "scene/obj/triangulate.h"

#include <cmath>
#include <numeric>

namespace lumi {
namespace {

/// Normal of a polygon, as long as twice its area [Newell; Tampieri 1992].
Vec3 newellNormal(std::span<const Vec3> corners) {
    Vec3 normal(0);
    for (size_t i = 0; i < corners.size(); ++i) {
        const Vec3& a = corners[i];
        const Vec3& b = corners[(i + 1) % corners.size()];
        normal += Vec3((a.y - b.y) * (a.z + b.z), (a.z - b.z) * (a.x + b.x), (a.x - b.x) * (a.y + b.y));
    }
    return normal;
}

/// The corners seen against the normal: its largest axis is dropped, the others kept right-handed.
std::vector<Vec2> project(std::span<const Vec3> corners, const Vec3& normal) {
    const Vec3 a = glm::abs(normal);
    const int axis = a.x >= a.y && a.x >= a.z ? 0 : a.y >= a.z ? 1 : 2;
    const bool flip = normal[axis] < 0;
    const int u = (axis + (flip ? 2 : 1)) % 3, v = (axis + (flip ? 1 : 2)) % 3;
    std::vector<Vec2> flat;
    flat.reserve(corners.size());
    for (const Vec3& p : corners) flat.emplace_back(p[u], p[v]);
    return flat;
}

float turn(const Vec2& a, const Vec2& b, const Vec2& c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

bool contains(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& p) {
    return turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0;
}

/// Whether the corner `left[i]` can be cut off: it is convex, and no other corner lies inside.
bool isEar(const std::vector<Vec2>& flat, const std::vector<uint32_t>& left, size_t i) {
    const size_t n = left.size();
    const uint32_t before = left[(i + n - 1) % n], here = left[i], after = left[(i + 1) % n];
    if (!(turn(flat[before], flat[here], flat[after]) > 0)) return false;
    for (const uint32_t other : left) {
        if (other == before || other == here || other == after) continue;
        const Vec2& p = flat[other];
        if (p == flat[before] || p == flat[here] || p == flat[after]) continue;
        if (contains(flat[before], flat[here], flat[after], p)) return false;
    }
    return true;
}

}  // namespace

std::vector<UVec3> triangulatePolygon(std::span<const Vec3> corners) {
    if (corners.size() < 3) return {};
    if (corners.size() == 3) return {UVec3(0, 1, 2)};
    std::vector<UVec3> triangles;
    triangles.reserve(corners.size() - 2);
    std::vector<uint32_t> left(corners.size());
    std::iota(left.begin(), left.end(), 0u);
    const Vec3 normal = newellNormal(corners);
    const std::vector<Vec2> flat = project(corners, normal);
    // Starting with the second corner, a convex polygon becomes the fan around its first. A cut changes the two corners
    // beside it alone, which are tried next: the one after, then the one before, so that one round meets all ears.
    size_t candidate = 1;
    bool triesBefore = false;
    size_t failures = glm::length(normal) > 0 ? 0 : corners.size();
    while (left.size() > 3 && failures < left.size()) {
        const size_t n = left.size();
        const size_t i = (triesBefore ? candidate + n - 1 : candidate) % n;
        if (isEar(flat, left, i)) {
            triangles.emplace_back(left[(i + n - 1) % n], left[i], left[(i + 1) % n]);
            left.erase(left.begin() + static_cast<std::ptrdiff_t>(i));
            candidate = i;
            failures = 0;
            triesBefore = false;
        } else if (failures++ == 0) {
            triesBefore = true;
        } else {
            triesBefore = false;
            ++candidate;
        }
    }
    for (size_t i = 1; i + 1 < left.size(); ++i) triangles.emplace_back(left[0], left[i], left[i + 1]);
    return triangles;
}

}  // namespace lumi
