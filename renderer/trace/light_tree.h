#pragma once
#include <span>
#include <stop_token>
#include <vector>

#include "trace/light_bounds.h"
#include "trace/light_tree_kernels.h"

namespace lumi {

/// A tree over lights at finite places, from which one is drawn by its importance to a point [Conty Estevez & Kulla
/// 2018]: built top-down by the surface area orientation heuristic (section 4.4) over bins. Differs from the paper:
/// nodes have eight children, compared with each other at once, so that the walk down is short and lights that cannot
/// reach the point are left out early; far groups of lights that face alike end it, drawn from by intensity alone; no
/// splitting into several lights.
class LightTree {
public:
    /// Light i of the tree is bounds[i]. Keeps what it has if the bounds are those of the last build. Throws
    /// Error(Interrupted) once stopped; the tree is empty then.
    void build(std::vector<LightBounds> bounds, const std::stop_token& stop = {});

    bool empty() const { return nodes_.empty(); }
    /// Draws a light for each point by u and v in [0, 1), or what is elsewhere; see LightTreeKernels.
    void pick(const LightTreePoints& points, const float* elsewhere, const float* u, const float* v,
              LightTreeChoice* choices, int count) const {
        kernels_->pick(view(), points, elsewhere, u, v, choices, count);
    }
    LightTreeChoice pick(const LightTreePoint& p, float elsewhere, Vec2 u) const {
        LightTreeChoice choice;
        pick({&p.x, &p.y, &p.z, &p.normalX, &p.normalY, &p.normalZ, p.facing}, &elsewhere, &u.x, &u.y, &choice, 1);
        return choice;
    }
    /// The probability with which pick() draws `light`.
    float probability(const LightTreePoint& point, float elsewhere, uint32_t light) const {
        return kernels_->probability(view(), point, elsewhere, ways_[light]);
    }
    /// Asks for what probability() of `light` reads first.
    void prefetch(uint32_t light) const { __builtin_prefetch(&ways_[light]); }
    /// The probability with which pick() draws any light of the tree.
    float share(const LightTreePoint& point, float elsewhere) const {
        return kernels_->share(view(), point, elsewhere);
    }
    size_t byteCount() const;

private:
    LightTreeView view() const { return {nodes_.data(), groups_.data(), ranks_.data(), few_}; }
    void rankLights(std::span<const LightBounds> lights, std::span<const uint32_t> order);
    void findWays();
    void findGroups();
    void findFew();

    const LightTreeKernels* kernels_ = nullptr;
    std::vector<LightTreeNode> nodes_;
    std::vector<LightTreeWay> ways_;      ///< to each light
    std::vector<LightTreeGroup> groups_;  ///< of each place
    std::vector<LightTreeRank> ranks_;
    int few_ = 0;          ///< as LightTreeView's
    uint64_t digest_ = 0;  ///< of the bounds
};

}  // namespace lumi
