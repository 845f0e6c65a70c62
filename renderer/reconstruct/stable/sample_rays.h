#pragma once
#include <cmath>

#include "reconstruct/stable/sample_set.h"
#include "trace/tracer.h"

namespace lumi {

/// Rays from a camera to samples, which it sees without lens and shutter.
class SampleRays {
public:
    explicit SampleRays(const CameraPose& camera);

    /// The ray that goes to a sample whose location is known, or through the place of a new one, and its footprint.
    /// Returns the sample's distance, infinite for new ones and the sky. `inWorld`: position or direction; not read for
    /// new ones.
    float aim(const SampleLocation& location, Vec2 place, const Vec3& inWorld, PathStart& start) const {
        if (location.isNew() || location.isSky() || !perspective_) return aimThrough(location, place, inWorld, start);
        // through() by way of the sample itself instead of its place. Member by member: a copy would wait for its
        // parts.
        const Vec3 along = inWorld - position_;
        const float distance = glm::length(along);
        const Vec3 direction = distance > 0 ? along * (1 / distance) : forward_;
        start.ray.origin = position_, start.ray.direction = direction;
        start.ray.tmin = 0, start.ray.tmax = kInfinity;
        start.ray.time = 0, start.ray.fromCamera = true;
        start.cone.width = 0, start.cone.spread = pixelSize_ * std::abs(glm::dot(direction, forward_));
        return distance;
    }
    /// The ray through a place on the screen.
    PathStart through(Vec2 place) const { return cameraStart(camera_, place, Vec2(0.5f), 0); }

private:
    float aimThrough(const SampleLocation& location, Vec2 place, const Vec3& inWorld, PathStart& start) const;

    CameraPose camera_;
    Vec3 position_, forward_;
    float pixelSize_;
    bool perspective_;
};

}  // namespace lumi
