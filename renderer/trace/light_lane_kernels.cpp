// Light samples, many lanes at a time; formulas are those of Lights::samplePoint() and EnvironmentLight::sample().
#include "trace/light_lanes.h"

#include "trace/plain_lane_steps.h"

namespace lumi::LUMI_ISA {
namespace {

constexpr float kInfinite = __builtin_huge_valf();

LUMI_LANE void put(PlainLanes::Column3& c, int i, bool mine, Lane3 v) {
    const Lane3 kept = choose(mine, v, at(c, i));
    c.x[i] = kept.x, c.y[i] = kept.y, c.z[i] = kept.z;
}
LUMI_LANE void put(PlainLanes::Column& c, int i, bool mine, float v) { c[i] = mine ? v : c[i]; }

void weighSun(const SunCone& sun, const PlainLanes& lanes, float* __restrict weights) {
    const SunCone s = sun;
    const int count = lanes.count;
#pragma GCC ivdep
    for (int i = 0; i < count; ++i) {
        const float middle = dot(at(lanes.geometricNormal, i), {s.x, s.y, s.z});
        const float sine = std::sqrt(most(0.0f, 1 - square(middle)));
        const float cosine = middle < s.cosHalf ? middle * s.cosHalf + sine * s.sinHalf : middle;
        weights[i] = s.irradiance * most(cosine, 0.0f);
    }
}

void weighSky(const SkyCube& sky, const PlainLanes& lanes, float* __restrict weights) {
    const SkyCube s = sky;
    const int count = lanes.count;
#pragma GCC ivdep
    for (int i = 0; i < count; ++i) {
        const Lane3 n = at(lanes.geometricNormal, i);
        const float x = s.cosine * n.x - s.sine * n.z, z = s.sine * n.x + s.cosine * n.z;
        const float sum = square(x) * (x < 0 ? s.side[1] : s.side[0]) +
                          square(n.y) * (n.y < 0 ? s.side[3] : s.side[2]) + square(z) * (z < 0 ? s.side[5] : s.side[4]);
        weights[i] = most(sum, s.least);
    }
}

struct Sample {
    Lane3 direction, target, radiance, position;
    float distance, pdf, weighs;
};

LUMI_LANE void putSample(LightLanes& lights, PlainLanes& lanes, int i, bool mine, const Sample& s) {
    const float pdf = s.pdf * lights.chance[i];
    put(lanes.lightPdf, i, mine, pdf > 0 && mostOf(s.radiance) > 0 ? pdf : 0.0f);
    put(lanes.lightDirection, i, mine, s.direction);
    put(lanes.lightTarget, i, mine, s.target);
    put(lanes.lightRadiance, i, mine, s.radiance);
    put(lanes.lightDistance, i, mine, s.distance);
    put(lanes.lightWeighs, i, mine, s.weighs);
    put(lights.position, i, mine, s.position);
}

void triangles(LightLanes& lights, PlainLanes& lanes) {
    const int count = lanes.count;
#pragma GCC ivdep
    for (int i = 0; i < count; ++i) {
        const bool mine = lights.kind[i] == LightLanes::kTriangle;
        // Uniform in area, as sampleTriangle().
        const float u = lanes.lightPointX[i], v = lanes.lightPointY[i], half = 0.5f * least(u, v);
        const bool upper = v > u;
        const float b1 = upper ? half : u - half, b2 = upper ? v - half : half;
        const Lane3 edge1 = at(lights.second, i), edge2 = at(lights.third, i);
        Sample s;
        s.position = at(lights.first, i) + edge1 * b1 + edge2 * b2;
        const Lane3 towards = s.position - at(lanes.position, i), product = cross(edge1, edge2);
        const float distance2 = dot(towards, towards), twiceArea = std::sqrt(dot(product, product));
        const bool some = (distance2 > 0) & (twiceArea > 0);
        s.distance = std::sqrt(distance2);
        s.direction = towards * (1 / (some ? s.distance : 1.0f));
        const Lane3 normal = product * (1 / (some ? twiceArea : 1.0f));
        const float cosine = -dot(normal, s.direction), side = lights.side[i];
        const bool faces = some & (cosine != 0) & ((side == 0) | (cosine * side > 0));
        const float slant = 0.5f * twiceArea * std::fabs(cosine);
        s.pdf = faces ? distance2 / (faces ? slant : 1.0f) : 0.0f;
        s.radiance = at(lights.value, i);
        s.target = offsetStart(s.position, normal * (cosine > 0 ? 1.0f : -1.0f), lights.offset[i]);
        s.weighs = 1;
        putSample(lights, lanes, i, mine, s);
    }
}

void points(LightLanes& lights, PlainLanes& lanes) {
    const int count = lanes.count;
#pragma GCC ivdep
    for (int i = 0; i < count; ++i) {
        const bool mine = lights.kind[i] == LightLanes::kPoint;
        Sample s;
        s.position = s.target = at(lights.first, i);
        const Lane3 towards = s.position - at(lanes.position, i), shape = at(lights.third, i);
        const float distance2 = dot(towards, towards);
        const bool some = distance2 > 0;
        s.distance = std::sqrt(distance2);
        s.direction = towards * (1 / (some ? s.distance : 1.0f));
        const float spot = within(-dot(at(lights.second, i), s.direction) * shape.y + shape.z, 0.0f, 1.0f);
        const float reach = s.distance / shape.x;  // 0 of those without a range
        const float window = within(1 - square(square(reach)), 0.0f, 1.0f);
        s.radiance = at(lights.value, i) * (square(spot) * window / (some ? distance2 : 1.0f));
        s.pdf = some ? 1.0f : 0.0f;
        s.weighs = 0;
        putSample(lights, lanes, i, mine, s);
    }
}

void suns(LightLanes& lights, PlainLanes& lanes) {
    const int count = lanes.count;
#pragma GCC ivdep
    for (int i = 0; i < count; ++i) {
        const bool mine = lights.kind[i] == LightLanes::kSun;
        const Lane3 middle = at(lights.first, i);
        const float oneMinusCos = lights.second.x[i];
        const bool wide = oneMinusCos > 0;
        // Uniform in the cone, as sampleCone().
        const float height = lanes.lightPointX[i] * oneMinusCos;
        const float r = std::sqrt(most(0.0f, height * (2 - height)));
        const SinCos phi = sinCosTurns(lanes.lightPointY[i]);
        const Lane3 inCone = unit(toWorld(frameAround(middle), {r * phi.cosine, r * phi.sine, 1 - height}));
        Sample s;
        s.direction = s.position = choose(wide, inCone, middle);
        s.target = {0, 0, 0};
        s.radiance = at(lights.value, i);
        s.distance = kInfinite;
        s.pdf = wide ? 1 / (2 * kLanePi * (wide ? oneMinusCos : 1.0f)) : 1.0f;
        s.weighs = wide ? 1.0f : 0.0f;
        putSample(lights, lanes, i, mine, s);
    }
}

LUMI_LANE float partOf(float x, float low, float high) {
    const float size = high - low;
    return size > 0 ? within((x - low) / (size > 0 ? size : 1.0f), 0.0f, kBelowOne) : 0.5f;
}

void sky(const SkyGrid& grid, LightLanes& lights, PlainLanes& lanes) {
    const SkyGrid g = grid;
    const int count = lanes.count;
#pragma GCC ivdep
    for (int i = 0; i < count; ++i) {
        const bool mine = lights.kind[i] == LightLanes::kSky;
        const float x0 = lights.second.x[i], x1 = lights.second.y[i], y0 = lights.third.x[i], y1 = lights.third.y[i];
        const float u = (lights.first.x[i] + partOf(lanes.lightPointX[i], x0, x1)) / g.columns;
        const float v = (lights.first.y[i] + partOf(lanes.lightPointY[i], y0, y1)) / g.rows;
        const SinCos phi = sinCosTurns(u - 0.5f), theta = sinCosTurns(0.5f * v);
        const float sinPhi = phi.sine, cosPhi = phi.cosine, sinTheta = theta.sine, cosTheta = theta.cosine;
        const float density = (y1 - y0) * (x1 - x0) * g.rows * g.columns;
        const float x = sinTheta * sinPhi, z = -sinTheta * cosPhi;
        Sample s;
        s.pdf = sinTheta > 0 ? density / (2 * kLanePi * kLanePi * (sinTheta > 0 ? sinTheta : 1.0f)) : 0.0f;
        s.direction = s.position = {g.cosine * x + g.sine * z, cosTheta, -g.sine * x + g.cosine * z};
        s.target = {0, 0, 0};
        s.radiance = {1, 1, 1};
        s.distance = kInfinite;
        s.weighs = 1;
        putSample(lights, lanes, i, mine, s);
        put(lights.skyU, i, mine, u), put(lights.skyV, i, mine, v);
    }
}

}  // namespace

const LightLaneKernels& lightLaneTable() {
    static const LightLaneKernels table{weighSun, weighSky, triangles, points, suns, sky};
    return table;
}

}  // namespace lumi::LUMI_ISA
