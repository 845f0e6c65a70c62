#include "trace/packets.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "trace/ray_recorder.h"

namespace lumi {
namespace {

template <int N>
struct Packet;
template <>
struct Packet<4> {
    using Ray = RTCRay4;
    using RayHit = RTCRayHit4;
    static constexpr auto intersect = &rtcIntersect4;
    static constexpr auto occluded = &rtcOccluded4;
};
template <>
struct Packet<8> {
    using Ray = RTCRay8;
    using RayHit = RTCRayHit8;
    static constexpr auto intersect = &rtcIntersect8;
    static constexpr auto occluded = &rtcOccluded8;
};
template <>
struct Packet<16> {
    using Ray = RTCRay16;
    using RayHit = RTCRayHit16;
    static constexpr auto intersect = &rtcIntersect16;
    static constexpr auto occluded = &rtcOccluded16;
};

/// `coherent` lets Embree follow a packet by its frustum, which makes camera rays two to three times as fast. Never for
/// occlusion: Embree 3.13.5 does not return then for some packets of shadow rays towards a sky over robust instances.
EmbreeScene::Context makeContext(const EmbreeScene& scene, std::span<const BatchRay> rays, bool coherent) {
    EmbreeScene::Context context(scene, rays);
    context.flags = coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
    return context;
}

/// Is it one that Embree can follow? It asserts that no number of a ray is NaN, that places and directions do not pass
/// 1.8e18, and that no ray begins behind its origin. Others meet nothing.
bool isTraceable(const BatchRay& r) {
    // Not by glm::abs(), which branches: which way directions point nobody foresees.
    const auto size = [](const Vec3& v) { return std::abs(v.x) + std::abs(v.y) + std::abs(v.z); };
    return (size(r.origin) + size(r.direction) < 1e18f) & (r.tmin >= 0) & (r.tmax >= -kInfinity);
}

/// Rays in their order.
struct AsTheyCome {
    size_t operator[](size_t i) const { return i; }
};

/// The rays order[first, first + count) of `rays`, at most N.
template <int N, class PacketRay, class Order>
void fill(PacketRay& packet, int* valid, std::span<const BatchRay> rays, Order order, size_t first, size_t count) {
    for (size_t i = 0; i < N; ++i) {
        // Lanes that are off hold a copy, so that no lane has undefined values.
        const BatchRay& r = rays[order[first + std::min(i, count - 1)]];
        valid[i] = i < count && isTraceable(r) ? -1 : 0;
        packet.org_x[i] = r.origin.x, packet.org_y[i] = r.origin.y, packet.org_z[i] = r.origin.z;
        packet.dir_x[i] = r.direction.x, packet.dir_y[i] = r.direction.y, packet.dir_z[i] = r.direction.z;
        packet.tnear[i] = r.tmin, packet.tfar[i] = r.tmax;
        packet.time[i] = r.time;
        packet.mask[i] = ~0u, packet.id[i] = r.id, packet.flags[i] = flagsOf(r);
    }
}

/// `r`, or in place of one that cannot be traced one that ends before it begins.
const BatchRay& traceable(const BatchRay& r) {
    static constexpr BatchRay kNone{.tmin = 1, .tmax = 0};
    return isTraceable(r) ? r : kNone;
}

uint32_t instanceOf(uint32_t geometry, uint32_t placed) {
    return placed != RTC_INVALID_GEOMETRY_ID ? placed : geometry;
}

template <int N, class Order = AsTheyCome>
void intersectPackets(RTCScene scene, std::span<const BatchRay> rays, std::span<RawHit> hits,
                      RTCIntersectContext& context, Order order = {}) {
    alignas(64) typename Packet<N>::RayHit packet;
    alignas(64) int valid[N];
    for (size_t first = 0; first < rays.size(); first += N) {
        const size_t count = std::min<size_t>(N, rays.size() - first);
        fill<N>(packet.ray, valid, rays, order, first, count);
        for (int i = 0; i < N; ++i) packet.hit.geomID[i] = packet.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
        Packet<N>::intersect(valid, scene, &context, &packet);
        for (size_t i = 0; i < count; ++i) {
            RawHit& hit = hits[order[first + i]];
            const bool some = packet.hit.geomID[i] != RTC_INVALID_GEOMETRY_ID;
            hit.distance = some ? packet.ray.tfar[i] : kInfinity;
            hit.instance = some ? instanceOf(packet.hit.geomID[i], packet.hit.instID[0][i]) : kNoInstance;
            hit.primitive = packet.hit.primID[i];
            hit.u = packet.hit.u[i], hit.v = packet.hit.v[i];
        }
    }
}

template <int N, class Order = AsTheyCome>
void occludedPackets(RTCScene scene, std::span<const BatchRay> rays, std::span<uint8_t> blocked,
                     RTCIntersectContext& context, Order order = {}) {
    alignas(64) typename Packet<N>::Ray packet;
    alignas(64) int valid[N];
    for (size_t first = 0; first < rays.size(); first += N) {
        const size_t count = std::min<size_t>(N, rays.size() - first);
        fill<N>(packet, valid, rays, order, first, count);
        Packet<N>::occluded(valid, scene, &context, &packet);
        // Embree marks a blocked ray by tfar = -inf.
        for (size_t i = 0; i < count; ++i) blocked[order[first + i]] = packet.tfar[i] < 0 ? 1 : 0;
    }
}

/// Rays that are sorted or walk together: as many as a batch has.
constexpr size_t kAtOnce = 1024;

/// Of `side` cells, the one of `x` in [0, side]; the first for what is not a number.
int cellAt(float x, int side) {
    const float least = x > 0 ? x : 0.0f, most = static_cast<float>(side - 1);
    return static_cast<int>(least < most ? least : most);
}

int octantOf(const Vec3& d) {
    return (std::signbit(d.x) ? 4 : 0) + (std::signbit(d.y) ? 2 : 0) + (std::signbit(d.z) ? 1 : 0);
}

/// Places of rays such that those that start in one cell of a grid over `bounds`, and with `Octants` go towards one
/// octant too, are neighbours, else in their order. `Side` cells along each axis.
template <int Side, bool Octants>
void sortRays(std::span<const BatchRay> rays, const Bounds3& bounds, uint16_t* order) {
    constexpr int kCells = Side * Side * Side, kKeys = kCells * (Octants ? 8 : 1);
    const Vec3 lower = bounds.lower, scale = static_cast<float>(Side) / glm::max(bounds.upper - lower, Vec3(1e-30f));
    uint16_t keys[kAtOnce];
    uint16_t next[kKeys + 1] = {};
    for (size_t i = 0; i < rays.size(); ++i) {
        const Vec3 at = (rays[i].origin - lower) * scale;
        const int cell = (cellAt(at.x, Side) * Side + cellAt(at.y, Side)) * Side + cellAt(at.z, Side);
        keys[i] = static_cast<uint16_t>(cell + (Octants ? kCells * octantOf(rays[i].direction) : 0));
        ++next[keys[i] + 1];
    }
    for (int i = 1; i < kKeys; ++i) next[i] = static_cast<uint16_t>(next[i] + next[i - 1]);
    for (size_t i = 0; i < rays.size(); ++i) order[next[keys[i]]++] = static_cast<uint16_t>(i);
}

/// Calls trace(some rays, their results, their order) for all rays, those that are at once sorted.
template <int Side, bool Octants, class Result, class Trace>
void forSorted(const Bounds3& bounds, std::span<const BatchRay> rays, std::span<Result> results, Trace&& trace) {
    uint16_t order[kAtOnce];
    for (size_t first = 0; first < rays.size(); first += kAtOnce) {
        const size_t count = std::min(kAtOnce, rays.size() - first);
        sortRays<Side, Octants>(rays.subspan(first, count), bounds, order);
        trace(rays.subspan(first, count), results.subspan(first, count), order);
    }
}

/// Rays that start here and there and go anywhere, in a scene whose few nodes most of them meet: with their like.
template <int N>
void intersectSorted(const EmbreeScene& scene, std::span<const BatchRay> rays, std::span<RawHit> hits,
                     RTCIntersectContext& context) {
    forSorted<2, true>(scene.bounds(), rays, hits, [&](auto some, auto found, const uint16_t* order) {
        intersectPackets<N>(scene.handle(), some, found, context, order);
    });
}

/// Shadow rays likewise: most go to the same few lights, so where they start says enough.
template <int N>
void occludedSorted(const EmbreeScene& scene, std::span<const BatchRay> rays, std::span<uint8_t> blocked,
                    RTCIntersectContext& context) {
    forSorted<4, false>(scene.bounds(), rays, blocked, [&](auto some, auto found, const uint16_t* order) {
        occludedPackets<N>(scene.handle(), some, found, context, order);
    });
}

/// All rays of a call walk the tree together, node by node.
void occludedStream(RTCScene scene, std::span<const BatchRay> rays, std::span<uint8_t> blocked,
                    RTCIntersectContext& context) {
    RTCRay queries[kAtOnce];
    for (size_t first = 0; first < rays.size(); first += kAtOnce) {
        const size_t count = std::min(kAtOnce, rays.size() - first);
        for (size_t i = 0; i < count; ++i) toEmbree(traceable(rays[first + i]), queries[i]);
        rtcOccluded1M(scene, &context, queries, static_cast<unsigned>(count), sizeof(RTCRay));
        for (size_t i = 0; i < count; ++i) blocked[first + i] = queries[i].tfar < 0 ? 1 : 0;
    }
}

}  // namespace

void intersectRays(const EmbreeScene& scene, std::span<const BatchRay> rays, std::span<RawHit> hits,
                   Coherence coherence) {
    assert(hits.size() >= rays.size());
    if (RayRecorder* recorder = scene.recorder()) recorder->add(false, coherence, rays);
    const bool together = coherence == Coherence::Coherent && scene.packetWidth() > 1,
               sorted = scene.strayPacketWidth() >= 8;
    EmbreeScene::Context context = makeContext(scene, rays, together || sorted);
    if (together) {
        const int width = scene.packetWidth();
        if (width == 16) return intersectPackets<16>(scene.handle(), rays, hits, context);
        if (width == 8) return intersectPackets<8>(scene.handle(), rays, hits, context);
        return intersectPackets<4>(scene.handle(), rays, hits, context);
    }
    if (sorted && scene.strayPacketWidth() == 16) return intersectSorted<16>(scene, rays, hits, context);
    if (sorted) return intersectSorted<8>(scene, rays, hits, context);
    for (size_t i = 0; i < rays.size(); ++i) {
        RTCRayHit query;
        toEmbree(traceable(rays[i]), query.ray);
        query.hit.u = query.hit.v = 0, query.hit.primID = 0;
        query.hit.geomID = query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
        rtcIntersect1(scene.handle(), &context, &query);
        const RTCHit& found = query.hit;
        RawHit& hit = hits[i];
        const bool some = found.geomID != RTC_INVALID_GEOMETRY_ID;
        hit.distance = some ? query.ray.tfar : kInfinity;
        hit.instance = some ? instanceOf(found.geomID, found.instID[0]) : kNoInstance;
        hit.primitive = found.primID;
        hit.u = found.u, hit.v = found.v;
    }
}

void occludedRays(const EmbreeScene& scene, std::span<const BatchRay> rays, std::span<uint8_t> blocked,
                  Coherence coherence) {
    assert(blocked.size() >= rays.size());
    if (RayRecorder* recorder = scene.recorder()) recorder->add(true, coherence, rays);
    EmbreeScene::Context context = makeContext(scene, rays, false);
    const int width = scene.strayPacketWidth();
    const bool sorted = coherence == Coherence::Incoherent;
    if (width == 16 && sorted) return occludedSorted<16>(scene, rays, blocked, context);
    if (width == 8 && sorted) return occludedSorted<8>(scene, rays, blocked, context);
    if (width == 16) return occludedPackets<16>(scene.handle(), rays, blocked, context);
    if (width == 8) return occludedPackets<8>(scene.handle(), rays, blocked, context);
    if (width == 4) return occludedPackets<4>(scene.handle(), rays, blocked, context);
    occludedStream(scene.handle(), rays, blocked, context);
}

}  // namespace lumi
