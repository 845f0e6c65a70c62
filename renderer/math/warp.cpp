#include "math/warp.h"

#include <algorithm>
#include <cmath>

#include "math/sin_cos.h"

namespace lumi {

Vec2 sampleDisk(Vec2 u) {
    const Vec2 s = 2.0f * u - Vec2(1);
    if (s.x == 0 && s.y == 0) return Vec2(0);
    const bool wide = std::abs(s.x) > std::abs(s.y);
    const float radius = wide ? s.x : s.y;
    const SinCos angle = sinCosTurns(wide ? 0.125f * (s.y / s.x) : 0.25f - 0.125f * (s.x / s.y));
    return radius * Vec2(angle.cosine, angle.sine);
}

Vec3 sampleCosineHemisphere(Vec2 u) {
    const Vec2 d = sampleDisk(u);
    return {d.x, d.y, std::sqrt(std::abs(1 - d.x * d.x - d.y * d.y))};  // below zero by rounding only
}

Vec3 sampleSphere(Vec2 u) {
    const float z = 1 - 2 * u.x;
    const float r = std::sqrt(std::max(0.0f, 1 - z * z));
    const SinCos phi = sinCosTurns(u.y);
    return {r * phi.cosine, r * phi.sine, z};
}

Vec3 sampleCone(Vec2 u, float oneMinusCosMax) {
    const float height = u.x * oneMinusCosMax;  // 1 - cos
    const float r = std::sqrt(std::max(0.0f, height * (2 - height)));
    const SinCos phi = sinCosTurns(u.y);
    return {r * phi.cosine, r * phi.sine, 1 - height};
}

Vec2 sampleTriangle(Vec2 u) {
    if (u.y > u.x) {
        u.x *= 0.5f;
        u.y -= u.x;
    } else {
        u.y *= 0.5f;
        u.x -= u.y;
    }
    return u;
}

Vec3 directionFromLatLong(Vec2 uv) {
    const SinCos phi = sinCosTurns(uv.x - 0.5f), theta = sinCosTurns(0.5f * uv.y);
    return {theta.sine * phi.sine, theta.cosine, -theta.sine * phi.cosine};
}

Vec2 latLongFromDirection(const Vec3& d) {
    const float theta = std::acos(std::clamp(d.y, -1.0f, 1.0f));
    const float phi = std::atan2(d.x, -d.z);
    float u = phi * (0.5f * kInvPi) + 0.5f;
    if (u >= 1) u -= 1;
    return {u, theta * kInvPi};
}

}  // namespace lumi
