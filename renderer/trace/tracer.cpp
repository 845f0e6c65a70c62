#include "trace/tracer.h"

#include <algorithm>
#include <cassert>
#include <span>
#include <unordered_set>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/huge_pages.h"
#include "base/parallel.h"
#include "base/spares.h"
#include "math/hash.h"
#include "scene/reach.h"
#include "trace/camera_starts.h"
#include "trace/integrator.h"
#include "trace/signals_observer.h"
#include "trace/surface.h"
#include "trace/trace_scene.h"

namespace lumi {
namespace {

/// Rays that closestHits() and occluded() trace at a time.
constexpr int64_t kRayBlock = 1024;

/// What is larger than this goes onto huge pages when it is new: rays are about 8% faster, and 100 MiB take about 50
/// ms.
constexpr size_t kManyBytes = size_t(8) << 20;
constexpr double kGatherSeconds = 0.5;

uint32_t compactBits(uint32_t v) {
    v &= 0x55555555u;
    v = (v | (v >> 1)) & 0x33333333u;
    v = (v | (v >> 2)) & 0x0f0f0f0fu;
    v = (v | (v >> 4)) & 0x00ff00ffu;
    return (v | (v >> 8)) & 0x0000ffffu;
}

/// Tile indices of a grid along the Z curve [Morton 1966]: neighbours in time are neighbours in the image.
std::vector<int> mortonOrder(int columns, int rows) {
    std::vector<int> order;
    order.reserve(static_cast<size_t>(columns) * static_cast<size_t>(rows));
    uint32_t side = 1;
    while (side < static_cast<uint32_t>(std::max(columns, rows))) side *= 2;
    for (uint32_t code = 0; code < side * side; ++code) {
        const int x = static_cast<int>(compactBits(code)), y = static_cast<int>(compactBits(code >> 1));
        if (x < columns && y < rows) order.push_back(y * columns + x);
    }
    return order;
}

/// Do tables and lights of one posed scene serve the other?
bool shadesAlike(const PosedScene& a, const PosedScene& b) {
    if (a.scene != b.scene) return false;
    for (size_t i = 0; i < a.instances.size(); ++i)
        if (a.instances[i].worldFromObject != b.instances[i].worldFromObject ||
            a.instances[i].deformed != b.instances[i].deformed || a.instances[i].track() != b.instances[i].track())
            return false;
    for (size_t i = 0; i < a.lights.size(); ++i)
        if (a.lights[i].worldFromLight != b.lights[i].worldFromLight ||
            a.lights[i].worldFromLightPrevious != b.lights[i].worldFromLightPrevious ||
            a.lights[i].track != b.lights[i].track || a.lights[i].previousTrack != b.lights[i].previousTrack)
            return false;
    return true;
}

/// Texels are read here and there: those of large images go onto huge pages, once however many materials show them.
void gatherTexels(std::span<const TextureView> textures) {
    std::unordered_set<const uint8_t*> gathered;
    for (const TextureView& view : textures)
        for (const TextureView::Level& level : std::span(view.levels).first(static_cast<size_t>(view.levelCount)))
            if (gathered.insert(level.bytes).second)
                gatherOnHugePages(level.bytes,
                                  size_t(4) * static_cast<size_t>(level.width) * static_cast<size_t>(level.height));
}

std::shared_ptr<const PosedScene> emptyScene() {
    auto posed = std::make_shared<PosedScene>();
    posed->scene = std::make_shared<const Scene>();
    return posed;
}

}  // namespace

struct Tracer::Impl {
    TraceScene scene;
    std::atomic<uint64_t> cameraRays{0}, bounceRays{0}, shadowRays{0}, nonFinite{0};

    Spares<PathBatch> spares;

