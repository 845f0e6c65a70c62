#include "reconstruct/stable/verification.h"

#include "frame/motion.h"

namespace lumi {
namespace {

bool isHidden(Verdict verdict) { return verdict == Verdict::Occluded || verdict == Verdict::Missed; }

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
    for (const SampleBatch::Pixel& pixel : std::span(batch_.pixels, batch_.pixelCount)) settle(pixel, hits);
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
        const bool found = findsSample(context_.tracer, location, start.ray.direction, hit, distance, epsilon_);
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
        if (frame_.wantsMotions) frame_.motions[i] = Vec2(skyMotion(camera, previous, ray.direction));
        return;
    }
    set_.locations[i] = SampleLocation::ofPoint(hit.point);
    if (!frame_.wantsMotions) return;
    const Vec3 position = ray.origin + ray.direction * hit.distance;
    frame_.motions[i] = Vec2(surfaceMotion(camera, previous, position, context_.tracer.previousPosition(hit.point)));
}

/// The pixel's word and what the image may show, from the verdicts. The last sample of a pixel moves to what occludes it
/// [DalCorso17, sec. 4.3]: the first of those that are occluded, if none is visible.
void SampleJudge::settle(const SampleBatch::Pixel& at, std::span<Hit> hits) {
    const uint32_t begin = set_.first[at.pixel], end = set_.first[at.pixel + 1];
    bool any = false;
    uint32_t last = end;
    for (uint32_t i = begin; i < end; ++i) {
        any |= !isHidden(frame_.verdicts[i]);
        if (last == end && frame_.verdicts[i] == Verdict::Occluded) last = i;
    }
    if (!any && last < end && !frame_.newOnly) replace(last, hits[batch_.startOf[at.slot + last - begin]]);
    uint32_t bits = subpixel::occupied(set_.words[at.pixel]), occlusion = 0;
    for (uint32_t i = begin; i < end; ++i, bits &= bits - 1) {
        frame_.hidden[i] = isHidden(frame_.verdicts[i]);
        if (frame_.hidden[i]) occlusion |= bits & (~bits + 1);
        if (frame_.verdicts[i] == Verdict::Missed) set_.locations[i] = {};
    }
    uint32_t& word = set_.words[at.pixel];
    word = subpixel::occupied(word) | occlusion << subpixel::kCount;
}

void SampleJudge::replace(uint32_t i, const Hit& blocker) {
    frame_.verdicts[i] = Verdict::Replaced;
    set_.locations[i] = SampleLocation::ofPoint(blocker.point);
    const uint32_t name = set_.lights[i].name;
    const uint16_t drawn = set_.lights[i].pathsDrawn;
    set_.lights[i] = {};
    set_.lights[i].name = name, set_.lights[i].pathsDrawn = drawn;
    if (!frame_.wantsMotions) return;
    const Vec3 position = context_.tracer.position(blocker.point);
    frame_.motions[i] = Vec2(surfaceMotion(context_.camera, context_.previousCamera, position, context_.tracer.previousPosition(blocker.point)));
}

}  // namespace lumi
