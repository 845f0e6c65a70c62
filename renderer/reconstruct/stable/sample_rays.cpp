#include "reconstruct/stable/sample_rays.h"

namespace lumi {

SampleRays::SampleRays(const CameraPose& camera)
    : camera_(camera),
      position_(camera.position()),
      forward_(camera.forward()),
      pixelSize_(camera.pixelSize()),
      perspective_(camera.projection == Projection::Perspective) {
    camera_.aperture = 0;
}

/// Of samples that are new or in the sky, and of all that an orthographic camera sees.
float SampleRays::aimThrough(const SampleLocation& location, Vec2 place, const Vec3& inWorld, PathStart& start) const {
    start = through(place);
    if (location.isSky()) start.ray.direction = inWorld;
    return location.isNew() || location.isSky() ? kInfinity : glm::dot(inWorld - start.ray.origin, start.ray.direction);
}

}  // namespace lumi
