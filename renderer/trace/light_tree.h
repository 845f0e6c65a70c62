#pragma once
#include <span>
#include <vector>

#include "math/vector.h"
#include "trace/light_tree_kernels.h"

namespace lumi {

/// Bounds of where lights are and where they shine to. Directions that a light faces lie within `cosSpread` of the axis (and
/// of its opposite if `bothSides`), and it shines up to `cosReach` from each of them: a sphere has spread -1 and reach
/// 0, a triangle 1 and 0, a spot 1 and the cosine of its cone.
struct LightBounds {
    Bounds3 box;
    Vec3 axis{0, 0, 1};
    float cosSpread = 1, cosReach = 0;
    bool bothSides = false;
    float intensity = 0;  ///< W/sr, luminance, where it shines most
};

/// The bounds of both.
LightBounds unite(const LightBounds& a, const LightBounds& b);

/// A tree over lights at finite places, from which one is drawn by its importance to a point
/// [Conty Estevez & Kulla 2018]: built top-down by the surface area orientation heuristic (section 4.4) over bins.
/// Differs from the paper: nodes have eight children, compared with each other at once, so that the walk down is short
/// and lights that cannot reach the point are left out early; far groups of lights that face alike end it, drawn from by
/// intensity alone; no splitting into several lights.
class LightTree {
public:
    /// Light i of the tree is bounds[i]. Keeps what it has if the bounds are those of the last build.
    void build(std::span<const LightBounds> bounds);

    bool empty() const { return nodes_.empty(); }
    /// Draws a light for each point by u and v in [0, 1), or what is elsewhere; see LightTreeKernels.
    void pick(const LightTreePoint* points, const float* elsewhere, const float* u, const float* v,
              LightTreeChoice* choices, int count) const {
        kernels_->pick(view(), points, elsewhere, u, v, choices, count);
    }
    LightTreeChoice pick(const LightTreePoint& point, float elsewhere, Vec2 u) const {
        LightTreeChoice choice;
        pick(&point, &elsewhere, &u.x, &u.y, &choice, 1);
        return choice;
    }
    /// The probability with which pick() draws `light`.
    float probability(const LightTreePoint& point, float elsewhere, uint32_t light) const {
        const uint32_t place = places_[light];
        return place == ~0u ? 0 : kernels_->probability(view(), point, elsewhere, place, ranks_[light]);
    }
    /// The probability with which pick() draws any light of the tree.
    float share(const LightTreePoint& point, float elsewhere) const {
        return kernels_->share(view(), point, elsewhere);
    }
    size_t byteCount() const;

private:
    LightTreeView view() const {
        return {nodes_.data(), parents_.data(), groups_.data(), order_.data(), intensityBefore_.data()};
    }
    void placeLights(std::span<const LightBounds> lights);

    const LightTreeKernels* kernels_ = nullptr;
    std::vector<LightTreeNode> nodes_;
    std::vector<uint32_t> parents_;  ///< place of each node in its parent
    std::vector<uint32_t> places_;   ///< of each light; ~0 for those without intensity
    std::vector<LightTreeGroup> groups_;   ///< of each place
    std::vector<uint32_t> order_, ranks_;  ///< lights in the tree's order, and where each stands in it
    std::vector<double> intensityBefore_;
    uint64_t digest_ = 0;            ///< of the bounds
};

}  // namespace lumi
