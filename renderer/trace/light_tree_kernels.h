#pragma once
#include <cstdint>

namespace lumi {

/// Eight lights or groups of lights, a column each: what bounds where they are and where they shine to.
struct alignas(64) LightTreeNode {
    static constexpr int kWidth = 8;
    static constexpr uint32_t kLight = 1u << 31;  ///< marks a child that is a light
    float x[kWidth], y[kWidth], z[kWidth];        ///< centre of a sphere around them, metres
    float radius[kWidth];                         ///< of that sphere
    float axisX[kWidth], axisY[kWidth], axisZ[kWidth];  ///< unit: middle of the directions they face
    float cosSpread[kWidth];  ///< of the largest angle between the axis and a direction that one of them faces
    float cosReach[kWidth];   ///< of the largest angle from there at which it still shines
    float bothSides[kWidth];  ///< 1: they face against the axis as well; else 0
    float intensity[kWidth];  ///< W/sr, luminance; 0: no child
    uint32_t child[kWidth];   ///< index of a node, or of a light with kLight
};

/// What receives light: a point, and which way it faces.
struct LightTreePoint {
    float x = 0, y = 0, z = 0;
    float normalX = 0, normalY = 0, normalZ = 0;
    int facing = 0;  ///< 0 any way, 1 along the normal, 2 along it and against it
};

struct LightTreeChoice {
    uint32_t light = ~0u;     ///< ~0: none of the tree
    bool elsewhere = false;   ///< the choice fell on what is not in the tree
    float probability = 0;    ///< of the light, or of elsewhere
    float u = 0;              ///< what is left of the random number
};

/// Choice of a light by its importance to a point: intensity times bounds of both cosines over squared distance, which
/// is about the irradiance it causes (W/m^2, nothing blocked) [Conty Estevez & Kulla 2018, "Importance Sampling of Many
/// Lights with Adaptive Tree Splitting", section 5.3]. `elsewhere` is the same for what is not in the tree; each of the two
/// keeps a tenth of the choice, since neither knows what blocks it.
/// Nodes are in one array, the root first. A light's place is node * kWidth + column.
struct LightTreeKernels {
    void (*pick)(const LightTreeNode* nodes, const LightTreePoint& point, float elsewhere, float u, float v,
                 LightTreeChoice& out);
    /// Probability of the light at `place`; `parents` holds the place of each node, ~0 for the root.
    float (*probability)(const LightTreeNode* nodes, const uint32_t* parents, const LightTreePoint& point,
                         float elsewhere, uint32_t place);
    /// Probability that the choice falls on the tree at all.
    float (*share)(const LightTreeNode* nodes, const LightTreePoint& point, float elsewhere);
};

const LightTreeKernels& lightTreeKernels();

namespace baseline {
const LightTreeKernels& lightTreeTable();
}
namespace v3 {
const LightTreeKernels& lightTreeTable();
}
namespace v4 {
const LightTreeKernels& lightTreeTable();
}

}  // namespace lumi
