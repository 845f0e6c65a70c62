#pragma once
#include <cstdint>

#include "base/isa.h"

namespace lumi {

/// Eight lights or groups of lights, a column each: what bounds where they are and where they shine to.
struct alignas(64) LightTreeNode {
    static constexpr int kWidth = 8;
    static constexpr uint32_t kLight = 1u << 31;        ///< marks a child that is a light
    float x[kWidth], y[kWidth], z[kWidth];              ///< centre of a sphere around them, metres
    float radius[kWidth];                               ///< of that sphere
    float axisX[kWidth], axisY[kWidth], axisZ[kWidth];  ///< unit: middle of the directions they face
    float cosSpread[kWidth];  ///< of the largest angle between the axis and a direction that one of them faces
    float sinSpread[kWidth];  ///< and the sine
    float cosReach[kWidth];   ///< of the largest angle from there at which it still shines
    float bothSides[kWidth];  ///< 1: they face against the axis as well; else 0
    float intensity[kWidth];  ///< W/sr, luminance; 0: no child
    float far2[kWidth];  ///< squared distance from the centre beyond which the lights below are as one (LightTreeGroup)
    uint32_t child[kWidth];  ///< index of a node, or of a light with kLight
};

/// The lights below a child that is a node: seen from far enough they are as one, and one of them is drawn by
/// intensity.
struct LightTreeGroup {
    uint32_t begin = 0, end = 0;  ///< in the order of the tree
    double before = 0;            ///< intensity of all lights before them
    double intensity = 0;         ///< of all of them
};

/// A light in the order of the tree, in which every subtree's are neighbours.
struct LightTreeRank {
    double before = 0;  ///< intensity of all lights before it
    uint32_t light = 0;
};

/// The way from the root to a light, and all else that its probability asks of it.
struct alignas(16) LightTreeWay {
    static constexpr uint32_t kBits = 3, kMost = 63 / kBits;
    static constexpr uint64_t kEnd = 1;
    /// kBits a node, the root's last, kEnd above them; 0: no way leads there, it has no intensity
    uint64_t columns = 0;
    double intensity = 0;  ///< as it is drawn from a group
};

/// A tree as the kernels read it.
struct LightTreeView {
    const LightTreeNode* nodes = nullptr;    ///< the root first
    const LightTreeGroup* groups = nullptr;  ///< of each place
    const LightTreeRank* ranks = nullptr;    ///< and one more, behind the last light
    static constexpr int kFew = 4;
    int few = 0;  ///< places of the root, if all its children are lights and there are no more than kFew; else 0
};

/// What receives light: a point, and which way it faces.
struct LightTreePoint {
    float x = 0, y = 0, z = 0;
    float normalX = 0, normalY = 0, normalZ = 0;
    int facing = 0;  ///< 0 any way, 1 along the normal, 2 along it and against it
};

/// Points that face alike, a column a number.
struct LightTreePoints {
    const float *x, *y, *z;
    const float *normalX, *normalY, *normalZ;
    int facing = 0;
};

struct LightTreeChoice {
    uint32_t light = ~0u;    ///< ~0: none of the tree
    bool elsewhere = false;  ///< the choice fell on what is not in the tree
    float probability = 0;   ///< of the light, or of elsewhere
    float u = 0;             ///< elsewhere: what is left of the random number
};

/// Choice of a light by its importance to a point: intensity times bounds of both cosines over squared distance, which
/// is about the irradiance it causes (W/m^2, nothing blocked) [Conty Estevez & Kulla 2018, "Importance Sampling of Many
/// Lights with Adaptive Tree Splitting", section 5.3]. `elsewhere` is the same for what is not in the tree; each of the
/// two keeps a tenth of the choice, since neither knows what blocks it. A place is node * kWidth + column.
struct LightTreeKernels {
    /// Draws a light for each of `count` points, by two random numbers for each. Points walk down together, a node a
    /// round, so that one's arithmetic and memory are not waited for by the next.
    void (*pick)(const LightTreeView& tree, const LightTreePoints& points, const float* elsewhere, const float* u,
                 const float* v, LightTreeChoice* out, int count);
    /// Probability of the light at the end of `way`.
    float (*probability)(const LightTreeView& tree, const LightTreePoint& point, float elsewhere,
                         const LightTreeWay& way);
    /// Probability that the choice falls on the tree at all.
    float (*share)(const LightTreeView& tree, const LightTreePoint& point, float elsewhere);
};

LUMI_KERNELS(LightTreeKernels, lightTree)

}  // namespace lumi
