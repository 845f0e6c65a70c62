// Plain surfaces that only scatter diffusely, where the specular terms of plain_kernels.cpp are all zero: the same
// bits.
#include "trace/plain_kernels.h"
#include "trace/plain_lane_steps.h"

namespace lumi::LUMI_ISA {
namespace {

void prepare(PlainLanes& lanes, const AlbedoView&, const PlainSettings&) {
    const int count = lanes.count;
#pragma GCC ivdep
    for (int i = 0; i < count; ++i) {
        const LaneFrame frame = frameAround(at(lanes.normal, i));
        put(lanes.axisX, i, frame.x), put(lanes.axisY, i, frame.y);
        putStart(lanes, i);
        const float opaque = 1 - saturated(lanes.metallic[i]);
        const bool mayDiffuse = (lanes.lobes[i] & PlainLanes::kDiffuseLobe) != 0;
        const Lane3 colour = at(lanes.baseColor, i);
        const Lane3 base = {saturated(colour.x), saturated(colour.y), saturated(colour.z)};
        const Lane3 albedo = base * opaque, diffuse = albedo * (mayDiffuse ? 1.0f : 0.0f);
        put(lanes.diffuseAlbedo, i, albedo), put(lanes.specularAlbedo, i, {0, 0, 0});
        put(lanes.diffuseScale, i, diffuse * kLaneInvPi);
        lanes.diffuseProbability[i] = brightness(diffuse) > 0 ? 1.0f : 0.0f;
    }
}

/// f cos of a direction at the cosine `z` >= 0 to the shading normal, and its density.
struct Diffuse {
    Lane3 scattered;
    float pdf;
};

LUMI_LANE Diffuse towards(const PlainLanes& lanes, int i, float z) {
    return {at(lanes.diffuseScale, i) * z, lanes.diffuseProbability[i] * (z * kLaneInvPi)};
}

void light(PlainLanes& lanes, const AlbedoView&, const PlainSettings& settings) {
    const bool mis = settings.mis;
    const int count = lanes.count;
#pragma GCC ivdep
    for (int i = 0; i < count; ++i) {
        const float z = dot(at(lanes.lightDirection, i), at(lanes.normal, i));
        const Diffuse f = towards(lanes, i, z > 0 ? z : 0.0f);
        putLight(lanes, i, f.scattered, {0, 0, 0}, f.pdf, z > 0, mis);
    }
}

void scatter(PlainLanes& lanes, const AlbedoView&, const PlainSettings& settings) {
    const bool roulette = settings.roulette;
    const int count = lanes.count;
#pragma GCC ivdep
    for (int i = 0; i < count; ++i) {
        const Lane3 wi = cosineHemisphere(lanes.bsdfX[i], lanes.bsdfY[i]);
        const Diffuse f = towards(lanes, i, wi.z);
        const bool some = f.pdf > 0;
        const Lane3 weight = f.scattered * (1 / (some ? f.pdf : 1.0f));
        const LaneFrame frame = {at(lanes.axisX, i), at(lanes.axisY, i), at(lanes.normal, i)};
        const bool goes = putContinuation(lanes, i, frame, wi, weight, some, roulette);
        lanes.pdf[i] = f.pdf;
        put(lanes.diffuseShare, i, {1, 1, 1});
        lanes.next[i] = goes ? PlainLanes::kDiffuse : PlainLanes::kEnds;
    }
}

}  // namespace

const PlainLobeKernels& plainDiffuseTable() {
    static const PlainLobeKernels table{prepare, light, scatter};
    return table;
}

}  // namespace lumi::LUMI_ISA
