// Vertices on plain surfaces: collected while a batch is shaded, and then shaded together by kernels.
#include <algorithm>
#include <cmath>

#include "math/hash.h"
#include "trace/albedo_table.h"
#include "trace/integrator.h"
#include "trace/sampler_kernels.h"
#include "trace/surface_material.h"

namespace lumi {

void Integrator::fillLane(PlainLanes& lanes, int i, uint32_t row, const PathState& path) const {
    lanes.row[i] = row;
    lanes.wo.set(i, -path.ray.direction);
    lanes.throughput.set(i, path.throughput);
    lanes.lobes[i] = (path.diffuseCount < settings_.maxDiffuseDepth ? PlainLanes::kDiffuseLobe : 0) |
                     (path.specularCount < settings_.maxSpecularDepth ? PlainLanes::kSpecularLobe : 0);
}

/// A vertex whose surface the general way has found.
void Integrator::addPlain(PathBatch& batch, uint32_t row, const Surface& surface) const {
    PlainLanes& lanes = batch.plain;
    const BsdfInputs& in = surface.inputs;
    const int i = lanes.count++;
    fillLane(lanes, i, row, batch.paths[batch.active[row]]);
    lanes.position.set(i, surface.position);
    lanes.geometricNormal.set(i, surface.geometricNormal);
    lanes.normal.set(i, surface.normal);
    lanes.offset[i] = surface.offset;
    lanes.baseColor.set(i, in.baseColor);
    lanes.specularColor.set(i, in.specularColor);
    lanes.metallic[i] = in.metallic, lanes.roughness[i] = in.roughness;
    lanes.ior[i] = in.ior, lanes.specular[i] = in.specular;
    lanes.glossy |= in.metallic > 0 || in.specular > 0;
}

/// A hit whose surface the kernels find.
void Integrator::collectPlain(PathBatch& batch, uint32_t row, const InstanceRecord& instance,
                              const MaterialRecord& material) const {
    PlainLanes& lanes = batch.plain;
    const PathState& path = batch.paths[batch.active[row]];
    const int i = lanes.count++;
    fillLane(lanes, i, row, path);
    lanes.width[i] = path.cone.width;
    batch.taps[i].material = &material;
    if (material.emits) scene_.lights.prefetchTriangle(batch.hits[row].instance, batch.hits[row].primitive);
    collectTriangle(instance, material, batch.hits[row], lanes, i);
}

/// Surfaces of what was collected, and their light. Of the last surface nothing else is asked.
void Integrator::placePlain(PathBatch& batch, int depth) const {
    PlainLanes& lanes = batch.plain;
    if (lanes.count == 0) return;
    const auto path = [&](int i) -> const PathState& { return batch.paths[batch.active[lanes.row[i]]]; };
    const bool described = depth < needs_.vertexDepths, last = depth >= settings_.maxDepth;
    plainKernels().place(lanes);
    if (!last || described) {
        const auto find = [&](int i) {
            if (batch.taps[i].material->textures != 0)
                findTexels(scene_.tables, lanes, i, !path(i).diffuseBefore, batch.taps[i]);
        };
        const auto read = [&](int i) {
            if (batch.taps[i].material->textures != 0) readTexels(scene_.tables, batch.taps[i], lanes, i);
        };
        // Where a judge has put the hits, texels of neighbours share few lines of memory, which sends only so many at a
        // time: the first are read meanwhile.
        const int ahead = judge_ ? std::min(16, lanes.count) : lanes.count;
        for (int i = 0; i < ahead; ++i) find(i);
        for (int i = ahead; i < lanes.count; ++i) find(i), read(i - ahead);
        for (int i = lanes.count - ahead; i < lanes.count; ++i) read(i);
        plainKernels().bend(lanes);
        if (settings_.regularize)
            for (int i = 0; i < lanes.count; ++i)
                if (settings_.regularizes(path(i).diffuseBefore, depth))
                    lanes.roughness[i] = std::max(lanes.roughness[i], settings_.leastRoughness(path(i).sample));
    }
    if (described)
        for (int i = 0; i < lanes.count; ++i) describePlain(batch, i, depth, batch.vertices[lanes.row[i]]);
    for (int i = 0; i < lanes.count; ++i)
        if (batch.taps[i].material->emits) addPlainEmission(batch, i, depth);
    if (last) lanes.count = 0;
}

void Integrator::addPlainEmission(PathBatch& batch, int i, int depth) const {
    const PlainLanes& lanes = batch.plain;
    const MaterialRecord& material = *batch.taps[i].material;
    const bool front = lanes.front[i] > 0;
    if (!front && !material.doubleSided) return;
    PathState& path = batch.paths[batch.active[lanes.row[i]]];
    const RawHit& hit = batch.hits[lanes.row[i]];
    const InstanceRecord& instance = scene_.tables.instances[hit.instance];
    const Vec2 b(hit.u, hit.v);
    const Vec3 emitted = emissionAt(material, instance, instance.triangles[hit.primitive], b);
    if (isBlack(emitted)) return;
    const Vec3 geometric = lanes.geometricNormal.get<Vec3>(i);
    addEmission(path,
                {{hit.instance, hit.primitive, b, path.ray.time},
                 lanes.position.get<Vec3>(i),
                 front ? geometric : -geometric,
                 emitted,
                 -1,
                 lanes.area[i]},
                depth, depth < needs_.vertexDepths ? &batch.vertices[lanes.row[i]] : nullptr, batch);
}

void Integrator::describePlain(const PathBatch& batch, int i, int depth, PathVertex& vertex) const {
    const PlainLanes& lanes = batch.plain;
    const PathState& path = batch.paths[batch.active[lanes.row[i]]];
    const RawHit& hit = batch.hits[lanes.row[i]];
    vertex.point = {hit.instance, hit.primitive, {hit.u, hit.v}, path.ray.time};
    vertex.position = lanes.position.get<Vec3>(i);
    vertex.geometricNormal = lanes.geometricNormal.get<Vec3>(i);
    vertex.normal = lanes.normal.get<Vec3>(i);
    if (depth < needs_.normalDepths) vertex.objectNormal = restNormal(scene_.tables, vertex.point, lanes.front[i] > 0);
    vertex.wo = lanes.wo.get<Vec3>(i);
    vertex.distance = hit.distance;
    vertex.material = static_cast<uint32_t>(batch.taps[i].material - scene_.tables.materials.data());
    vertex.roughness = saturate(lanes.roughness[i]);
    vertex.cone = path.cone;
    vertex.throughput = path.throughput;
}

void Integrator::drawNumbers(PathBatch& batch, int depth, bool lights, bool roulette) const {
    PlainLanes& lanes = batch.plain;
    struct Use {
        uint32_t use;
        float *x, *y;
        bool wanted;
    };
    const Use uses[] = {{dimension::kLobe, lanes.lobeX, nullptr, lanes.glossy},
                        {dimension::kBsdf, lanes.bsdfX, lanes.bsdfY, true},
                        {dimension::kLight, lanes.lightX, lanes.lightY, lights && scene_.lights.count() > 1},
                        {dimension::kLightPoint, lanes.lightPointX, lanes.lightPointY, lights},
                        {dimension::kRoulette, lanes.rouletteX, nullptr, roulette}};
    const auto stream = [&](int i) -> const SampleStream& { return batch.paths[batch.active[lanes.row[i]]].stream; };
    const bool sobol = settings_.sampler == SamplerKind::Sobol;
    if (sobol)
        for (int i = 0; i < lanes.count; ++i)
            lanes.scramble[i] = stream(i).scramble(), lanes.index[i] = stream(i).index();
    for (const Use& use : uses) {
        if (!use.wanted) continue;
        const uint32_t at = dimension::vertex(depth, use.use);
        if (sobol) {
            samplerKernels().pairs(lanes.scramble, lanes.index, lanes.count, at >> 1, lanes.seeds, use.x, use.y);
            continue;
        }
        for (int i = 0; i < lanes.count; ++i) {
            const Vec2 pair = stream(i).get2(at);
            use.x[i] = pair.x;
            if (use.y) use.y[i] = pair.y;
        }
    }
    if (!roulette) std::fill_n(lanes.rouletteX, lanes.count, 0.0f);
}

void Integrator::shadePlain(PathBatch& batch, int depth) const {
    PlainLanes& lanes = batch.plain;
    if (lanes.count == 0) return;
    const bool lastRay = depth + 1 >= settings_.maxDepth && depth + 1 >= needs_.vertexDepths;
    const bool goesOn = !lastRay || scene_.lights.hittable();
    const AlbedoView albedos = SchlickAlbedo::get().view();
    const PlainSettings settings{settings_.multipleScattering, settings_.strategy == DirectStrategy::Mis,
                                 settings_.roulette && depth + 1 >= settings_.rouletteDepth};
    drawNumbers(batch, depth, usesLightSamples_, settings.roulette);
    const PlainLobeKernels& kernels = lanes.glossy ? plainLobeKernels() : plainDiffuseKernels();
    kernels.prepare(lanes, albedos, settings);
    if (depth < needs_.albedoDepths)
        for (int i = 0; i < lanes.count; ++i) {
            PathVertex& vertex = batch.vertices[lanes.row[i]];
            vertex.albedo = lanes.diffuseAlbedo.get<Vec3>(i);
            vertex.specularAlbedo = lanes.specularAlbedo.get<Vec3>(i);
        }
    if (usesLightSamples_) {
        samplePlainLights(batch);
        kernels.light(lanes, albedos, settings);
        pendPlainLights(batch, depth);
    }
    if (goesOn) {
        kernels.scatter(lanes, albedos, settings);
        for (int i = 0; i < lanes.count; ++i)
            if (lanes.next[i] != PlainLanes::kEnds) continuePlain(batch, i, depth, lastRay);
    }
    lanes.count = 0;
}

void Integrator::setReceiver(LightReceiver& receiver, const PlainLanes& lanes, int i, float time) const {
    receiver.position = lanes.position.get<Vec3>(i), receiver.normal = lanes.geometricNormal.get<Vec3>(i);
    receiver.time = time;
    receiver.facing = LightReceiver::Facing::Front;
    receiver.sampling = settings_.lightSampling;
}

void Integrator::samplePlainLights(PathBatch& batch) const {
    PlainLanes& lanes = batch.plain;
    const auto count = static_cast<size_t>(lanes.count);
    const auto path = [&](int i) -> const PathState& { return batch.paths[batch.active[lanes.row[i]]]; };
    for (int i = 0; i < lanes.count; ++i) setReceiver(batch.receivers[i], lanes, i, path(i).ray.time);
    scene_.lights.choose(lanes, {batch.receivers, count}, {batch.choices, count});
    scene_.lights.samplePoints({batch.choices, count}, {batch.receivers, count}, batch.lights, lanes);
    if (settings_.strategy == DirectStrategy::Bsdf)
        for (int i = 0; i < lanes.count; ++i)
            if (lanes.lightWeighs[i] > 0) lanes.lightPdf[i] = 0;
    if (!batch.absorbs) return;
    for (int i = 0; i < lanes.count; ++i) {
        const Vec3& absorption = path(i).absorption;
        if (lanes.lightPdf[i] == 0 || isBlack(absorption) || !std::isfinite(lanes.lightDistance[i])) continue;
        lanes.lightRadiance.set(i,
                                lanes.lightRadiance.get<Vec3>(i) * transmittance(absorption, lanes.lightDistance[i]));
    }
}

void Integrator::pendPlainLights(PathBatch& batch, int depth) const {
    const PlainLanes& lanes = batch.plain;
    for (int i = 0; i < lanes.count; ++i) {
        if (lanes.lightValid[i] == 0) continue;
        if (lanes.lightValid[i] < 0) {
            ++batch.nonFinite;
            continue;
        }
        const uint32_t index = batch.active[lanes.row[i]];
        const PathState& path = batch.paths[index];
        const uint32_t entry = batch.choices[i].entry;
        if (depth < needs_.vertexDepths) {
            PathVertex& vertex = batch.vertices[lanes.row[i]];
            vertex.lightSampled = true;
            vertex.lightPosition = batch.lights.position.get<Vec3>(i);
            vertex.lightInfinite = !std::isfinite(lanes.lightDistance[i]);
            vertex.light = static_cast<int>(entry);
            batch.splits.push_back({lanes.lightDiffuse.get<Vec3>(i), lanes.lightSpecular.get<Vec3>(i)});
        }
        PendingLight& pending = batch.pending.emplace_back();
        pending.path = index;
        pending.contribution = lanes.lightContribution.get<Vec3>(i);
        pending.delta = scene_.lights.isDelta(entry);
        pending.diffuseBefore = path.diffuseBefore;
        if (settings_.regularize) pending.specular = path.throughput * lanes.lightSpecular.get<Vec3>(i);
        pending.sky = scene_.lights.isSky(entry);
        if (pending.sky) pending.skyPlace.x = batch.lights.skyU[i], pending.skyPlace.y = batch.lights.skyV[i];
        BatchRay& ray = batch.shadowRays.emplace_back();
        ray.origin = lanes.start.get<Vec3>(i), ray.direction = lanes.shadowDirection.get<Vec3>(i);
        ray.tmax = lanes.shadowLength[i];
        ray.time = path.ray.time;
        ray.id = pcgHash(path.hash + static_cast<uint32_t>(2 * depth + 1));
    }
}

void Integrator::continuePlain(PathBatch& batch, int i, int depth, bool lastRay) const {
    const PlainLanes& lanes = batch.plain;
    PathState& path = batch.paths[batch.active[lanes.row[i]]];
    const bool delta = lanes.next[i] == PlainLanes::kMirrors, diffuse = lanes.next[i] == PlainLanes::kDiffuse;
    // Nothing that the last ray could find.
    if (lastRay && settings_.strategy == DirectStrategy::Light && !delta) return;
    const Vec3 direction = lanes.nextDirection.get<Vec3>(i), weight = lanes.weight.get<Vec3>(i);
    if (depth < needs_.vertexDepths) {
        PathVertex& vertex = batch.vertices[lanes.row[i]];
        vertex.sampledLobe = diffuse ? Lobe::Diffuse : Lobe::SpecularReflection;
        vertex.wi = direction;
        vertex.weight = weight;
        vertex.pdf = lanes.pdf[i];
        if (depth < needs_.shareDepths && !delta) vertex.diffuseShare = lanes.diffuseShare.get<Vec3>(i);
    }
    path.throughput *= weight;
    setReceiver(path.scatter, lanes, i, path.ray.time);
    path.scatterPdf = lanes.pdf[i];
    ++(diffuse ? path.diffuseCount : path.specularCount);
    path.diffuseBefore |= diffuse;
    path.cone.spread = std::max(path.cone.spread, spreadOf(diffuse, lanes.roughness[i]));
    path.ray.origin = lanes.start.get<Vec3>(i);
    path.ray.direction = direction;
    path.ray.tmin = 0;
    path.ray.tmax = kInfinity;
    path.alive = true;
}

}  // namespace lumi
