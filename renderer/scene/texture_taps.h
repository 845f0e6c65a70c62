#pragma once
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "scene/texture.h"

/// How a texture coordinate becomes texels, shared by all that read textures. Any coordinate is safe, NaN and infinity
/// included: the texels lie in the image, whatever the weight.
namespace lumi {

/// std::floor() without a call on machines that have no instruction for it.
inline float floorOf(float x) {
    if (!(std::abs(x) < 0x1p23f)) return x;  // whole already, or no number
    const float whole = static_cast<float>(static_cast<int>(x));
    return whole - (x < whole ? 1.0f : 0.0f);
}

/// `coordinate` brought into [0, 1] as the wrap mode says.
inline float wrapUnit(float coordinate, Wrap wrap) {
    if (wrap == Wrap::Repeat) return coordinate - floorOf(coordinate);
    if (wrap == Wrap::ClampToEdge) return std::clamp(coordinate, 0.0f, 1.0f);
    const float t = coordinate - 2 * floorOf(0.5f * coordinate);
    return t > 1 ? 2 - t : t;
}

inline int nearestTexel(float coordinate, int count, Wrap wrap) {
    return std::clamp(static_cast<int>(wrapUnit(coordinate, wrap) * static_cast<float>(count)), 0, count - 1);
}

/// Two texels along one axis, and the share of the second.
struct AxisTap {
    int first = 0, second = 0;
    float weight = 0;
};

[[gnu::always_inline]] inline AxisTap linearTap(float coordinate, int count, Wrap wrap) {
    const float x = wrapUnit(coordinate, wrap) * static_cast<float>(count) - 0.5f;
    const float floored = floorOf(x);
    const int whole = static_cast<int>(floored);
    AxisTap tap{whole, whole + 1, x - floored};
    if (wrap == Wrap::Repeat) {
        const auto outside = [count](int texel) {
            return static_cast<unsigned>(texel) >= static_cast<unsigned>(count);
        };
        if (outside(tap.first)) tap.first = count - 1;
        if (outside(tap.second)) tap.second = 0;
    } else {
        tap.first = std::clamp(tap.first, 0, count - 1);
        tap.second = std::clamp(tap.second, 0, count - 1);
    }
    return tap;
}

/// Base-2 logarithm of a positive float, exact at powers of two and linear between them (at most 0.086 too small):
/// continuous and monotonic, which is all that a choice of mip level needs.
inline float coarseLog2(float x) {
    const uint32_t bits = std::bit_cast<uint32_t>(x);
    return static_cast<float>(static_cast<int>(bits >> 23) - 127) + static_cast<float>(bits & 0x7fffffu) * 0x1p-23f;
}

}  // namespace lumi
