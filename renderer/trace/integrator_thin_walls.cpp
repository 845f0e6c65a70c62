// Light without extent through panes: no path finds it by itself, so its shadow rays go on through smooth thin walls.
#include "trace/albedo_table.h"
#include "trace/integrator.h"

namespace lumi {

namespace {

constexpr int kMostWalls = 16;

/// What of a light sample smooth walls let straight through.
enum class Straight { All, Specular, Nothing };

/// Walls that regularization widens scatter: their own light samples find the light, for what a path brings that meets
/// them as such. After the last scattering at `depth` no path does.
Straight straightOf(const PendingLight& light, uint32_t sample, int depth, const PathSettings& settings) {
    if (!settings.regularize || settings.leastRoughness(sample) < kTabledRoughness) return Straight::All;
    if (depth + 1 >= settings.maxDepth) return Straight::All;
    if (settings.regularizeAfter == RegularizeAfter::Any || light.diffuseBefore) return Straight::Nothing;
    return Straight::Specular;
}

/// A shadow ray that goes on: its place among the pending lights, and what the walls so far let through.
struct Passing {
    size_t pending = 0;
    Straight kind = Straight::All;
    Vec3 through{1};
};

}  // namespace

/// What a smooth thin wall lets straight through of light that comes along `-direction`; 0 of all else.
Vec3 Integrator::straightThrough(const Surface& surface, const Vec3& direction) const {
    const BsdfInputs& inputs = surface.inputs;
    if (inputs.solid || !(inputs.transmission > 0)) return Vec3(0);
    Vec3 wo = Frame(surface.normal).toLocal(-direction);
    wo.z = std::max(wo.z, 1e-5f);
    const Bsdf bsdf(inputs, wo);
    return bsdf.isWindow() ? bsdf.albedo(Lobe::SpecularTransmission) : Vec3(0);
}

void Integrator::passThinWalls(PathBatch& batch, int depth, TraceCounts& counts) const {
    std::vector<Passing> passing;
    std::vector<BatchRay> rays;
    for (size_t i = 0; i < batch.pending.size(); ++i) {
        const PendingLight& light = batch.pending[i];
        if (!batch.blocked[i] || !light.delta) continue;
        const Straight kind = straightOf(light, batch.paths[light.path].sample, depth, settings_);
        if (kind == Straight::Nothing) continue;
        passing.push_back({i, kind, Vec3(1)});
        rays.push_back(batch.shadowRays[i]);
    }
    std::vector<RawHit> hits;
    for (int wall = 0; wall <= kMostWalls && !rays.empty(); ++wall) {
        hits.resize(rays.size());
        intersectRays(scene_.embree, rays, hits, Coherence::Incoherent);
        counts.shadowRays += rays.size();
        size_t kept = 0;
        for (size_t i = 0; i < rays.size(); ++i) {
            BatchRay ray = rays[i];
            Passing light = passing[i];
            if (!hits[i].valid()) {  // nothing stands before the light any more
                batch.blocked[light.pending] = 0;
                PendingLight& pending = batch.pending[light.pending];
                const bool withDiffuse = light.kind == Straight::All;
                pending.contribution = (withDiffuse ? pending.contribution : pending.specular) * light.through;
                if (batch.splits.empty()) continue;
                batch.splits[light.pending].diffuse *= withDiffuse ? light.through : Vec3(0);
                batch.splits[light.pending].specular *= light.through;
                continue;
            }
            const InstanceRecord& instance = scene_.tables.instances[hits[i].instance];
            if (instance.body >= 0 || !scene_.tables.materials[instance.materialOf(hits[i].primitive)].thinWall)
                continue;
            const Vec3 at = ray.origin + ray.direction * hits[i].distance;
            const Surface surface =
                evaluateSurface(scene_.tables, surfacePoint(scene_.tables, hits[i], at, ray.time), -ray.direction, 0);
            light.through *= straightThrough(surface, ray.direction);
            if (isBlack(light.through)) continue;
            ray.origin = offsetOrigin(surface.position, -surface.geometricNormal, surface.offset);
            ray.tmax -= hits[i].distance;
            passing[kept] = light, rays[kept] = ray;
            ++kept;
        }
        passing.resize(kept), rays.resize(kept);
    }
}

}  // namespace lumi
