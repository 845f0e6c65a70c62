#include <algorithm>
#include <cmath>

#include "math/hash.h"
#include "math/warp.h"
#include "trace/sampler.h"
#include "trace/tracer.h"

namespace lumi {
namespace {

/// Radical inverse of `index` in `base`, in [0, 1).
float radicalInverse(uint32_t base, uint64_t index) {
    double result = 0, digitWeight = 1.0 / base;
    for (; index > 0; index /= base, digitWeight /= base) result += static_cast<double>(index % base) * digitWeight;
    return static_cast<float>(result);
}

/// A regular polygon inside the unit circle, uniform in area: a wedge, and a point of its triangle.
Vec2 samplePolygon(Vec2 u, int corners, float rotation) {
    const float at = u.x * static_cast<float>(corners);
    const int wedge = std::min(static_cast<int>(at), corners - 1);
    const Vec2 b = sampleTriangle({at - static_cast<float>(wedge), u.y});
    const float step = 2 * kPi / static_cast<float>(corners), angle = rotation + static_cast<float>(wedge) * step;
    return b.x * Vec2(std::cos(angle), std::sin(angle)) + b.y * Vec2(std::cos(angle + step), std::sin(angle + step));
}

}  // namespace

PathStart cameraStart(const CameraPose& camera, Vec2 pixelPosition, Vec2 lens, float time) {
    const float scale = camera.pixelSize();
    const Vec2 centre(0.5f * static_cast<float>(camera.extent.width), 0.5f * static_cast<float>(camera.extent.height));
    // Where the pixel lies on the plane at view depth 1 (perspective) or on the film (orthographic), camera space.
    const Vec2 film((pixelPosition.x - centre.x) * scale, (centre.y - pixelPosition.y) * scale);

    const bool perspective = camera.projection == Projection::Perspective;
    Vec3 origin = perspective ? Vec3(0) : Vec3(film, 0);
    Vec3 direction = perspective ? Vec3(film, -1) : Vec3(0, 0, -1);
    if (camera.aperture > 0) {
        // The lens ray meets the pinhole ray on the plane in focus.
        const Vec3 inFocus = origin + direction * camera.focus;
        const Vec2 onLens =
            camera.blades > 0 ? samplePolygon(lens, camera.blades, camera.bladeRotation) : sampleDisk(lens);
        origin += Vec3(camera.aperture * onLens, 0);
        direction = inFocus - origin;
    }

    PathStart start;
    const float inverseLength = 1 / glm::length(direction);
    start.ray.origin = transformPoint(camera.worldFromCamera, origin);
    start.ray.direction = glm::normalize(transformVector(camera.worldFromCamera, direction * inverseLength));
    start.ray.time = time;
    start.ray.fromCamera = true;
    // A pixel's footprint is pixelSize at view depth 1, and the ray gains view depth at the cosine of its angle.
    const float cosine = std::abs(direction.z) * inverseLength;
    start.cone = perspective ? RayCone{0, scale * cosine} : RayCone{scale, 0};
    return start;
}

namespace {

CameraPose along(const CameraTrack& track, float time) {
    const TrackPlace place = trackPlace(track.size(), time);
    if (!(place.fraction > 0)) return track[place.first];
    return interpolate(track[place.first], track[place.first + 1], place.fraction);
}

}  // namespace

CameraPose FrameSampling::cameraAt(float time) const { return cameraTrack.empty() ? camera : along(cameraTrack, time); }

CameraPose FrameSampling::previousCameraAt(float time) const {
    return previousCameraTrack.empty() ? previousCamera : along(previousCameraTrack, time);
}

float FrameSampling::timeOf(int x, int y, uint64_t sample) const {
    if (!shutterOpen) return 0;
    const RandomKey key{static_cast<uint32_t>(x), static_cast<uint32_t>(y), static_cast<uint32_t>(sample)};
    return SampleStream(path.sampler, path.haltonLoop, seed, key).get1(dimension::kTime);
}

Vec2 frameJitter(uint64_t sampleIndex, uint32_t seed) {
    // 6^6 indices: six digits of base 2 and base 3 each come back after so many.
    const uint64_t index = (seed == 0 ? 0 : mixBits(seed) % 46656) + sampleIndex % 16 + 1;
    return {radicalInverse(2, index) - 0.5f, radicalInverse(3, index) - 0.5f};
}

}  // namespace lumi
