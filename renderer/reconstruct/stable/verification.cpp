#include "reconstruct/stable/verification.h"

#include <limits>

#include "frame/motion.h"

namespace lumi {
namespace {

bool isHidden(Verdict verdict) { return verdict == Verdict::Occluded || verdict == Verdict::Missed; }

}  // namespace

void VerificationSettings::describe(ParameterVisitor& v) {
    v.number(
        "epsilon", epsilon,
        {.label = "Verification tolerance",
         .min = 1e-6,
         .max = 0.5,
         .scale = Scale::Log,
         .help = "How far from a sample its visibility ray may end, in parts of the distance (epsilon of sec. 4.3)"});
    v.choice("batches", batches,
             {.label = "Ray batches",
              .options = {"dense", "per-pixel"},
              .help = "Which visibility rays are traced together: all samples of a block of pixels in one list without "
                      "gaps, or the k-th samples of "
                      "16 pixels with idle lanes as in the paper, whose sec. 7 leaves the balancing open"});
}

bool findsSample(const Tracer& tracer, const SampleLocation& location, const Vec3& direction, const Hit& hit,
                 float distance, float epsilon) {
    if (location.isSky() || !hit.valid()) return location.isSky() && !hit.valid();
    if (hit.point.instance != location.instance || hit.point.primitive != location.primitive)
        return hit.distance >= distance * (1 - epsilon) && hit.distance <= distance * (1 + epsilon);
    if (!tracer.isOnLight(hit.point)) return true;
    const auto faces = [&](const SurfacePoint& point) { return glm::dot(tracer.normal(point), direction) < 0; };
    return faces(location.point()) == faces(hit.point);
}

void SampleJudge::nameRays(std::span<const PathStart> starts, std::span<uint32_t> ids) const {
    for (size_t k = 0; k < starts.size(); ++k) ids[k] = starts[k].key.x;
}

void SampleJudge::judge(std::span<const PathStart> starts, std::span<Hit> hits, std::span<uint8_t> goesOn) {
    for (size_t k = 0; k < starts.size(); ++k) {
        const bool idle = starts[k].slot == SampleBatch::kIdle;
        if (idle) goesOn[k] = 0;
        else verify(starts[k], hits[k]);
    }
    if (!anyHidden_) return;
    for (const SampleBatch::Run& run : std::span(batch_.runs, batch_.runCount))
        for (uint32_t k = 0; k < run.count; ++k)
            settle(run.pixel + k, run.slot + set_.first[run.pixel + k] - set_.first[run.pixel], hits);
    for (size_t k = 0; k < starts.size(); ++k)
        if (goesOn[k]) goesOn[k] = !frame_.hidden[batch_.samples[starts[k].slot]];
}

/// One sample by itself.
void SampleJudge::verify(const PathStart& start, Hit& hit) {
    const uint32_t i = batch_.samples[start.slot];
    const float distance = batch_.distances[start.slot];
    if (frame_.verdicts[i] == Verdict::New) return locate(start.ray, hit, i);
    const SampleLocation& location = set_.locations[i];
    if (!frame_.newOnly) {
        const bool onSame = hit.point.instance == location.instance && hit.point.primitive == location.primitive;
        const bool found = (onSame && !(set_.flags[i] & (SampleSet::kOnLight | SampleSet::kSky))) ||
                           findsSample(context_.tracer, location, start.ray.direction, hit, distance, epsilon_);
        frame_.verdicts[i] = found ? Verdict::Visible : hit.valid() ? Verdict::Occluded : Verdict::Missed;
        anyHidden_ |= !found;
        if (!found) return;
    }
    if (location.isSky()) return;
    hit.distance = distance;
    hit.point.instance = location.instance, hit.point.primitive = location.primitive;
    hit.point.barycentrics.x = location.u, hit.point.barycentrics.y = location.v;
}

/// A new sample's location: what its ray met.
void SampleJudge::locate(const Ray& ray, const Hit& hit, uint32_t i) {
    const CameraPose &camera = context_.camera, &previous = context_.previousCamera;
    if (!hit.valid()) {
        set_.locations[i] = SampleLocation::ofSky(ray.direction);
        set_.inWorld[i] = ray.direction;
        set_.flags[i] = SampleSet::kSky;
        if (frame_.wantsMotions) frame_.motions[i] = Vec2(skyMotion(camera, previous, ray.direction));
        return;
    }
    set_.locations[i] = SampleLocation::ofPoint(hit.point);
    set_.inWorld[i] = context_.tracer.position(hit.point);
    set_.flags[i] = context_.tracer.isOnLight(hit.point) ? SampleSet::kOnLight : 0;
    if (!frame_.wantsMotions) return;
    const Vec3 position = ray.origin + ray.direction * hit.distance;
    frame_.motions[i] = Vec2(surfaceMotion(camera, previous, position, context_.tracer.previousPosition(hit.point)));
}

/// The pixel's word and what the image may show, from the verdicts. The last sample of a pixel moves to what occludes
/// it [DalCorso17, sec. 4.3]: the first of those that are occluded, if none is visible.
void SampleJudge::settle(uint32_t pixel, uint32_t slot, std::span<Hit> hits) {
    const uint32_t begin = set_.first[pixel], end = set_.first[pixel + 1];
    bool any = false;
    uint32_t last = end;
    for (uint32_t i = begin; i < end; ++i) {
        any |= !isHidden(frame_.verdicts[i]);
        if (last == end && frame_.verdicts[i] == Verdict::Occluded) last = i;
    }
    if (!any && last < end && !frame_.newOnly) replace(last, hits[batch_.startOf[slot + last - begin]]);
    uint32_t bits = subpixel::occupied(set_.words[pixel]), occlusion = 0;
    for (uint32_t i = begin; i < end; ++i, bits &= bits - 1) {
        frame_.hidden[i] = isHidden(frame_.verdicts[i]);
        if (!frame_.hidden[i]) continue;
        occlusion |= bits & (~bits + 1);
        set_.flags[i] |= SampleSet::kOccluded;
        if (frame_.verdicts[i] == Verdict::Missed) evict(i);
    }
    uint32_t& word = set_.words[pixel];
    word = subpixel::occupied(word) | occlusion << subpixel::kCount;
}

/// What the next reprojection drops.
void SampleJudge::evict(uint32_t i) {
    set_.locations[i] = {};
    set_.inWorld[i] = Vec3(std::numeric_limits<float>::quiet_NaN());
}

void SampleJudge::replace(uint32_t i, const Hit& blocker) {
    frame_.verdicts[i] = Verdict::Replaced;
    set_.locations[i] = SampleLocation::ofPoint(blocker.point);
    const Vec3 position = set_.inWorld[i] = context_.tracer.position(blocker.point);
    set_.flags[i] = context_.tracer.isOnLight(blocker.point) ? SampleSet::kOnLight : 0;
    SampleNote& note = set_.notes[i];
    note.age = note.directCount = note.indirectCount = 0;
    set_.direct[i] = Vec3(0);
    if (!set_.indirect.empty()) set_.indirect[i] = Vec3(0);
    if (!frame_.wantsMotions) return;
    frame_.motions[i] = Vec2(surfaceMotion(context_.camera, context_.previousCamera, position,
                                           context_.tracer.previousPosition(blocker.point)));
}

}  // namespace lumi
