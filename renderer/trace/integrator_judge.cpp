// First hits that a judge decides on.
#include "trace/integrator.h"

namespace lumi {

/// First hits as the judge wants them; paths that it ends are no longer active.
void Integrator::findJudgedHits(PathBatch& batch, std::span<const PathStart> starts, bool coherent,
                                TraceCounts& counts) const {
    const size_t count = starts.size();
    batch.rays.resize(count), batch.hits.resize(count);
    batch.firstIds.resize(count), batch.firstHits.resize(count);
    batch.goesOn.assign(count, 1);
    judge_->nameRays(starts, batch.firstIds);
    for (size_t i = 0; i < count; ++i) {
        batch.rays[i] = batch.paths[i].ray;
        batch.rays[i].id = batch.firstIds[i];
        counts.cameraRays += batch.rays[i].tmin <= batch.rays[i].tmax;
    }
    intersectRays(scene_.embree, batch.rays, batch.hits, coherent ? Coherence::Coherent : Coherence::Incoherent);
    for (size_t i = 0; i < count; ++i) {
        // Member by member: a copy would wait for its parts.
        const RawHit& raw = batch.hits[i];
        Hit& hit = batch.firstHits[i];
        hit.distance = raw.distance;
        hit.point.instance = raw.instance, hit.point.primitive = raw.primitive;
        hit.point.barycentrics.x = raw.u, hit.point.barycentrics.y = raw.v, hit.point.time = batch.rays[i].time;
        if (!raw.valid() || scene_.tables.instances[raw.instance].body < 0) continue;
        const BatchRay& ray = batch.rays[i];
        hit.point = surfacePoint(scene_.tables, raw, ray.origin + ray.direction * raw.distance, ray.time);
    }
    judge_->judge(starts, batch.firstHits, batch.goesOn);
    size_t kept = 0;
    for (size_t i = 0; i < count; ++i) {
        if (!batch.goesOn[i]) continue;
        const Hit& hit = batch.firstHits[i];
        RawHit& raw = batch.hits[kept];
        raw.distance = hit.distance, raw.instance = hit.point.instance, raw.primitive = hit.point.primitive;
        raw.u = hit.point.barycentrics.x, raw.v = hit.point.barycentrics.y;
        batch.active[kept++] = static_cast<uint32_t>(i);
    }
    batch.active.resize(kept), batch.hits.resize(kept);
}

}  // namespace lumi
