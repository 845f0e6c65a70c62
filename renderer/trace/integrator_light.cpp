// Next-event estimation: light samples, their shadow rays, and what they add to their paths.
#include <cmath>

#include "math/hash.h"
#include "trace/integrator.h"

namespace lumi {

void Integrator::sampleLight(PathBatch& batch, uint32_t index, const Surface& surface, const Frame& frame,
                             const Bsdf& bsdf, int depth, PathVertex* vertex) const {
    PathState& path = batch.paths[index];
    const LightReceiver receiver = receiverAt(path, surface);
    const Vec2 pick = path.stream.get2(dimension::vertex(depth, dimension::kLight));
    const Vec2 u = path.stream.get2(dimension::vertex(depth, dimension::kLightPoint));
    LightSample light;
    if (!scene_.lights.sample(receiver, pick, u, light)) return;
    if (settings_.strategy == DirectStrategy::Bsdf && light.hittable) return;

    // Scattering towards the light; the shading normal may not let it through the surface.
    const float side = glm::dot(light.direction, surface.geometricNormal);
    const Vec3 wi = frame.toLocal(light.direction);
    if (side * wi.z <= 0) return;
    const BsdfValue f = bsdf.evaluate(wi);
    const bool mixed = light.hittable && settings_.strategy == DirectStrategy::Mis;
    const float weight = (mixed ? misWeight(light.pdf, f.pdf) : 1) / light.pdf;
    // The sky's radiance is looked up when the shadow ray has found it: most samples never wait for that memory.
    Vec3 radiance = light.sky ? Vec3(weight) : light.radiance * weight;
    if (std::isfinite(light.distance))
        radiance *= transmittance(absorptionIn(scene_.tables, mediaTowards(path, surface, wi.z < 0)), light.distance);
    const Vec3 diffuse = f.diffuse * radiance, specular = f.specular * radiance, sum = diffuse + specular;
    if (isBlack(sum)) return;
    if (!isFinite(sum * path.throughput)) {
        ++batch.nonFinite;
        return;
    }
    if (vertex) {
        vertex->lightSampled = true;
        vertex->lightPosition = light.position;
        vertex->lightInfinite = !std::isfinite(light.distance);
        vertex->light = light.light;
    }
    const Vec3 normal = side > 0 ? surface.geometricNormal : -surface.geometricNormal;
    BatchRay ray;
    ray.origin = offsetOrigin(surface.position, normal, surface.offset);
    ray.time = path.ray.time;
    ray.id = pcgHash(path.hash + static_cast<uint32_t>(2 * depth + 1));
    ray.direction = light.direction;
    if (std::isfinite(light.distance)) {
        const Vec3 segment = light.target - ray.origin;
        const float length = glm::length(segment);
        if (!(length > 0)) return;
        ray.direction = segment / length;
        ray.tmax = length;
    }
    // With the throughput of now: the path goes on before its shadow rays are traced.
    PendingLight& pending = batch.pending.emplace_back();
    pending.path = index;
    pending.contribution = path.throughput * sum;
    pending.delta = light.delta;
    pending.diffuseBefore = path.diffuseBefore;
    if (settings_.regularize) pending.specular = path.throughput * specular;
    pending.sky = light.sky;
    pending.skyPlace = light.skyPlace;
    if (vertex) batch.splits.push_back({diffuse, specular});
    batch.shadowRays.push_back(ray);
}

void Integrator::traceShadows(PathBatch& batch, int depth, bool coherent, TraceCounts& counts) const {
    const size_t count = batch.shadowRays.size();
    if (count == 0) return;
    batch.blocked.resize(count);
    counts.shadowRays += count;
    const Coherence coherence = coherent && depth == 0 ? Coherence::Coherent : Coherence::Incoherent;
    const bool wantsVertices = depth < needs_.vertexDepths;
    if (needs_.blocker && wantsVertices) {
        batch.blockers.resize(count);
        intersectRays(scene_.embree, batch.shadowRays, batch.blockers, coherence);
        for (size_t i = 0; i < count; ++i) {
            batch.blocked[i] = batch.blockers[i].valid();
            if (!batch.blocked[i]) continue;
            const BatchRay& ray = batch.shadowRays[i];
            batch.vertices[batch.vertexOf[batch.pending[i].path]].blocker = surfacePoint(
                scene_.tables, batch.blockers[i], ray.origin + ray.direction * batch.blockers[i].distance, ray.time);
        }
    } else {
        occludedRays(scene_.embree, batch.shadowRays, batch.blocked, coherence);
    }
    if (scene_.tables.thinWalls && scene_.lights.hasDelta()) passThinWalls(batch, depth, counts);
    addLights(batch, depth);
}

void Integrator::addLights(PathBatch& batch, int depth) const {
    const EnvironmentLight& sky = scene_.lights.environment();
    for (size_t i = 0; i < batch.pending.size(); ++i)
        if (!batch.blocked[i] && batch.pending[i].sky) sky.prefetch(batch.pending[i].skyPlace);
    for (size_t i = 0; i < batch.pending.size(); ++i) {
        if (batch.blocked[i]) continue;
        const PendingLight& light = batch.pending[i];
        Vec3 factor = light.sky ? sky.radianceAt(light.skyPlace) : Vec3(1);
        if (settings_.clamp && depth > 0) {
            const float largest = maxComponent(light.contribution * factor);
            if (largest > settings_.clampRadiance) factor *= settings_.clampRadiance / largest;
        }
        const Vec3 contribution = light.contribution * factor;
        add(batch, batch.paths[light.path], contribution);
        if (depth >= needs_.vertexDepths) continue;
        PathVertex& vertex = batch.vertices[batch.vertexOf[light.path]];
        vertex.lightVisible = true;
        if (!isFinite(contribution)) continue;
        vertex.directDiffuse = batch.splits[i].diffuse * factor;
        vertex.directSpecular = batch.splits[i].specular * factor;
    }
}

}  // namespace lumi
