#pragma once
#include <cmath>
#include <cstdint>

#include "math/kernel_math.h"
#include "math/sin_cos.h"

/// Arithmetic of one lane for kernels: branch-free, so that loops over lanes vectorise. Include only from kernel files:
/// everything here has internal linkage, each instruction set compiles its own copy.
namespace lumi {
namespace {

#define LUMI_LANE [[maybe_unused, gnu::always_inline]] inline

constexpr float kLanePi = 3.14159265358979323846f, kLaneInvPi = 0.31830988618379067154f;

struct Lane3 {
    float x, y, z;
};
LUMI_LANE Lane3 operator+(Lane3 a, Lane3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
LUMI_LANE Lane3 operator-(Lane3 a, Lane3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
LUMI_LANE Lane3 operator*(Lane3 a, Lane3 b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
LUMI_LANE Lane3 operator*(Lane3 a, float s) { return {a.x * s, a.y * s, a.z * s}; }
LUMI_LANE float dot(Lane3 a, Lane3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
LUMI_LANE Lane3 cross(Lane3 a, Lane3 b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
LUMI_LANE float least(float a, float b) { return b < a ? b : a; }
LUMI_LANE float most(float a, float b) { return a < b ? b : a; }
/// Into [low, high].
LUMI_LANE float within(float x, float low, float high) { return x < low ? low : high < x ? high : x; }
LUMI_LANE float square(float x) { return x * x; }
LUMI_LANE Lane3 choose(bool first, Lane3 a, Lane3 b) {
    return {first ? a.x : b.x, first ? a.y : b.y, first ? a.z : b.z};
}
LUMI_LANE float mostOf(Lane3 v) { return most(v.x, most(v.y, v.z)); }
LUMI_LANE float brightness(Lane3 c) { return 0.2126f * c.x + 0.7152f * c.y + 0.0722f * c.z; }
LUMI_LANE Lane3 unit(Lane3 v) { return v * (1.0f / std::sqrt(dot(v, v))); }
/// Not NaN and not infinite.
LUMI_LANE bool finite(float x) { return std::fabs(x) <= 3.402823466e38f; }
LUMI_LANE bool finite(Lane3 v) { return finite(v.x) & finite(v.y) & finite(v.z); }

/// Orthonormal frame around a unit vector, as lumi::Frame [Duff 2017].
struct LaneFrame {
    Lane3 x, y, z;
};
LUMI_LANE LaneFrame frameAround(Lane3 n) {
    const float sign = std::copysign(1.0f, n.z), a = -1.0f / (sign + n.z), b = n.x * n.y * a;
    return {{1 + sign * n.x * n.x * a, sign * b, -sign * n.x}, {b, sign + n.y * n.y * a, -n.y}, n};
}
LUMI_LANE Lane3 toLocal(const LaneFrame& f, Lane3 v) { return {dot(v, f.x), dot(v, f.y), dot(v, f.z)}; }
LUMI_LANE Lane3 toWorld(const LaneFrame& f, Lane3 v) { return f.x * v.x + f.y * v.y + f.z * v.z; }

/// Directions around +Z in proportion to the cosine, as sampleCosineHemisphere() [Shirley 1997].
LUMI_LANE Lane3 cosineHemisphere(float u, float v) {
    const float a = 2 * u - 1, b = 2 * v - 1;
    const bool wide = std::fabs(a) > std::fabs(b);
    const float radius = wide ? a : b, other = wide ? b : a;
    const float part = 0.125f * (other / (radius == 0 ? 1.0f : radius));
    const SinCos angle = sinCosTurns(wide ? part : 0.25f - part);
    const float x = radius * angle.cosine, y = radius * angle.sine;
    // Below zero by rounding only.
    return {x, y, std::sqrt(std::fabs(1 - x * x - y * y))};
}

/// A start for rays that leave a surface to the side of `normal`, as offsetOrigin() [Waechter & Binder 2019].
LUMI_LANE float offsetCoordinate(float position, float normal, float extra) {
    // Of lanes whose result nobody takes the normal may be anything, and an int is not.
    const int32_t steps = static_cast<int32_t>(least(most(-256.0f, 256.0f * normal), 256.0f));
    const float moved = bitsToFloat(floatToBits(position) + (position < 0 ? -steps : steps));
    const float result = std::fabs(position) < 1.0f / 32 ? position + (1.0f / 65536) * normal : moved;
    return result + normal * extra;
}
LUMI_LANE Lane3 offsetStart(Lane3 position, Lane3 normal, float extra) {
    return {offsetCoordinate(position.x, normal.x, extra), offsetCoordinate(position.y, normal.y, extra),
            offsetCoordinate(position.z, normal.z, extra)};
}

}  // namespace
}  // namespace lumi
