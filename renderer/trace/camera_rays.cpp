#include <cmath>

#include "math/warp.h"
#include "trace/tracer.h"

namespace lumi {
namespace {

/// Radical inverse of `index` in `base`, in [0, 1).
float radicalInverse(uint32_t base, uint64_t index) {
    double result = 0, digitWeight = 1.0 / base;
    for (; index > 0; index /= base, digitWeight /= base) result += static_cast<double>(index % base) * digitWeight;
    return static_cast<float>(result);
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
        origin += Vec3(camera.aperture * sampleDisk(lens), 0);
        direction = inFocus - origin;
    }

    PathStart start;
    const float inverseLength = 1 / glm::length(direction);
    start.ray.origin = transformPoint(camera.worldFromCamera, origin);
    start.ray.direction = glm::normalize(transformVector(camera.worldFromCamera, direction * inverseLength));
    start.ray.time = time;
    // A pixel's footprint is pixelSize at view depth 1, and the ray gains view depth at the cosine of its angle.
    const float cosine = std::abs(direction.z) * inverseLength;
    start.cone = perspective ? RayCone{0, scale * cosine} : RayCone{scale, 0};
    return start;
}

Vec2 frameJitter(uint64_t sampleIndex) {
    const uint64_t index = sampleIndex % 16 + 1;
    return {radicalInverse(2, index) - 0.5f, radicalInverse(3, index) - 0.5f};
}

}  // namespace lumi
