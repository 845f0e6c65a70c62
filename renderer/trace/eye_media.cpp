#include "trace/eye_media.h"

#include <algorithm>

#include "trace/media_around.h"
#include "trace/path_state.h"
#include "trace/trace_scene.h"

namespace lumi {

EyeMedia::EyeMedia(float first, float last, const std::function<MediumStack(float time)>& at) {
    constexpr int kSteps = 16;
    constexpr float kPrecision = 1.0f / 4096;
    MediumStack before = at(first);
    float begin = first;
    for (int step = 1; step <= kSteps && last > first; ++step) {
        const float end = step == kSteps ? last : first + (last - first) * (static_cast<float>(step) / kSteps);
        const MediumStack after = at(end);
        for (float changed = begin; before != after;) {
            // The first change in (changed, end].
            float same = changed, other = end;
            MediumStack then = after;
            while (other - same > kPrecision) {
                const float middle = 0.5f * (same + other);
                if (const MediumStack there = at(middle); there == before) same = middle;
                else other = middle, then = there;
            }
            spans_.push_back({other, before});
            before = then, changed = other;
        }
        begin = end;
    }
    spans_.push_back({1, before});
}

bool EyeMedia::isAnywhere() const {
    return std::ranges::any_of(spans_, [](const Span& span) { return span.media.innermost() != MediumStack::kNone; });
}

EyeMedia mediaAroundEye(const TraceScene& scene, const FrameSampling& sampling) {
    if (!scene.tables.absorbs) return {};
    const auto moves = [](const PosedInstance& instance) { return instance.track() != nullptr; };
    const bool changes =
        sampling.shutterOpen && (!sampling.cameraTrack.empty() || std::ranges::any_of(scene.posed->instances, moves));
    return EyeMedia(0, changes ? 1 : 0,
                    [&](float time) { return mediaAround(scene, sampling.cameraAt(time).position(), time); });
}

EyeMedia mediaAroundEyes(const TraceScene& scene, std::span<const PathStart> starts, bool areBehind) {
    if (!scene.tables.absorbs) return {};
    std::vector<const Ray*> rays;
    for (const PathStart& start : starts)
        if (hasEye(start)) rays.push_back(&start.ray);
    if (rays.empty()) return {};
    const auto timeOf = [](const Ray* ray) { return ray->time; };
    std::ranges::stable_sort(rays, {}, timeOf);
    return EyeMedia(rays.front()->time, rays.back()->time, [&](float time) {
        const auto next = std::ranges::lower_bound(rays, time, {}, timeOf);
        const Ray& ray = next == rays.end() ? *rays.back() : **next;
        return mediaAround(scene, areBehind ? ray.origin - ray.direction * ray.tmax : ray.origin, ray.time);
    });
}

}  // namespace lumi
