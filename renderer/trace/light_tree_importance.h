#pragma once
#include <cmath>

#include "trace/lane_math.h"
#include "trace/light_tree_kernels.h"

/// What children of a LightTreeNode are worth to points. Include only from kernel files: everything here has internal
/// linkage, each instruction set compiles its own copy.
namespace lumi {
namespace {

constexpr float kLeastShare = 0.1f;

/// What bounds one child.
struct Child {
    float x, y, z, radius, axisX, axisY, axisZ, cosSpread, sinSpread, cosReach, bothSides, intensity;
};
LUMI_LANE Child childAt(const LightTreeNode& n, int i) {
    return {n.x[i],     n.y[i],         n.z[i],         n.radius[i],   n.axisX[i],     n.axisY[i],
            n.axisZ[i], n.cosSpread[i], n.sinSpread[i], n.cosReach[i], n.bothSides[i], n.intensity[i]};
}

/// Angles are kept as sine and cosine: cos(max(0, a - b)) is cos a cos b + sin a sin b, or 1 where a <= b.
LUMI_LANE float importanceOf(const Child& c, const LightTreePoint& p) {
    // From the centre to the point; the sphere's half-angle as seen from there.
    const float dx = p.x - c.x, dy = p.y - c.y, dz = p.z - c.z;
    const float distance2 = dx * dx + dy * dy + dz * dz;
    const float radius2 = c.radius * c.radius;
    const bool inside = distance2 <= radius2;
    // Directions from inside do not matter, and it is never nearer than the sphere.
    const float nearest2 = inside ? radius2 : distance2;
    const float inverse = 1.0f / std::sqrt(nearest2 > 1e-30f ? nearest2 : 1e-30f);
    const float sinBall = c.radius * inverse;
    const float cosBall = std::sqrt(most(1 - sinBall * sinBall, 0.0f));

    // Between what a light faces and the direction to the point: the least that it can be.
    const float along = (c.axisX * dx + c.axisY * dy + c.axisZ * dz) * inverse;
    const float cosAxis = c.bothSides > 0 ? std::fabs(along) : along;
    const float sinAxis = std::sqrt(most(1 - cosAxis * cosAxis, 0.0f));
    const bool faced = cosAxis >= c.cosSpread;
    const float cosRest = faced ? 1.0f : cosAxis * c.cosSpread + sinAxis * c.sinSpread;
    const float sinRest = faced ? 0.0f : sinAxis * c.cosSpread - cosAxis * c.sinSpread;
    const float cosLeaving = inside || cosRest >= cosBall ? 1.0f : cosRest * cosBall + most(sinRest, 0.0f) * sinBall;

    // Between the point's normal and the direction to a light: the least that it can be.
    const float toLight = -(p.normalX * dx + p.normalY * dy + p.normalZ * dz) * inverse;
    const float cosNormal = p.facing == 2 ? std::fabs(toLight) : toLight;
    const float sinNormal = std::sqrt(most(1 - cosNormal * cosNormal, 0.0f));
    const float bounded = cosNormal >= cosBall ? 1.0f : cosNormal * cosBall + sinNormal * sinBall;
    const float cosArriving = inside || p.facing == 0 ? 1.0f : most(bounded, 0.0f);

    const float value = c.intensity * cosLeaving * cosArriving * (inverse * inverse);
    return cosLeaving > c.cosReach && c.intensity > 0 ? value : 0.0f;
}

/// Of a node's children to one point.
LUMI_LANE void weigh(const LightTreeNode& node, const LightTreePoint& p, float* __restrict weights) {
    for (int i = 0; i < LightTreeNode::kWidth; ++i) weights[i] = importanceOf(childAt(node, i), p);
}

LUMI_LANE float sumOf(float a, float b, float c, float d, float e, float f, float g, float h) {
    return ((a + b) + (c + d)) + ((e + f) + (g + h));
}
inline float sumOf(const float* v) { return sumOf(v[0], v[1], v[2], v[3], v[4], v[5], v[6], v[7]); }

/// Share of the tree in the choice, by what it weighs beside the rest.
LUMI_LANE float shareOf(float tree, float elsewhere) {
    if (!(tree > 0)) return 0;
    if (!(elsewhere > 0)) return 1;
    return within(tree / (tree + elsewhere), kLeastShare, 1 - kLeastShare);
}

}  // namespace
}  // namespace lumi
