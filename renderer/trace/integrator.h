#pragma once
#include <span>
#include <stop_token>
#include <vector>

#include "trace/eye_media.h"
#include "trace/first_hit_judge.h"
#include "trace/path_state.h"
#include "trace/sampler.h"
#include "trace/settings.h"
#include "trace/surface.h"
#include "trace/trace_scene.h"
#include "trace/tracer.h"

namespace lumi {

/// The one path integrator [Kajiya 1986; Veach 1997, chapters 8 to 10]: next-event estimation with multiple importance
/// sampling (power heuristic) at every surface, Russian roulette by throughput, depth limits by lobe kind.
/// It advances a batch of paths bounce by bounce: find hits, shade, trace the light samples together, continue.
///
/// Camera and first-hit shadow rays of a batch go in packets, later ones as singles. Each path's result depends on its
/// start alone, not on the batch. Contributions that are not finite are dropped and counted.
///
/// A FirstHitJudge among the observers, in the first place, decides what the first rays have found.
class Integrator {
public:
    /// `around` are the solids that camera rays begin in.
    Integrator(const TraceScene& scene, const PathSettings& settings, uint32_t seed,
               std::span<PathObserver* const> observers, EyeMedia around);

    /// Traces up to PathBatch::kMost paths. With `firstPoints` the first vertices are given: start i sees
    /// firstPoints[i] from along its ray's direction. `radiance` may be empty; `coherent` says that neighbouring starts
    /// look alike. With `firstHits` it is known what the starts' rays meet. Returns false if stopped between bounces.
    bool run(PathBatch& batch, std::span<const PathStart> starts, std::span<const SurfacePoint> firstPoints,
             std::span<Vec3> radiance, bool coherent, TraceCounts& counts, const std::stop_token& stop = {},
             std::span<const Hit> firstHits = {}) const;

private:
    static void takeHits(PathBatch& batch, std::span<const Hit> hits);
    void findHits(PathBatch& batch, int depth, bool coherent, TraceCounts& counts) const;
    void findJudgedHits(PathBatch& batch, std::span<const PathStart> starts, bool coherent, TraceCounts& counts) const;
    /// Rows [begin, end) of the batch.
    struct Rows {
        uint32_t begin = 0, end = 0;
    };
    void shadeRows(PathBatch& batch, Rows rows, int depth, std::span<const SurfacePoint> firstPoints) const;
    void arrive(PathBatch& batch, Rows rows, int depth) const;
    bool isDark(const InstanceRecord& instance, uint32_t primitive, int depth) const;
    void shade(PathBatch& batch, uint32_t index, int depth, std::span<const SurfacePoint> firstPoints) const;
    void shadeMiss(PathState& path, int depth, PathVertex* vertex, PathBatch& batch) const;
    /// A point of a surface that a path found shining.
    struct Found {
        SurfacePoint point;
        Vec3 position, outwardNormal, emitted;
        int body = -1;
        float area = 0;  ///< of the triangle, m^2; 0: not known
    };
    void addEmission(PathState& path, const Found& found, int depth, PathVertex* vertex, PathBatch& batch) const;
    void sampleLight(PathBatch& batch, uint32_t index, const Surface& surface, const Frame& frame, const Bsdf& bsdf,
                     int depth, PathVertex* vertex) const;
    bool continuePath(PathState& path, const Surface& surface, const Frame& frame, const Bsdf& bsdf, const Vec3& wo,
                      int depth, PathVertex* vertex) const;
    void describeVertex(const PathState& path, const Surface& surface, const Vec3& wo, int depth,
                        PathVertex& vertex) const;
    // Vertices on plain surfaces, all of a batch together (integrator_plain.cpp).
    void collectPlain(PathBatch& batch, uint32_t row, const InstanceRecord& instance,
                      const MaterialRecord& material) const;
    void placePlain(PathBatch& batch, int depth) const;
    void addPlainEmission(PathBatch& batch, int lane, int depth) const;
    void describePlain(const PathBatch& batch, int lane, int depth, PathVertex& vertex) const;
    void fillLane(PlainLanes& lanes, int lane, uint32_t row, const PathState& path) const;
    void addPlain(PathBatch& batch, uint32_t row, const Surface& surface) const;
    void shadePlain(PathBatch& batch, int depth) const;
    void drawNumbers(PathBatch& batch, int depth, bool lights, bool roulette) const;
    void setReceiver(LightReceiver& receiver, const PlainLanes& lanes, int lane, float time) const;
    void samplePlainLights(PathBatch& batch) const;
    void pendPlainLights(PathBatch& batch, int depth) const;
    void continuePlain(PathBatch& batch, int lane, int depth, bool lastRay) const;
    static float spreadOf(bool diffuse, float roughness);
    void addLights(PathBatch& batch, int depth) const;
    Vec3 straightThrough(const Surface& surface, const Vec3& direction) const;
    void passThinWalls(PathBatch& batch, int depth, TraceCounts& counts) const;
    void traceShadows(PathBatch& batch, int depth, bool coherent, TraceCounts& counts) const;
    LightReceiver receiverAt(const PathState& path, const Surface& surface) const;
    float misWeight(float pdf, float otherPdf) const;
    Vec3 limited(const PathState& path, const Vec3& radiance, int depth) const;
    void add(PathBatch& batch, PathState& path, const Vec3& contribution) const;
    void report(PathBatch& batch, int depth) const;

    const TraceScene& scene_;
    const PathSettings settings_;
    const uint32_t seed_;
    const EyeMedia around_;
    FirstHitJudge* const judge_;
    const std::span<PathObserver* const> observers_;  ///< but the judge
    ObserverNeeds needs_;
    bool usesLightSamples_ = true;
};

}  // namespace lumi
