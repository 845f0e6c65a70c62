#include "reconstruct/stable/verification.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "frame/motion.h"
#include "reconstruct/stable/tile_order.h"
#include "trace/tracer.h"

namespace lumi {
namespace {

constexpr int64_t kRays = 1024;
constexpr uint32_t kIdle = ~0u;

/// Samples in the order in which their rays are traced, kIdle where a packet has a lane without one. Packets without any
/// ray are left out.
std::span<const uint32_t> listWork(SampleFrame& frame, const SampleSet& set, VerificationSettings::Batches batches) {
    const auto dense = [&](const PixelRun& run, std::vector<uint32_t>& work) {
        for (uint32_t i = set.first[run.pixel]; i < set.first[run.pixel + run.count]; ++i)
            if (frame.isVerified(i)) work.push_back(i);
    };
    const auto perPixel = [&](const PixelRun& run, std::vector<uint32_t>& work) {
        const uint32_t* first = set.first.data() + run.pixel;
        constexpr uint32_t kLanes = 16;
        uint32_t most = 0;
        for (uint32_t p = 0; p < run.count; ++p) most = std::max(most, first[p + 1] - first[p]);
        for (uint32_t k = 0; k < most; ++k) {
            const size_t begin = work.size();
            bool any = false;
            for (uint32_t p = 0; p < kLanes; ++p) {
                const bool flies = p < run.count && first[p] + k < first[p + 1] && frame.isVerified(first[p] + k);
                work.push_back(flies ? first[p] + k : kIdle);
                any |= flies;
            }
            if (!any) work.resize(begin);
        }
    };
    if (batches == VerificationSettings::Batches::Dense) return frame.list.make(set.extent, dense);
    return frame.list.make(set.extent, perPixel);
}

/// A new sample's location: what its ray met.
void locate(const FrameContext& context, const Ray& ray, const Hit& hit, uint32_t i, SampleFrame& frame, SampleSet& set) {
    const CameraPose &camera = context.camera, &previous = context.previousCamera;
    if (!hit.valid()) {
        set.locations[i] = SampleLocation::ofSky(ray.direction);
        frame.inWorld[i] = ray.direction;
        frame.motions[i] = Vec2(skyMotion(camera, previous, ray.direction));
        return;
    }
    set.locations[i] = SampleLocation::ofPoint(hit.point);
    frame.inWorld[i] = ray.origin + ray.direction * hit.distance;
    frame.motions[i] = Vec2(surfaceMotion(camera, previous, frame.inWorld[i], context.tracer.previousPosition(hit.point)));
}

/// One stretch of the list.
void verifyRange(const FrameContext& context, std::span<const uint32_t> work, float epsilon, SampleFrame& frame, SampleSet& set) {
    const CameraPose camera = pinhole(context.camera);
    std::vector<Ray> rays(work.size());
    std::vector<Hit> hits(work.size());
    std::vector<float> distances(work.size());
    std::vector<uint32_t> ids(work.size(), 0);
    for (size_t k = 0; k < work.size(); ++k) {
        const uint32_t i = work[k];
        rays[k].tmin = 1, rays[k].tmax = 0;
        if (i == kIdle) continue;
        rays[k] = rayToSample(camera, set.locations[i], set.places[i], frame.inWorld[i], distances[k]).ray;
        rays[k].tmax = distances[k] * (1 + epsilon);
        ids[k] = set.lights[i].name;
    }
    context.tracer.closestHits(rays, hits, context.stop, true, ids);
    for (size_t k = 0; k < work.size(); ++k) {
        const uint32_t i = work[k];
        if (i == kIdle) continue;
        if (frame.verdicts[i] == Verdict::New) {
            locate(context, rays[k], hits[k], i, frame, set);
            continue;
        }
        const bool found = findsSample(context.tracer, set.locations[i], rays[k].direction, hits[k], distances[k], epsilon);
        frame.verdicts[i] = found ? Verdict::Visible : hits[k].valid() ? Verdict::Occluded : Verdict::Missed;
        if (frame.verdicts[i] == Verdict::Occluded) frame.blockers[i] = SampleLocation::ofPoint(hits[k].point);
    }
}

/// The last sample of a pixel moves to what occludes it [DalCorso17, sec. 4.3]: the first of those that are occluded, if
/// none is visible.
void replaceLast(const FrameContext& context, size_t pixel, SampleFrame& frame, SampleSet& set) {
    const uint32_t begin = set.first[pixel], end = set.first[pixel + 1];
    uint32_t last = end;
    for (uint32_t i = begin; i < end; ++i) {
        if (frame.verdicts[i] != Verdict::Occluded && frame.verdicts[i] != Verdict::Missed) return;
        if (last == end && frame.verdicts[i] == Verdict::Occluded) last = i;
    }
    if (last == end || !context.tracer.has(frame.blockers[last].point())) return;
    frame.verdicts[last] = Verdict::Replaced;
    set.locations[last] = frame.blockers[last];
    const uint32_t name = set.lights[last].name, drawn = set.lights[last].pathsDrawn;
    set.lights[last] = {};
    set.lights[last].name = name, set.lights[last].pathsDrawn = static_cast<uint16_t>(drawn);
    const SurfacePoint point = set.locations[last].point();
    frame.inWorld[last] = context.tracer.position(point);
    frame.motions[last] = Vec2(surfaceMotion(context.camera, context.previousCamera, frame.inWorld[last], context.tracer.previousPosition(point)));
}

/// The pixel's word and what the image may show, from the verdicts.
void settle(size_t pixel, SampleFrame& frame, SampleSet& set) {
    uint32_t bits = subpixel::occupied(set.words[pixel]), occlusion = 0;
    for (uint32_t i = set.first[pixel]; i < set.first[pixel + 1]; ++i, bits &= bits - 1) {
        const bool hidden = frame.verdicts[i] == Verdict::Occluded || frame.verdicts[i] == Verdict::Missed;
        frame.hidden[i] = hidden;
        if (hidden) occlusion |= bits & (~bits + 1);
        if (frame.verdicts[i] == Verdict::Missed) set.locations[i] = {};
    }
    set.words[pixel] = subpixel::occupied(set.words[pixel]) | occlusion << subpixel::kCount;
}

}  // namespace

void VerificationSettings::describe(ParameterVisitor& v) {
    v.number("epsilon", epsilon,
             {.label = "Verification tolerance",
              .min = 1e-6,
              .max = 0.5,
              .scale = Scale::Log,
              .help = "How far from a sample its visibility ray may end, in parts of the distance (epsilon of sec. 4.3)"});
    v.choice("batches", batches,
             {.label = "Ray batches",
              .options = {"dense", "per-pixel"},
              .help = "Which visibility rays are traced together: all samples in one list without gaps, or the k-th samples of "
                      "16 pixels with idle lanes as in the paper, whose sec. 7 leaves the balancing open"});
}

bool findsSample(const Tracer& tracer, const SampleLocation& location, const Vec3& direction, const Hit& hit, float distance, float epsilon) {
    if (location.isSky() || !hit.valid()) return location.isSky() && !hit.valid();
    if (hit.point.instance != location.instance || hit.point.primitive != location.primitive)
        return hit.distance >= distance * (1 - epsilon) && hit.distance <= distance * (1 + epsilon);
    if (!tracer.isOnLight(hit.point)) return true;
    const auto faces = [&](const SurfacePoint& point) { return glm::dot(tracer.normal(point), direction) < 0; };
    return faces(location.point()) == faces(hit.point);
}

CameraPose pinhole(const CameraPose& camera) {
    CameraPose pose = camera;
    pose.aperture = 0;
    return pose;
}

PathStart rayToSample(const CameraPose& camera, const SampleLocation& location, Vec2 place, const Vec3& inWorld, float& distance) {
    distance = kInfinity;
    if (camera.projection == Projection::Perspective && !location.isNew() && !location.isSky()) {
        // cameraStart() through the sample itself, without going by way of its place.
        PathStart start;
        start.ray.origin = camera.position();
        const Vec3 along = inWorld - start.ray.origin;
        distance = glm::length(along);
        start.ray.direction = distance > 0 ? along * (1 / distance) : camera.forward();
        start.ray.fromCamera = true;
        start.cone = {0, camera.pixelSize() * std::abs(glm::dot(start.ray.direction, camera.forward()))};
        return start;
    }
    PathStart start = cameraStart(camera, place, Vec2(0.5f), 0);
    if (location.isNew()) return start;
    if (location.isSky()) {
        start.ray.direction = inWorld;
        return start;
    }
    distance = glm::dot(inWorld - start.ray.origin, start.ray.direction);
    return start;
}

bool verifySamples(const FrameContext& context, const VerificationSettings& settings, SampleFrame& frame, SampleSet& set,
                   VerificationCounts& counts) {
    const std::span<const uint32_t> work = listWork(frame, set, settings.batches);
    parallelRanges(static_cast<int64_t>(work.size()), kRays, [&](int64_t begin, int64_t end) {
        verifyRange(context, work.subspan(static_cast<size_t>(begin), static_cast<size_t>(end - begin)), settings.epsilon, frame, set);
    }, context.stop);
    if (context.stop.stop_requested()) return false;
    counts.lanes = work.size();
    counts.rays = static_cast<uint64_t>(work.size() - static_cast<size_t>(std::count(work.begin(), work.end(), kIdle)));
    constexpr int64_t kPixels = 4096;
    parallelRanges(set.extent.area(), kPixels, [&](int64_t begin, int64_t end) {
        for (auto pixel = static_cast<size_t>(begin); pixel < static_cast<size_t>(end); ++pixel) {
            replaceLast(context, pixel, frame, set);
            settle(pixel, frame, set);
        }
    });
    return true;
}

}  // namespace lumi
