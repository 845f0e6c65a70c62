#include "reconstruct/stable/sample_rays.h"

#include <cmath>

namespace lumi {

SampleRays::SampleRays(const CameraPose& camera)
    : camera_(camera), position_(camera.position()), forward_(camera.forward()), pixelSize_(camera.pixelSize()) {
    camera_.aperture = 0;
}

float SampleRays::aim(const SampleLocation& location, Vec2 place, const Vec3& inWorld, PathStart& start) const {
    const bool elsewhere = location.isNew() || location.isSky();
    if (elsewhere || camera_.projection != Projection::Perspective) {
        start = through(place);
        if (location.isSky()) start.ray.direction = inWorld;
        return elsewhere ? kInfinity : glm::dot(inWorld - start.ray.origin, start.ray.direction);
    }
    // through() by way of the sample itself instead of its place. Member by member: a copy would wait for its parts.
    const Vec3 along = inWorld - position_;
    const float distance = glm::length(along);
    const Vec3 direction = distance > 0 ? along * (1 / distance) : forward_;
    start.ray.origin = position_, start.ray.direction = direction;
    start.ray.tmin = 0, start.ray.tmax = kInfinity;
    start.ray.time = 0, start.ray.fromCamera = true;
    start.cone.width = 0, start.cone.spread = pixelSize_ * std::abs(glm::dot(direction, forward_));
    return distance;
}

}  // namespace lumi