    void makeTables(const std::stop_token& stop = {}) {
        scene.tables = makeSceneTables(*scene.posed, scene.embree);
        scene.lights.build(*scene.posed, scene.tables, stop);
    }
    void add(const TraceCounts& counts) {
        cameraRays.fetch_add(counts.cameraRays, std::memory_order_relaxed);
        bounceRays.fetch_add(counts.bounceRays, std::memory_order_relaxed);
        shadowRays.fetch_add(counts.shadowRays, std::memory_order_relaxed);
        nonFinite.fetch_add(counts.nonFinite, std::memory_order_relaxed);
    }
    bool traceBatches(std::span<const PathStart> starts, std::span<const SurfacePoint> firstPoints,
                      const PathSettings& settings, uint32_t seed, std::span<Vec3> radiance,
                      std::span<PathObserver* const> observers, const std::stop_token& stop,
                      std::span<const Hit> firstHits = {});
};

Tracer::Tracer() : impl_(std::make_unique<Impl>()) {}
Tracer::~Tracer() = default;

void Tracer::bind(std::shared_ptr<const PosedScene> posed, std::stop_token stop) {
    assert(posed);
    TraceScene& scene = impl_->scene;
    if (posed == scene.posed) return;
    if (stop.stop_requested()) throw Error(ErrorKind::Interrupted, {"interrupted", "", "", ""});
    // The old scene's data is in use until Embree and the tables have moved on.
    const std::shared_ptr<const PosedScene> earlier = std::exchange(scene.posed, posed);
    bool attachedAnew = false;
    try {
        attachedAnew = scene.embree.bind(*posed, stop);
        if (!attachedAnew && earlier && shadesAlike(*earlier, *posed)) return;
        impl_->makeTables(stop);
    } catch (...) {
        // What did not fit leaves nothing behind: an empty scene that can be traced.
        scene.posed = emptyScene();
        scene.embree.bind(*scene.posed);
        scene.lights = Lights();
        impl_->makeTables();
        throw;
    }
    if (earlier && earlier->scene == posed->scene) return;
    gatherTexels(scene.tables.textures);
    if (attachedAnew && byteCount() >= kManyBytes) gatherAllOnHugePages(kGatherSeconds);
    parallelFor(static_cast<int64_t>(scene.tables.materials.size()), [&](int64_t i) {
        const MaterialRecord& material = scene.tables.materials[static_cast<size_t>(i)];
        const bool weighted = material.specular < 1 || (material.textures & MaterialRecord::kSpecular) != 0;
        Bsdf::prepare(material.ior, material.transmission > 0, material.solid && weighted);
        if (material.layered) Bsdf::prepareLayers(material.source->hasSheen(), material.source->anisotropy > 0);
    });
}

const PosedScene& Tracer::scene() const {
    assert(impl_->scene.posed);
    return *impl_->scene.posed;
}

bool Tracer::sample(const FrameSampling& sampling, Signals& signals, std::stop_token stop,
                    std::span<PathObserver* const> extra) {
    assert(sampling.jitter != Jitter::Auto && sampling.samplesPerPixel > 0 &&
           sampling.camera.extent == sampling.extent);
    requireReach(sampling.camera, scene().scene->path);
    for (const CameraPose& camera : sampling.cameraTrack) requireReach(camera, scene().scene->path);
    signals.reset(sampling.extent, withDependencies(sampling.wanted), sampling.samplesPerPixel);
    if (sampling.extent.empty()) return true;
    SignalsObserver frame(impl_->scene, sampling, signals);
    std::vector<PathObserver*> observers{&frame};
    observers.insert(observers.end(), extra.begin(), extra.end());
    PathSettings path = sampling.path;
    if (extra.empty() && isGeometryOnly(signals.available())) path.maxDepth = 0;  // no light is asked for
    const Integrator integrator(impl_->scene, path, sampling.seed, observers, mediaAroundEye(impl_->scene, sampling));

    static_assert(SignalsObserver::kTile * SignalsObserver::kTile <= PathBatch::kMost &&
                  SignalsObserver::kTile <= kMostInStartRow);
    const std::vector<int> tiles = mortonOrder(frame.tileColumns(), frame.tileRows());
    std::atomic<size_t> done{0};
    parallelFor(
        static_cast<int64_t>(tiles.size()),
        [&](int64_t index) {
            const int tile = tiles[static_cast<size_t>(index)];
            const int left = tile % frame.tileColumns() * SignalsObserver::kTile;
            const int top = tile / frame.tileColumns() * SignalsObserver::kTile;
            const int right = std::min(left + SignalsObserver::kTile, sampling.extent.width);
            const int bottom = std::min(top + SignalsObserver::kTile, sampling.extent.height);
            std::unique_ptr<PathBatch> batch = impl_->spares.take();
            TraceCounts counts;
            bool whole = true;
            frame.beginTile(tile);
            for (int s = 0; s < sampling.samplesPerPixel && whole; ++s) {
                makeStarts(sampling, {left, top}, {right, bottom}, sampling.firstSample + static_cast<uint64_t>(s),
                           batch->starts);
                whole = integrator.run(*batch, batch->starts, {}, {}, true, counts, stop);
            }
            if (whole) frame.endTile(tile), ++done;
            impl_->add(counts);
            impl_->spares.giveBack(std::move(batch));
        },
        stop);
    return done == tiles.size();
}

bool Tracer::Impl::traceBatches(std::span<const PathStart> starts, std::span<const SurfacePoint> firstPoints,
                                const PathSettings& settings, uint32_t seed, std::span<Vec3> radiance,
                                std::span<PathObserver* const> observers, const std::stop_token& stop,
                                std::span<const Hit> firstHits) {
    const Integrator integrator(scene, settings, seed, observers, mediaAroundEyes(scene, starts, !firstPoints.empty()));
    const auto count = static_cast<int64_t>(starts.size());
    std::atomic<int64_t> done{0};
    // A block ends where its last slot ends, so that no slot is in two batches at a time.
    const auto slotEnd = [&](int64_t i) {
        while (i > 0 && i < count && starts[static_cast<size_t>(i)].slot == starts[static_cast<size_t>(i - 1)].slot)
            ++i;
        return i;
    };
    parallelRanges(
        count, static_cast<int64_t>(PathBatch::kMost),
        [&](int64_t rangeBegin, int64_t rangeEnd) {
            const int64_t begin = observers.empty() ? rangeBegin : slotEnd(rangeBegin);
            const int64_t end = observers.empty() ? rangeEnd : slotEnd(rangeEnd);
            std::unique_ptr<PathBatch> batch = spares.take();
            TraceCounts counts;
            for (int64_t i = begin; i < end;) {
                const auto size = static_cast<size_t>(std::min<int64_t>(end - i, PathBatch::kMost));
                const auto first = static_cast<size_t>(i);
                const bool whole =
                    integrator.run(*batch, starts.subspan(first, size),
                                   firstPoints.empty() ? firstPoints : firstPoints.subspan(first, size),
                                   radiance.empty() ? radiance : radiance.subspan(first, size), firstPoints.empty(),
                                   counts, stop, firstHits.empty() ? firstHits : firstHits.subspan(first, size));
                if (!whole) break;
                done += static_cast<int64_t>(size);
                i += static_cast<int64_t>(size);
            }
            add(counts);
            spares.giveBack(std::move(batch));
        },
        stop);
    return done == count;
}

bool Tracer::tracePaths(std::span<const PathStart> starts, const PathSettings& settings, uint32_t seed,
                        std::span<Vec3> radiance, std::span<PathObserver* const> observers, std::stop_token stop) {
    assert(radiance.empty() || radiance.size() == starts.size());
    return impl_->traceBatches(starts, {}, settings, seed, radiance, observers, stop);
}

bool Tracer::continuePaths(std::span<const PathStart> starts, std::span<const Hit> hits, const PathSettings& settings,
                           uint32_t seed, std::span<Vec3> radiance, std::span<PathObserver* const> observers,
                           std::stop_token stop) {
    assert(hits.size() == starts.size() && (radiance.empty() || radiance.size() == starts.size()));
    return impl_->traceBatches(starts, {}, settings, seed, radiance, observers, stop, hits);
}

bool Tracer::shade(std::span<const SurfacePoint> points, std::span<const Vec3> wo, std::span<const RandomKey> keys,
                   const PathSettings& settings, uint32_t seed, std::span<Vec3> radiance,
                   std::span<PathObserver* const> observers, std::stop_token stop, std::span<const RayCone> cones) {
    assert(points.size() == wo.size() && points.size() == keys.size() &&
           (cones.empty() || cones.size() == points.size()));
    std::vector<PathStart> starts(points.size());
    parallelRanges(static_cast<int64_t>(starts.size()), 4096, [&](int64_t begin, int64_t end) {
        for (auto i = static_cast<size_t>(begin); i < static_cast<size_t>(end); ++i) {
            starts[i].ray.direction = -wo[i];
            starts[i].ray.time = points[i].time;
            if (points[i].valid()) starts[i].ray.origin = surfacePosition(impl_->scene.tables, points[i]);
            starts[i].key = keys[i];
            if (!cones.empty()) starts[i].cone = cones[i];
            if (points[i].valid() && starts[i].cone.spread > 0) {
                starts[i].ray.fromCamera = true;
                starts[i].ray.tmax = starts[i].cone.width / starts[i].cone.spread;  // from the eye, where it is 0
            }
            starts[i].slot = static_cast<uint32_t>(i);
        }
    });
    return impl_->traceBatches(starts, points, settings, seed, radiance, observers, stop);
}

namespace {

void toBatchRays(std::span<const Ray> rays, std::vector<BatchRay>& out, size_t first,
                 std::span<const uint32_t> ids = {}) {
    out.resize(rays.size());
    for (size_t i = 0; i < rays.size(); ++i) {
        const Ray& r = rays[i];
        const uint32_t id = ids.empty() ? pcgHash(static_cast<uint32_t>(first + i)) : ids[first + i];
        out[i] = {r.origin, r.tmin, r.direction, r.time, r.tmax, id, r.fromCamera};
    }
}

}  // namespace

void Tracer::closestHits(std::span<const Ray> rays, std::span<Hit> hits, std::stop_token stop, bool coherent,
                         std::span<const uint32_t> ids) {
    assert(rays.size() == hits.size() && (ids.empty() || ids.size() == rays.size()));
    parallelRanges(
        static_cast<int64_t>(rays.size()), kRayBlock,
        [&](int64_t begin, int64_t end) {
            const auto first = static_cast<size_t>(begin), count = static_cast<size_t>(end - begin);
            std::vector<BatchRay> batch;
            std::vector<RawHit> raw(count);
            toBatchRays(rays.subspan(first, count), batch, first, ids);
            intersectRays(impl_->scene.embree, batch, raw, coherent ? Coherence::Coherent : Coherence::Incoherent);
            for (size_t i = 0; i < count; ++i) {
                hits[first + i] = Hit();
                if (!raw[i].valid()) continue;
                const Vec3 position = batch[i].origin + batch[i].direction * raw[i].distance;
                hits[first + i] = {surfacePoint(impl_->scene.tables, raw[i], position, batch[i].time), raw[i].distance};
            }
            const auto flown = static_cast<uint64_t>(
                std::count_if(batch.begin(), batch.end(), [](const BatchRay& r) { return r.tmin <= r.tmax; }));
            impl_->add(coherent ? TraceCounts{.cameraRays = flown} : TraceCounts{.bounceRays = flown});
        },
        stop);
}

void Tracer::occluded(std::span<const Ray> rays, std::span<uint8_t> blocked, std::span<SurfacePoint> blockers,
                      std::stop_token stop) {
    assert(rays.size() == blocked.size());
    parallelRanges(
        static_cast<int64_t>(rays.size()), kRayBlock,
        [&](int64_t begin, int64_t end) {
            const auto first = static_cast<size_t>(begin), count = static_cast<size_t>(end - begin);
            std::vector<BatchRay> batch;
            toBatchRays(rays.subspan(first, count), batch, first);
            impl_->add({.shadowRays = count});
            if (blockers.empty()) {
                occludedRays(impl_->scene.embree, batch, blocked.subspan(first, count), Coherence::Incoherent);
                return;
            }
            std::vector<RawHit> raw(count);
            intersectRays(impl_->scene.embree, batch, raw, Coherence::Incoherent);
            for (size_t i = 0; i < count; ++i) {
                blocked[first + i] = raw[i].valid();
                blockers[first + i] = SurfacePoint();
                if (!raw[i].valid()) continue;
                const Vec3 position = batch[i].origin + batch[i].direction * raw[i].distance;
                blockers[first + i] = surfacePoint(impl_->scene.tables, raw[i], position, batch[i].time);
            }
        },
        stop);
}

bool Tracer::has(const SurfacePoint& point) const {
    const auto& instances = impl_->scene.tables.instances;
    return point.valid() && point.instance < instances.size() &&
           (instances[point.instance].body >= 0 || point.primitive < instances[point.instance].triangleCount);
}

bool Tracer::isOnLight(const SurfacePoint& point) const {
    return has(point) && impl_->scene.tables.instances[point.instance].body >= 0;
}

std::optional<SurfacePoint> Tracer::emittingTriangle(int light) const {
    return light < 0 ? std::nullopt : impl_->scene.lights.triangleOf(static_cast<uint32_t>(light));
}

Vec3 Tracer::position(const SurfacePoint& point) const {
    return point.valid() ? surfacePosition(impl_->scene.tables, point) : Vec3(0);
}

Vec3 Tracer::previousPosition(const SurfacePoint& point) const {
    return point.valid() ? previousSurfacePosition(impl_->scene.tables, *impl_->scene.posed, point) : Vec3(0);
}

Vec3 Tracer::normal(const SurfacePoint& point) const {
    return point.valid() ? smoothNormal(impl_->scene.tables, point) : Vec3(0);
}

TraceCounts Tracer::counts() const {
    return {impl_->cameraRays, impl_->bounceRays, impl_->shadowRays, impl_->nonFinite};
}

void Tracer::resetCounts() { impl_->cameraRays = impl_->bounceRays = impl_->shadowRays = impl_->nonFinite = 0; }

uint32_t firstRayId(const RandomKey& key, uint32_t seed) { return pcgHash(pathHash(key, seed)); }

void Tracer::recordRays(RayRecorder* recorder) { impl_->scene.embree.record(recorder); }
const EmbreeScene& Tracer::embree() const { return impl_->scene.embree; }

size_t Tracer::byteCount() const {
    return impl_->scene.embree.byteCount() + impl_->scene.tables.byteCount() + impl_->scene.lights.byteCount();
}

}  // namespace lumi
