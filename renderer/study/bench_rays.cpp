#include "study/bench_rays.h"

#include <atomic>

#include "base/parallel.h"

namespace lumi {
namespace {

/// Calls that one thread takes at a time.
constexpr int64_t kCallBlock = 16;

std::span<const BatchRay> raysOf(const RecordedRays& record, const RecordedRays::Call& call) {
    return std::span(record.rays).subspan(call.first, call.count);
}

uint64_t bareHits(RTCScene scene, RTCIntersectContext& context, const BatchRay& r, bool anyHit) {
    RTCRayHit query;
    toEmbree(r, query.ray);
    if (anyHit) {
        rtcOccluded1(scene, &context, &query.ray);
        return query.ray.tfar < 0;
    }
    query.hit.geomID = query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(scene, &context, &query);
    return query.hit.geomID != RTC_INVALID_GEOMETRY_ID;
}

template <class Body>
uint64_t sumOverCalls(const RecordedRays& record, const Body& body) {
    std::atomic<uint64_t> sum{0};
    parallelRanges(static_cast<int64_t>(record.calls.size()), kCallBlock, [&](int64_t begin, int64_t end) {
        uint64_t hits = 0;
        for (int64_t i = begin; i < end; ++i) hits += body(record.calls[static_cast<size_t>(i)]);
        sum += hits;
    });
    return sum;
}

}  // namespace

RecordedRays selectCalls(const RecordedRays& record, const CallFilter& filter) {
    RecordedRays selected;
    for (const RecordedRays::Call& call : record.calls) {
        if (!filter(call)) continue;
        selected.calls.push_back({call.anyHit, call.coherence, selected.rays.size(), call.count});
        const auto rays = raysOf(record, call);
        selected.rays.insert(selected.rays.end(), rays.begin(), rays.end());
    }
    return selected;
}

uint64_t replayCalls(const EmbreeScene& scene, const RecordedRays& record) {
    return sumOverCalls(record, [&](const RecordedRays::Call& call) {
        thread_local std::vector<RawHit> hits;
        thread_local std::vector<uint8_t> blocked;
        uint64_t count = 0;
        if (call.anyHit) {
            blocked.resize(call.count);
            occludedRays(scene, raysOf(record, call), blocked, call.coherence);
            for (const uint8_t b : blocked) count += b;
        } else {
            hits.resize(call.count);
            intersectRays(scene, raysOf(record, call), hits, call.coherence);
            for (const RawHit& hit : hits) count += hit.valid();
        }
        return count;
    });
}

uint64_t replayBare(const EmbreeScene& scene, const RecordedRays& record) {
    return sumOverCalls(record, [&](const RecordedRays::Call& call) {
        EmbreeScene::Context context(scene, raysOf(record, call));
        context.flags = RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
        uint64_t count = 0;
        for (const BatchRay& ray : raysOf(record, call)) count += bareHits(scene.handle(), context, ray, call.anyHit);
        return count;
    });
}

}  // namespace lumi
