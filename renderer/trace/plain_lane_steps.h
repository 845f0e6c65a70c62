#pragma once
#include "trace/lane_math.h"
#include "trace/plain_lanes.h"

/// Steps that kernels of plain surfaces share. Include only from kernel files: everything here has internal linkage,
/// each instruction set compiles its own copy.
namespace lumi {
namespace {

constexpr float kLeastCosine = 1e-4f, kBelowOne = 0x1.fffffep-1f;

LUMI_LANE Lane3 at(const PlainLanes::Column3& c, int i) { return {c.x[i], c.y[i], c.z[i]}; }
LUMI_LANE void put(PlainLanes::Column3& c, int i, Lane3 v) { c.x[i] = v.x, c.y[i] = v.y, c.z[i] = v.z; }

/// Into [0, 1]; NaN becomes 0.
LUMI_LANE float saturated(float x) { return x > 0 ? least(x, 1.0f) : 0.0f; }

LUMI_LANE void putStart(PlainLanes& lanes, int i) {
    put(lanes.start, i, offsetStart(at(lanes.position, i), at(lanes.geometricNormal, i), lanes.offset[i]));
}

/// What a light sample is worth by what scatters of it (f cos, and the density of that direction), and its shadow ray.
/// `above`: its direction is above the shading plane.
LUMI_LANE void putLight(PlainLanes& lanes, int i, Lane3 diffuseScattered, Lane3 specularScattered, float scatterPdf,
                        bool above, bool mis) {
    const Lane3 direction = at(lanes.lightDirection, i);
    const float side = dot(direction, at(lanes.geometricNormal, i)), pdf = lanes.lightPdf[i];
    // Power heuristic against the continuation that could find the same light.
    const float usable = pdf > 0 ? pdf : 1.0f, ratio = scatterPdf / usable;
    const float weight = (mis && lanes.lightWeighs[i] > 0 ? 1 / (1 + ratio * ratio) : 1.0f) / usable;
    const Lane3 radiance = at(lanes.lightRadiance, i) * weight;
    const Lane3 diffuse = diffuseScattered * radiance, specular = specularScattered * radiance,
                sum = diffuse + specular;
    const Lane3 contribution = sum * at(lanes.throughput, i);
    put(lanes.lightDiffuse, i, diffuse), put(lanes.lightSpecular, i, specular);
    put(lanes.lightContribution, i, contribution);

    const bool black = (sum.x == 0) & (sum.y == 0) & (sum.z == 0);
    const Lane3 segment = at(lanes.lightTarget, i) - at(lanes.start, i);
    const float length = std::sqrt(dot(segment, segment));
    const bool infinite = !finite(lanes.lightDistance[i]), some = infinite | (length > 0);
    const float scale = 1 / (length > 0 ? length : 1.0f);
    put(lanes.shadowDirection, i, choose(infinite, direction, segment * scale));
    lanes.shadowLength[i] = infinite ? lanes.lightDistance[i] : length;
    const bool reaches = (pdf > 0) & (side > 0) & above & !black & some;
    lanes.lightValid[i] = reaches ? (finite(contribution) ? 1.0f : -1.0f) : 0.0f;
}

/// The continuation in local direction `wi`; false if the path ends: nothing scatters there (`some`), the direction is
/// below the surface or its plane, or Russian roulette says so.
LUMI_LANE bool putContinuation(PlainLanes& lanes, int i, const LaneFrame& frame, Lane3 wi, Lane3 weight, bool some,
                               bool roulette) {
    const Lane3 direction = unit(toWorld(frame, wi));
    const float side = dot(direction, at(lanes.geometricNormal, i));
    const bool black = (weight.x == 0) & (weight.y == 0) & (weight.z == 0);
    const float leastSurvival = roulette ? 0.05f : 1.0f, mostSurvival = roulette ? 0.95f : 1.0f;
    const float survival = within(mostOf(at(lanes.throughput, i) * weight), leastSurvival, mostSurvival);
    const bool lives = lanes.rouletteX[i] < survival;
    put(lanes.nextDirection, i, direction), put(lanes.weight, i, weight * (1 / survival));
    return some & (side > 0) & (wi.z > 0) & !black & finite(weight) & lives;
}

}  // namespace
}  // namespace lumi
