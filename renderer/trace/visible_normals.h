#pragma once
#include <array>
#include <cmath>

#include "trace/ggx.h"

namespace lumi {

/// The Fibonacci lattice of `Count` points; the next smaller Fibonacci number is `Step`. Heights crowd at the far end,
/// where reflected light grazes and integrands fall steeply; `weight` makes up for it. `HalfTurns` 1 leaves out the
/// half that isotropic facets seen from the x-z plane mirror.
template <int Count, int Step, int HalfTurns = 2>
struct FibonacciLattice {
    struct Point {
        float height, cosAzimuth, sinAzimuth, weight;
    };
    std::array<Point, Count> points;

    FibonacciLattice() {
        for (int i = 0; i < Count; ++i) {
            const float t = 1 - (static_cast<float>(i) + 0.5f) / Count;
            const float azimuth =
                HalfTurns * kPi * (static_cast<float>(i * Step % Count) + (HalfTurns == 1 ? 0.5f : 0.0f)) / Count;
            points[static_cast<size_t>(i)] = {1 - t * t, std::cos(azimuth), std::sin(azimuth), 2 * t / Count};
        }
    }
};

/// Mean of value(h) over the facet normals that `wo` sees, by a lattice in the square that
/// Ggx::sampleVisibleNormal() maps: integrands have kinks along curves, and no two points of a lattice share a height.
template <class Points, class Value>
auto meanOverVisibleNormals(const Ggx& ggx, const Vec3& wo, const Value& value) {
    static const Points lattice;
    const Vec3 stretched = ggx.stretched(wo);
    decltype(value(wo)) sum(0);
    for (const auto& point : lattice.points)
        sum += point.weight * value(ggx.visibleNormal(stretched, point.height, point.cosAzimuth, point.sinAzimuth));
    return sum;
}

/// Masking of the far direction given the near one: what reflection by facet h keeps.
inline float reflectedShare(const Ggx& ggx, const Vec3& wo, float lambdaO, const Vec3& h) {
    const Vec3 wi = 2 * glm::dot(wo, h) * h - wo;
    if (wi.z <= 0) return 0;
    return (1 + lambdaO) * maskingShadowing(lambdaO, ggx.lambda(wi));
}

}  // namespace lumi
