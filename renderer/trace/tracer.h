#pragma once
#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <stop_token>

#include "frame/signals.h"
#include "scene/posed_scene.h"
#include "trace/observer.h"
#include "trace/ray.h"
#include "trace/settings.h"

namespace lumi {

class EmbreeScene;
class RayRecorder;

/// One path to trace.
struct PathStart {
    Ray ray;
    RayCone cone;
    RandomKey key;
    uint32_t slot = 0;  ///< the caller's index for it, handed to observers
};

/// What one frame of signals is made from.
struct FrameSampling {
    Extent2 extent;
    CameraPose camera, previousCamera;  ///< on a cut both are equal
    uint32_t frame = 0;
    int samplesPerPixel = 1;
    uint64_t firstSample = 0;  ///< index of the frame's first sample in each pixel's sequence: frame * spp
    uint32_t seed = 0;
    Jitter jitter = Jitter::PerPixel;  ///< not Auto
    PathSettings path;
    SignalSet wanted;
    /// Camera rays fly at times in [0, 1) of the open shutter, else at 0; and the cameras over that time, if they move:
    /// `camera` and `previousCamera` are those of the opening then.
    bool shutterOpen = false;
    CameraTrack cameraTrack, previousCameraTrack;

    CameraPose cameraAt(float time) const;
    CameraPose previousCameraAt(float time) const;
    /// When the camera ray of a pixel's sample flies.
    float timeOf(int x, int y, uint64_t sample) const;
};

struct TraceCounts {
    uint64_t cameraRays = 0, bounceRays = 0, shadowRays = 0;
    uint64_t nonFinite = 0;  ///< path contributions that were NaN or infinite and were dropped
    uint64_t total() const { return cameraRays + bounceRays + shadowRays; }
};

/// Traces and shades batches in one posed scene. All functions may be called from any thread and run on the whole pool;
/// results depend only on their arguments.
class Tracer {
public:
    Tracer();
    ~Tracer();
    Tracer(const Tracer&) = delete;
    Tracer& operator=(const Tracer&) = delete;

    /// Makes `posed` the scene that is traced: builds, refits or keeps each part of the Embree scene and the lights by
    /// what changed against the last call. Throws Error(Resources) if it does not fit the memory limit, and
    /// Error(Interrupted) once stopped: the scene before stays if nothing was done yet; else, as after any error, an
    /// empty scene is bound.
    void bind(std::shared_ptr<const PosedScene> posed, std::stop_token stop = {});
    const PosedScene& scene() const;

    /// Renders one frame of signals: `sampling.wanted` plus what they depend on. Returns false if stopped; then
    /// `signals` is unspecified. `extra` observers see every path (slot = y * width + x).
    bool sample(const FrameSampling& sampling, Signals& signals, std::stop_token stop = {},
                std::span<PathObserver* const> extra = {});

    /// Traces whole paths from given rays. `radiance` (may be empty) receives one value a start. Observers see every
    /// vertex; the first may be a FirstHitJudge (here alone). Starts are cut into batches of a fixed size in order;
    /// equal slots must be adjacent.
    bool tracePaths(std::span<const PathStart> starts, const PathSettings& settings, uint32_t seed,
                    std::span<Vec3> radiance, std::span<PathObserver* const> observers, std::stop_token stop = {});

    /// Shades given surface points as seen along -wo[i] (unit, world, away from the surface), path continuing from
    /// there: a path whose first vertex is given. Invalid points give 0. `cones` (may be empty: points without extent)
    /// are the footprints on arrival; with those of a camera ray and its key the result is that of the camera's path.
    bool shade(std::span<const SurfacePoint> points, std::span<const Vec3> wo, std::span<const RandomKey> keys,
               const PathSettings& settings, uint32_t seed, std::span<Vec3> radiance,
               std::span<PathObserver* const> observers, std::stop_token stop = {},
               std::span<const RayCone> cones = {});

    /// tracePaths() from where closestHits() found that the rays of `starts` end: hits[i] is that of starts[i].ray, an
    /// invalid one left the scene. The result is tracePaths()'s if closestHits() was given the ids firstRayId().
    bool continuePaths(std::span<const PathStart> starts, std::span<const Hit> hits, const PathSettings& settings,
                       uint32_t seed, std::span<Vec3> radiance, std::span<PathObserver* const> observers,
                       std::stop_token stop = {});

    /// Nearest hits. `coherent`: neighbours among the rays start alike and go alike, as camera rays do; it is faster
    /// then, and they count as camera rays. Rays with tmin > tmax meet nothing and are not counted. `ids` (may be
    /// empty: by place in the call) draw which blended surfaces a ray stops at: the same id always draws the same.
    void closestHits(std::span<const Ray> rays, std::span<Hit> hits, std::stop_token stop = {}, bool coherent = false,
                     std::span<const uint32_t> ids = {});
    /// blocked[i] = 1 if anything lies in (tmin, tmax). With `blockers` (may be empty) the nearest blocker is reported.
    void occluded(std::span<const Ray> rays, std::span<uint8_t> blocked, std::span<SurfacePoint> blockers = {},
                  std::stop_token stop = {});

    /// Is this a point of the scene that is bound? What was kept from an earlier scene may not be.
    bool has(const SurfacePoint& point) const;
    /// Does it lie on the body of a light? All of a body is one primitive.
    bool isOnLight(const SurfacePoint& point) const;
    /// The emissive triangle (instance and primitive) that a light of PathVertex::light is; none if it is another kind.
    std::optional<SurfacePoint> emittingTriangle(int light) const;
    /// World position of a surface point, and of the same point in the previous frame.
    Vec3 position(const SurfacePoint& point) const;
    Vec3 previousPosition(const SurfacePoint& point) const;
    /// Unit shading normal (not flipped) of a surface point.
    Vec3 normal(const SurfacePoint& point) const;

    TraceCounts counts() const;
    void resetCounts();
    /// Bytes held by Embree and by our own tables.
    size_t byteCount() const;

    /// For measurements: the rays themselves, and the scene they are traced in. Null stops recording.
    void recordRays(RayRecorder* recorder);
    const EmbreeScene& embree() const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// What draws the blended surfaces that the first ray of a path stops at.
uint32_t firstRayId(const RandomKey& key, uint32_t seed);

/// Camera ray through continuous pixel `pixelPosition`; `lens` in [0,1)^2.
PathStart cameraStart(const CameraPose& camera, Vec2 pixelPosition, Vec2 lens, float time);

/// Sub-pixel offset of frame `sampleIndex` in [-0.5, 0.5]^2 relative to the pixel centre, shared by all pixels
/// (Jitter::PerFrame): Halton (2, 3), 16 points in a loop. Each seed takes another stretch of the sequence, seed 0
/// its beginning, so that seeds replicate the offset as they do all random numbers.
Vec2 frameJitter(uint64_t sampleIndex, uint32_t seed);

}  // namespace lumi
