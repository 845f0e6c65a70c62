#pragma once
#include <cmath>
#include <cstdint>

namespace lumi {
namespace {

/// Largest integer not above `v`, |v| < 2^24.
[[maybe_unused, gnu::always_inline]] inline int32_t wholeBelow(float v) {
    const int32_t whole = static_cast<int32_t>(v);
    return whole - (v < static_cast<float>(whole) ? 1 : 0);
}

/// `v`, or the whole number that it is near: coordinates in the previous frame, in pixels, carry the rounding of two
/// projections and of a sum, up to some 2e-4 where nothing moves. What stood still is read from where it stood.
[[maybe_unused, gnu::always_inline]] inline float wholePixel(float v) {
    constexpr float kRounding = 1.0f / 2048;
    const float nearest = static_cast<float>(wholeBelow(v + 0.5f));
    return std::fabs(v - nearest) < kRounding ? nearest : v;
}

}  // namespace
}  // namespace lumi
