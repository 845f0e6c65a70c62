#include "trace/integrator.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "math/hash.h"

namespace lumi {
namespace {

ObserverNeeds joined(std::span<PathObserver* const> observers) {
    ObserverNeeds all{0, 0, 0, 0, false};
    for (const PathObserver* observer : observers) {
        const ObserverNeeds needs = observer->needs();
        all.vertexDepths = std::max(all.vertexDepths, needs.vertexDepths);
        all.albedoDepths = std::max(all.albedoDepths, needs.albedoDepths);
        all.normalDepths = std::max(all.normalDepths, needs.normalDepths);
        all.shareDepths = std::max(all.shareDepths, needs.shareDepths);
        all.blocker |= needs.blocker;
    }
    return all;
}

FirstHitJudge* judgeOf(std::span<PathObserver* const> observers) {
    return observers.empty() ? nullptr : dynamic_cast<FirstHitJudge*>(observers.front());
}

}  // namespace

Integrator::Integrator(const TraceScene& scene, const PathSettings& settings, uint32_t seed,
                       std::span<PathObserver* const> observers, EyeMedia around)
    : scene_(scene),
      settings_(settings),
      seed_(seed),
      around_(std::move(around)),
      judge_(judgeOf(observers)),
      observers_(judge_ ? observers.subspan(1) : observers),
      needs_(joined(observers_)) {
    usesLightSamples_ = !scene.lights.empty() && (settings.strategy != DirectStrategy::Bsdf || scene.lights.hasDelta());
}

LightReceiver Integrator::receiverAt(const PathState& path, const Surface& surface) const {
    using Facing = LightReceiver::Facing;
    const Facing facing = surface.inputs.transmission > 0 ? Facing::Both : Facing::Front;
    return {surface.position, surface.geometricNormal, path.ray.time, facing, settings_.lightSampling};
}

float Integrator::misWeight(float pdf, float otherPdf) const {
    const float a = pdf * pdf, b = otherPdf * otherPdf;
    return std::isinf(a) ? 1 : a / (a + b);
}

Vec3 Integrator::limited(const PathState& path, const Vec3& radiance, int depth) const {
    if (!settings_.clamp || depth == 0) return radiance;
    const float largest = maxComponent(path.throughput * radiance);
    return largest > settings_.clampRadiance ? radiance * (settings_.clampRadiance / largest) : radiance;
}

void Integrator::add(PathBatch& batch, PathState& path, const Vec3& contribution) const {
    if (isFinite(contribution)) path.radiance += contribution;
    else ++batch.nonFinite;
}

bool Integrator::run(PathBatch& batch, std::span<const PathStart> starts, std::span<const SurfacePoint> firstPoints,
                     std::span<Vec3> radiance, bool coherent, TraceCounts& counts, const std::stop_token& stop,
                     std::span<const Hit> firstHits) const {
    assert(starts.size() <= PathBatch::kMost);
    const auto count = static_cast<uint32_t>(starts.size());
    batch.paths.resize(count);
    batch.active.resize(count);
    batch.plain.count = 0;
    batch.nonFinite = 0;
    batch.absorbs = around_.isAnywhere();
    for (uint32_t i = 0; i < count; ++i) {
        const PathStart& start = starts[i];
        PathState& path = batch.paths[i];
        // Member by member, here and below: what is put together elsewhere and copied waits for its parts.
        new (&path) PathState();
        path.ray.origin = start.ray.origin, path.ray.direction = start.ray.direction;
        path.ray.tmin = start.ray.tmin, path.ray.tmax = start.ray.tmax;
        path.ray.time = start.ray.time, path.ray.fromCamera = start.ray.fromCamera;
        path.cone.width = start.cone.width, path.cone.spread = start.cone.spread;
        path.stream = SampleStream(settings_.sampler, settings_.haltonLoop, seed_, start.key);
        path.hash = pathHash(start.key, seed_);
        path.slot = start.slot, path.sample = start.key.sample;
        if (hasEye(start)) {
            path.media = around_.at(start.ray.time), path.absorption = absorptionIn(scene_.tables, path.media);
            if (!firstPoints.empty()) path.throughput = transmittance(path.absorption, start.ray.tmax);
        }
        batch.active[i] = i;
    }
    assert(!judge_ || (firstPoints.empty() && firstHits.empty()));
    for (int depth = 0; !batch.active.empty(); ++depth) {
        if (stop.stop_requested()) return false;
        const bool given = depth == 0 && !firstPoints.empty();
        if (given) batch.hits.assign(count, RawHit());
        else if (depth == 0 && !firstHits.empty()) takeHits(batch, firstHits);
        else if (depth == 0 && judge_) findJudgedHits(batch, starts, coherent, counts);
        else findHits(batch, depth, coherent, counts);
        const bool wantsVertices = depth < needs_.vertexDepths;
        if (wantsVertices) batch.vertices.assign(batch.active.size(), PathVertex()), batch.vertexOf.resize(count);
        batch.pending.clear();
        batch.splits.clear();
        batch.shadowRays.clear();
        const auto rows = static_cast<uint32_t>(batch.active.size());
        for (uint32_t first = 0; first < rows; first += PlainLanes::kMost)
            shadeRows(batch, {first, std::min<uint32_t>(rows, first + PlainLanes::kMost)}, depth,
                      given ? firstPoints : std::span<const SurfacePoint>());
        traceShadows(batch, depth, coherent, counts);
        if (wantsVertices) report(batch, depth);
        std::erase_if(batch.active, [&](uint32_t i) { return !batch.paths[i].alive; });
    }
    counts.nonFinite += batch.nonFinite;
    if (!radiance.empty())
        for (uint32_t i = 0; i < count; ++i) radiance[i] = batch.paths[i].radiance;
    if (!observers_.empty()) {
        batch.slots.resize(count), batch.samples.resize(count), batch.radiance.resize(count);
        for (uint32_t i = 0; i < count; ++i) {
            const PathState& path = batch.paths[i];
            batch.slots[i] = path.slot, batch.samples[i] = path.sample, batch.radiance[i] = path.radiance;
        }
        for (PathObserver* observer : observers_) observer->finished(batch.slots, batch.samples, batch.radiance);
    }
    return true;
}

void Integrator::takeHits(PathBatch& batch, std::span<const Hit> hits) {
    batch.hits.resize(hits.size());
    for (size_t i = 0; i < hits.size(); ++i) {
        const SurfacePoint& point = hits[i].point;
        batch.hits[i] = {hits[i].distance, point.instance, point.primitive, point.barycentrics.x, point.barycentrics.y};
    }
}

void Integrator::findHits(PathBatch& batch, int depth, bool coherent, TraceCounts& counts) const {
    batch.rays.resize(batch.active.size());
    batch.hits.resize(batch.active.size());
    for (size_t row = 0; row < batch.active.size(); ++row) {
        const PathState& path = batch.paths[batch.active[row]];
        batch.rays[row] = path.ray;
        batch.rays[row].fromCamera = depth == 0 && path.ray.fromCamera;
        batch.rays[row].id = pcgHash(path.hash + static_cast<uint32_t>(2 * depth));
    }
    // The last ray of a path only asks whether it meets the sky, if nothing else shines: any hit will do.
    if (depth == settings_.maxDepth && depth >= needs_.vertexDepths && !scene_.lights.hasEmitters()) {
        batch.blocked.resize(batch.rays.size());
        occludedRays(scene_.embree, batch.rays, batch.blocked, Coherence::Incoherent);
        counts.bounceRays += batch.rays.size();
        size_t kept = 0;
        for (size_t row = 0; row < batch.active.size(); ++row)
            if (!batch.blocked[row]) batch.active[kept++] = batch.active[row];
        batch.active.resize(kept);
        batch.hits.assign(kept, RawHit());
        return;
    }
    const bool packets = coherent && depth == 0;
    intersectRays(scene_.embree, batch.rays, batch.hits, packets ? Coherence::Coherent : Coherence::Incoherent);
    (depth == 0 ? counts.cameraRays : counts.bounceRays) += batch.rays.size();
}

/// A part of the batch that the lanes can hold.
void Integrator::shadeRows(PathBatch& batch, Rows rows, int depth, std::span<const SurfacePoint> firstPoints) const {
    const bool given = !firstPoints.empty();
    batch.plain.glossy = batch.plain.textured = batch.plain.mapped = false;
    if (!given) arrive(batch, rows, depth);
    for (uint32_t row = rows.begin; row < rows.end; ++row) {
        if (depth < needs_.vertexDepths) batch.vertexOf[batch.active[row]] = row;
        batch.paths[batch.active[row]].alive = false;
        if (given || !batch.collected[row]) shade(batch, row, depth, firstPoints);
    }
    shadePlain(batch, depth);
}

/// Geometry of all hits before any is shaded: what a later step reads from memory is asked for in the one before.
void Integrator::arrive(PathBatch& batch, Rows rows, int depth) const {
    if (scene_.embree.strayPacketWidth() == 1)  // small scenes are in the cache
        prefetchSurfaces(scene_.tables, std::span(batch.hits).subspan(rows.begin, rows.end - rows.begin));
    batch.geometry.resize(batch.active.size());
    batch.collected.resize(batch.active.size());
    for (size_t row = rows.begin; row < rows.end; ++row) {
        batch.collected[row] = 0;
        const RawHit& hit = batch.hits[row];
        if (!hit.valid()) continue;
        PathState& path = batch.paths[batch.active[row]];
        path.cone.width += path.cone.spread * hit.distance;
        if (batch.absorbs) path.throughput *= transmittance(path.absorption, hit.distance);
        const InstanceRecord& instance = scene_.tables.instances[hit.instance];
        if (instance.body >= 0 || isDark(instance, hit.primitive, depth)) continue;
        const MaterialRecord& material = scene_.tables.materials[instance.materialOf(hit.primitive)];
        if (isPlain(instance, material)) {
            collectPlain(batch, static_cast<uint32_t>(row), instance, material);
            batch.collected[row] = 1;
            continue;
        }
        const SurfacePoint point{hit.instance, hit.primitive, {hit.u, hit.v}, path.ray.time};
        batch.geometry[row] = surfaceGeometry(scene_.tables, point, -path.ray.direction, path.cone.width);
    }
    placePlain(batch, depth);
}

/// Of the last surface nothing is asked but its light; does it have none?
bool Integrator::isDark(const InstanceRecord& instance, uint32_t primitive, int depth) const {
    return depth >= settings_.maxDepth && depth >= needs_.vertexDepths && instance.body < 0 &&
           !scene_.tables.materials[instance.materialOf(primitive)].emits;
}

void Integrator::shade(PathBatch& batch, uint32_t row, int depth, std::span<const SurfacePoint> firstPoints) const {
    const uint32_t index = batch.active[row];
    PathState& path = batch.paths[index];
    PathVertex* vertex = depth < needs_.vertexDepths ? &batch.vertices[row] : nullptr;

    // Where the path arrived.
    const Vec3 wo = -path.ray.direction;
    const RawHit& hit = batch.hits[row];
    SurfacePoint point;
    float distance = 0;
    if (!firstPoints.empty()) {
        point = firstPoints[index];
        if (!point.valid()) return;
    } else {
        if (!hit.valid()) return shadeMiss(path, depth, vertex, batch);
        distance = hit.distance;
        point = surfacePoint(scene_.tables, hit, path.ray.origin + path.ray.direction * distance, path.ray.time);
    }
    const bool last = depth >= settings_.maxDepth;
    if (isDark(scene_.tables.instances[point.instance], point.primitive, depth)) return;

    const MipFilter mips = path.diffuseBefore ? MipFilter::Nearest : MipFilter::Between;
    Surface surface = firstPoints.empty() ? evaluateSurface(scene_.tables, point, batch.geometry[row], wo, mips)
                                          : evaluateSurface(scene_.tables, point, wo, path.cone.width);
    surface.inputs.multipleScattering = settings_.multipleScattering;
    if (settings_.regularizes(path.diffuseBefore, depth)) surface.inputs.widen(settings_.leastRoughness(path.sample));
    if (vertex) {
        describeVertex(path, surface, wo, depth, *vertex);
        vertex->distance = distance;
    }
    if (!isBlack(surface.emitted))
        addEmission(path, {point, surface.position, surface.outwardNormal, surface.emitted, surface.body}, depth,
                    vertex, batch);
    if (last || surface.body >= 0) return;

    if (!surface.inputs.layered && !(surface.inputs.transmission > 0)) return addPlain(batch, row, surface);
    const Frame frame(surface.normal);
    Vec3 local = frame.toLocal(wo);
    local.z = std::max(local.z, 1e-5f);
    Bsdf bsdf(surface.inputs, local);
    if (vertex && depth < needs_.albedoDepths) {
        vertex->albedo = bsdf.albedo(Lobe::Diffuse);
        vertex->specularAlbedo = bsdf.specularAlbedo();
    }
    const bool mayDiffuse = path.diffuseCount < settings_.maxDiffuseDepth;
    const bool maySpecular = path.specularCount < settings_.maxSpecularDepth;
    if (!mayDiffuse || !maySpecular) bsdf.keep(mayDiffuse, maySpecular);
    if (usesLightSamples_ && !bsdf.isDelta()) sampleLight(batch, index, surface, frame, bsdf, depth, vertex);
    path.alive = continuePath(path, surface, frame, bsdf, wo, depth, vertex);
    batch.absorbs |= !isBlack(path.absorption);
}

void Integrator::shadeMiss(PathState& path, int depth, PathVertex* vertex, PathBatch& batch) const {
    const bool certain = depth == 0 || path.scatterPdf <= 0 || settings_.strategy == DirectStrategy::Bsdf;
    const auto weight = [&](float pdf) {
        return pdf <= 0 ? 1 : settings_.strategy == DirectStrategy::Light ? 0 : misWeight(path.scatterPdf, pdf);
    };
    const Vec3 radiance =
        scene_.lights.escaped(path.ray.direction, path.ray.time, depth == 0, certain ? nullptr : &path.scatter, weight);
    const Vec3 emitted = isBlack(radiance) ? radiance : limited(path, radiance, depth);
    add(batch, path, path.throughput * emitted);
    if (!vertex) return;
    vertex->point.time = path.ray.time;
    vertex->wo = -path.ray.direction;
    vertex->distance = kInfinity;
    vertex->throughput = path.throughput;
    vertex->cone = path.cone;
    vertex->emitted = isFinite(path.throughput * emitted) ? emitted : Vec3(0);
}

void Integrator::addEmission(PathState& path, const Found& found, int depth, PathVertex* vertex,
                             PathBatch& batch) const {
    float weight = 1;
    if (depth > 0 && path.scatterPdf > 0 && settings_.strategy != DirectStrategy::Bsdf) {
        const Vec3& direction = path.ray.direction;
        const float lightPdf =
            found.body >= 0 ? scene_.lights.pdfBody(found.body, path.scatter, direction, found.position)
                            : scene_.lights.pdfTriangle(found.point.instance, found.point.primitive, path.scatter,
                                                        direction, found.position, found.outwardNormal, found.area);
        if (lightPdf > 0)
            weight = settings_.strategy == DirectStrategy::Light ? 0 : misWeight(path.scatterPdf, lightPdf);
    }
    const Vec3 emitted = limited(path, found.emitted * weight, depth);
    const Vec3 contribution = path.throughput * emitted;
    add(batch, path, contribution);
    if (vertex && isFinite(contribution)) vertex->emitted = emitted;
}

void Integrator::describeVertex(const PathState& path, const Surface& surface, const Vec3& wo, int depth,
                                PathVertex& vertex) const {
    vertex.point = surface.point;
    vertex.position = surface.position;
    vertex.geometricNormal = surface.geometricNormal;
    vertex.normal = surface.normal;
    if (depth < needs_.normalDepths) vertex.objectNormal = restNormal(scene_.tables, surface);
    vertex.wo = wo;
    vertex.material = surface.material;
    vertex.roughness = surface.inputs.roughness;
    vertex.cone = path.cone;
    vertex.throughput = path.throughput;
}

/// Growth of a path's footprint by scattering, metres a metre; small enough to keep texture averages local.
float Integrator::spreadOf(bool diffuse, float roughness) {
    constexpr float kDiffuseSpread = 0.1f, kSpecularSpread = 0.25f;
    return diffuse ? kDiffuseSpread : kSpecularSpread * sqr(roughness);
}

bool Integrator::continuePath(PathState& path, const Surface& surface, const Frame& frame, const Bsdf& bsdf,
                              const Vec3& wo, int depth, PathVertex* vertex) const {
    const BsdfSample sample = bsdf.sample(path.stream.get1(dimension::vertex(depth, dimension::kLobe)),
                                          path.stream.get2(dimension::vertex(depth, dimension::kBsdf)));
    if (sample.lobe == Lobe::None || isBlack(sample.weight) || !isFinite(sample.weight)) return false;
    if (!sample.delta && !(sample.pdf > 0)) return false;
    const bool diffuse = sample.lobe == Lobe::Diffuse;
    const Vec3 direction = glm::normalize(frame.toWorld(sample.wi));
    const float side = glm::dot(direction, surface.geometricNormal);
    if (side * sample.wi.z <= 0) return false;

    // Nothing that the last ray could find.
    const bool lightOnly = settings_.strategy == DirectStrategy::Light && !sample.delta;
    const bool lastRay = depth + 1 >= settings_.maxDepth;
    if (lastRay && depth + 1 >= needs_.vertexDepths && (!scene_.lights.hittable() || lightOnly)) return false;

    Vec3 weight = sample.weight;
    if (settings_.roulette && depth + 1 >= settings_.rouletteDepth) {
        const float survival = std::clamp(maxComponent(path.throughput * weight), 0.05f, 0.95f);
        if (path.stream.get1(dimension::vertex(depth, dimension::kRoulette)) >= survival) return false;
        weight /= survival;
    }
    if (vertex) {
        vertex->sampledLobe = sample.lobe;
        vertex->wi = direction;
        vertex->weight = weight;
        vertex->pdf = sample.delta ? 0 : sample.pdf;
        if (depth < needs_.shareDepths && !sample.delta) {
            const BsdfValue f = bsdf.evaluate(sample.wi);
            const Vec3 sum = f.diffuse + f.specular;
            for (int c = 0; c < 3; ++c)
                vertex->diffuseShare[c] = sum[c] > 0 ? f.diffuse[c] / sum[c] : (diffuse ? 1.0f : 0.0f);
        }
    }
    path.throughput *= weight;
    path.scatter = receiverAt(path, surface);
    path.scatterPdf = sample.delta ? 0 : sample.pdf;
    ++(diffuse ? path.diffuseCount : path.specularCount);
    path.diffuseBefore |= diffuse;
    path.cone.spread = std::max(path.cone.spread, spreadOf(diffuse, surface.inputs.roughness));
    if (sample.wi.z < 0 && surface.inputs.solid) {
        path.media = mediaTowards(path, surface, true);
        path.absorption = absorptionIn(scene_.tables, path.media);
    }
    path.ray.origin =
        offsetOrigin(surface.position, side > 0 ? surface.geometricNormal : -surface.geometricNormal, surface.offset);
    path.ray.direction = direction;
    path.ray.tmin = 0;
    path.ray.tmax = kInfinity;
    return true;
}

void Integrator::report(PathBatch& batch, int depth) const {
    batch.slots.resize(batch.active.size());
    batch.samples.resize(batch.active.size());
    for (size_t row = 0; row < batch.active.size(); ++row) {
        const PathState& path = batch.paths[batch.active[row]];
        batch.slots[row] = path.slot;
        batch.samples[row] = path.sample;
    }
    const BounceBatch bounce{depth, batch.slots, batch.samples, batch.vertices, scene_.posed.get()};
    for (PathObserver* observer : observers_)
        if (depth < observer->needs().vertexDepths) observer->bounce(bounce);
}

}  // namespace lumi
