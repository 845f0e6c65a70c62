#pragma once
#include <vector>

#include "math/hash.h"
#include "trace/light_lanes.h"
#include "trace/light_receiver.h"
#include "trace/lights.h"
#include "trace/medium_stack.h"
#include "trace/observer.h"
#include "trace/packets.h"
#include "trace/plain_kernels.h"
#include "trace/plain_surface.h"
#include "trace/sampler.h"
#include "trace/surface.h"
#include "trace/tracer.h"

namespace lumi {

/// Names a path in stochastic transparency.
inline uint32_t pathHash(const RandomKey& key, uint32_t seed) {
    return hashCombine(hashCombine(key.x, key.y), key.sample, seed);
}

/// Does it come from the eye of a perspective camera? Rays of orthographic ones have no eye, and begin outside of all.
inline bool hasEye(const PathStart& start) { return start.ray.fromCamera && start.cone.spread > 0; }

/// One path on its way.
struct PathState {
    BatchRay ray;
    RayCone cone;
    Vec3 throughput{1};
    Vec3 radiance{0};
    LightReceiver scatter;  ///< the last scattering: what densities of light samples refer to
    float scatterPdf = 0;   ///< per solid angle; 0 after a delta lobe
    Vec3 absorption{0};     ///< 1/m, of the innermost of `media`
    SampleStream stream;
    uint32_t hash = 0;  ///< see pathHash()
    uint32_t slot = 0, sample = 0;
    int diffuseCount = 0, specularCount = 0;
    bool alive = true;
    bool diffuseBefore = false;
    MediumStack media;  ///< the solids it is in
};

/// A light sample that waits for its shadow ray.
struct PendingLight {
    uint32_t path = 0;
    Vec3 contribution{0};        ///< to the path, throughput included
    bool delta = false;          ///< without extent
    bool diffuseBefore = false;  ///< of its path, on its way to the vertex
    bool sky = false;            ///< it and its split are still to be multiplied by the sky's radiance at `skyPlace`
    Vec2 skyPlace{0};
    Vec3 specular{0};  ///< part of the contribution; while lobes are regularized
};

/// What the vertex is told of it: radiance towards wo if nothing blocks it, MIS-weighted.
struct PendingSplit {
    Vec3 diffuse{0}, specular{0};
};

inline Vec3 transmittance(const Vec3& absorption, float distance) {
    return isBlack(absorption) ? Vec3(1) : glm::exp(-absorption * distance);
}

/// The solids on one side of a surface: past the boundary of one, with it or without, else those the path is in.
inline MediumStack mediaTowards(const PathState& path, const Surface& surface, bool farSide) {
    MediumStack media = path.media;
    if (!farSide || !surface.inputs.solid) return media;
    if (surface.inputs.entering) media.enter(surface.material);
    else media.leave(surface.material);
    return media;
}

/// 1/m.
inline Vec3 absorptionIn(const SceneTables& tables, const MediumStack& media) {
    const uint32_t material = media.innermost();
    return material == MediumStack::kNone ? Vec3(0) : tables.materials[material].absorption;
}

/// Scratch of the integrator for one batch; reused from batch to batch. Belongs to one thread at a time.
struct PathBatch {
    static constexpr size_t kMost = 1024;

    std::vector<PathStart> starts;  ///< the caller's, if it has no other place for them
    std::vector<PathState> paths;
    std::vector<uint32_t> active;  ///< indices of paths that have a ray, in order of their starts
    std::vector<BatchRay> rays;    ///< of the active paths
    std::vector<RawHit> hits;
    std::vector<SurfaceGeometry> geometry;       ///< of hits on triangles, those of collected rows left out
    std::vector<uint8_t> collected;              ///< 1 for rows that are in `plain` before they are shaded
    PlainLanes plain;                            ///< vertices on plain surfaces
    LightReceiver receivers[PlainLanes::kMost];  ///< of the lanes, and the next two
    Lights::Choice choices[PlainLanes::kMost];
    LightLanes lights;
    bool absorbs = false;               ///< some path is or was in a solid that absorbs
    PlainTaps taps[PlainLanes::kMost];  ///< of the first lanes, whose textures are looked up
    std::vector<PendingLight> pending;
    std::vector<PendingSplit> splits;  ///< of the pending ones, if vertices are wanted
    std::vector<BatchRay> shadowRays;
    std::vector<uint8_t> blocked;
    uint64_t nonFinite = 0;

    // For observers: one row an active path.
    std::vector<PathVertex> vertices;
    std::vector<uint32_t> vertexOf;  ///< row of each path
    std::vector<uint32_t> slots, samples;
    std::vector<Vec3> radiance;
    std::vector<RawHit> blockers;

    // For a FirstHitJudge, one a start.
    std::vector<uint32_t> firstIds;
    std::vector<Hit> firstHits;
    std::vector<uint8_t> goesOn;
};

}  // namespace lumi
