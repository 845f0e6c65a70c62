#pragma once
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

namespace lumi {

using Vec2 = glm::vec2;
using Vec3 = glm::vec3;
using Vec4 = glm::vec4;
using UVec3 = glm::uvec3;
using UVec4 = glm::uvec4;
using Mat3 = glm::mat3;
using Mat4 = glm::mat4;
using Quat = glm::quat;  ///< constructed (w, x, y, z)

constexpr float kPi = 3.14159265358979323846f;
constexpr float kInvPi = 0.31830988618379067154f;
constexpr float kInfinity = __builtin_huge_valf();

inline float sqr(float x) { return x * x; }
/// Clamped to [0, 1]; NaN becomes 0.
inline float saturate(float x) { return x > 0 ? (x < 1 ? x : 1.0f) : 0.0f; }
inline Vec3 saturate(const Vec3& v) { return {saturate(v.x), saturate(v.y), saturate(v.z)}; }
inline float maxComponent(const Vec3& v) { return glm::max(v.x, glm::max(v.y, v.z)); }
inline float minComponent(const Vec3& v) { return glm::min(v.x, glm::min(v.y, v.z)); }
inline float average(const Vec3& v) { return (v.x + v.y + v.z) * (1.0f / 3.0f); }
inline bool isBlack(const Vec3& v) { return v.x == 0 && v.y == 0 && v.z == 0; }
inline bool isFinite(const Vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }
/// Rec.709 luminance of a linear colour.
inline float luminance(const Vec3& c) { return 0.2126f * c.x + 0.7152f * c.y + 0.0722f * c.z; }
inline float radians(float degrees) { return degrees * (kPi / 180.0f); }
inline float degrees(float radians_) { return radians_ * (180.0f / kPi); }

/// Width and height in pixels.
struct Extent2 {
    int width = 0, height = 0;
    bool operator==(const Extent2&) const = default;
    int64_t area() const { return int64_t(width) * height; }
    bool empty() const { return width <= 0 || height <= 0; }
};

/// A pixel, top-left origin.
struct Pixel {
    int x = 0, y = 0;
    bool operator==(const Pixel&) const = default;
};

/// Axis-aligned box; empty when constructed.
struct Bounds3 {
    Vec3 lower{kInfinity}, upper{-kInfinity};
    void extend(const Vec3& p) { lower = glm::min(lower, p), upper = glm::max(upper, p); }
    void extend(const Bounds3& b) { lower = glm::min(lower, b.lower), upper = glm::max(upper, b.upper); }
    bool empty() const { return lower.x > upper.x; }
    Vec3 centre() const { return 0.5f * (lower + upper); }
    Vec3 size() const { return empty() ? Vec3(0) : upper - lower; }
    float radius() const { return 0.5f * glm::length(size()); }
};

}  // namespace lumi
