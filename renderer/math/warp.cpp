#include "math/warp.h"

#include <algorithm>
#include <cmath>

namespace lumi {

Vec2 sampleDisk(Vec2 u) {
    const Vec2 s = 2.0f * u - Vec2(1);
    if (s.x == 0 && s.y == 0) return Vec2(0);
    const bool wide = std::abs(s.x) > std::abs(s.y);
    const float radius = wide ? s.x : s.y;
    const float angle = wide ? (kPi / 4) * (s.y / s.x) : kPi / 2 - (kPi / 4) * (s.x / s.y);
    return radius * Vec2(std::cos(angle), std::sin(angle));
}

Vec3 sampleCosineHemisphere(Vec2 u) {
    const Vec2 d = sampleDisk(u);
    return {d.x, d.y, std::sqrt(std::max(0.0f, 1 - d.x * d.x - d.y * d.y))};
}

Vec3 sampleSphere(Vec2 u) {
    const float z = 1 - 2 * u.x;
    const float r = std::sqrt(std::max(0.0f, 1 - z * z));
    const float phi = 2 * kPi * u.y;
    return {r * std::cos(phi), r * std::sin(phi), z};
}

Vec3 sampleCone(Vec2 u, float oneMinusCosMax) {
    const float height = u.x * oneMinusCosMax;  // 1 - cos
    const float r = std::sqrt(std::max(0.0f, height * (2 - height)));
    const float phi = 2 * kPi * u.y;
    return {r * std::cos(phi), r * std::sin(phi), 1 - height};
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
    const float phi = (uv.x - 0.5f) * 2 * kPi;
    const float theta = uv.y * kPi;
    const float s = std::sin(theta);
    return {s * std::sin(phi), std::cos(theta), -s * std::cos(phi)};
}

Vec2 latLongFromDirection(const Vec3& d) {
    const float theta = std::acos(std::clamp(d.y, -1.0f, 1.0f));
    const float phi = std::atan2(d.x, -d.z);
    float u = phi * (0.5f * kInvPi) + 0.5f;
    if (u >= 1) u -= 1;
    return {u, theta * kInvPi};
}

}  // namespace lumi
