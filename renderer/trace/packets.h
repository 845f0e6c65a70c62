#pragma once
#include <cstddef>
#include <cstring>
#include <span>

#include "trace/embree_scene.h"
#include "trace/ray.h"

namespace lumi {

/// A ray as batches keep it, in the order of RTCRay; `id` seeds stochastic transparency.
struct BatchRay {
    Vec3 origin{0};
    float tmin = 0;
    Vec3 direction{0, 0, -1};
    float time = 0;
    float tmax = kInfinity;
    uint32_t id = 0;
    bool fromCamera = false;  ///< as Ray::fromCamera
};

inline unsigned flagsOf(const BatchRay& ray) { return ray.fromCamera ? EmbreeScene::kFromCamera : 0; }

/// Embree's ray. The numbers move as whole vectors: Embree reads them as such, and would wait for ones that were
/// written one by one.
inline void toEmbree(const BatchRay& r, RTCRay& ray) {
    constexpr size_t kAlike = offsetof(RTCRay, mask);
    static_assert(offsetof(BatchRay, tmin) == offsetof(RTCRay, tnear) &&
                  offsetof(BatchRay, direction) == offsetof(RTCRay, dir_x) &&
                  offsetof(BatchRay, time) == offsetof(RTCRay, time) &&
                  offsetof(BatchRay, tmax) == offsetof(RTCRay, tfar) && offsetof(BatchRay, id) == kAlike);
    std::memcpy(static_cast<void*>(&ray), &r, kAlike);
    ray.mask = ~0u, ray.id = r.id, ray.flags = flagsOf(r);
}

/// What Embree says of a hit; bodies of lights are named later.
struct RawHit {
    float distance = kInfinity;
    uint32_t instance = kNoInstance, primitive = 0;
    float u = 0, v = 0;
    bool valid() const { return instance != kNoInstance; }
};

/// How rays of a batch relate: `Coherent` ones start alike and go alike, as camera rays do.
enum class Coherence { Coherent, Incoherent };

/// Nearest hits of rays[0, n): coherent ones in the widest packets, others as singles, or in small scenes
/// (strayPacketWidth() of 8 and more) in packets of rays that start in one part of the scene and go towards one octant.
void intersectRays(const EmbreeScene& scene, std::span<const BatchRay> rays, std::span<RawHit> hits,
                   Coherence coherence);

/// blocked[i] = 1 if anything lies in (tmin, tmax) of ray i, else 0. In packets in small scenes, incoherent ones sorted
/// by where they start; else all rays of a call walk the tree together, which is a tenth to a quarter faster than one
/// after the other.
void occludedRays(const EmbreeScene& scene, std::span<const BatchRay> rays, std::span<uint8_t> blocked,
                  Coherence coherence);

}  // namespace lumi
