// Sampling of the lights that have a body: rectangle, disk and sphere.
#include <algorithm>
#include <cmath>

#include "math/warp.h"
#include "trace/lights.h"
#include "trace/spherical_rectangle.h"
#include "trace/surface.h"

namespace lumi {
namespace {

/// 1 - cos of the half-angle of the cone that a sphere fills; 0 from inside it.
float coneOfSphere(const LightShape& sphere, const Vec3& position) {
    const Vec3 toCentre = sphere.centre - position;
    const float distance2 = glm::dot(toCentre, toCentre), sine2 = sqr(sphere.radius) / distance2;
    return sine2 < 1 ? sine2 / (1 + std::sqrt(1 - sine2)) : 0;
}

SphericalRectangle rectangleFrom(const LightShape& shape, const Vec3& position) {
    return SphericalRectangle(position, shape.centre - shape.halfX - shape.halfY, 2.0f * shape.halfX,
                              2.0f * shape.halfY);
}

bool sampleSphereLight(const LightShape& sphere, const Vec3& position, Vec2 u, LightSample& out) {
    const float oneMinusCos = coneOfSphere(sphere, position);
    if (!(oneMinusCos > 0)) return false;
    const Vec3 toCentre = sphere.centre - position;
    const float centreDistance = glm::length(toCentre);
    const Vec3 local = sampleCone(u, oneMinusCos);
    out.direction = glm::normalize(Frame(toCentre / centreDistance).toWorld(local));
    out.pdf = pdfCone(oneMinusCos);
    // Where the direction meets the sphere: the nearer root, its discriminant by the distance from axis to line.
    const float along = centreDistance * local.z;
    const float across2 = sqr(centreDistance) * std::max(0.0f, 1 - sqr(local.z));
    out.distance = along - std::sqrt(std::max(0.0f, sqr(sphere.radius) - across2));
    const Vec3 normal = glm::normalize(position + out.direction * out.distance - sphere.centre);
    out.position = sphere.centre + sphere.radius * normal;
    out.target = sphere.centre + normal * (sphere.radius * 1.0002f);
    return true;
}

}  // namespace

bool Lights::sampleBody(const BodyRecord& body, const LightReceiver& receiver, Vec2 u, LightSample& out) const {
    const LightShape shape = body.at(receiver.time);
    const Vec3& position = receiver.position;
    out.radiance = shape.radiance;
    out.hittable = body.instance != BodyRecord::kNone;
    if (shape.type == LightType::Sphere) return sampleSphereLight(shape, position, u, out);

    // Flat lights shine to one side only.
    const float height = glm::dot(position - shape.centre, shape.normal);
    if (!(height > 0) || !(shape.area > 0)) return false;
    bool byArea = true;
    if (shape.type == LightType::Rectangle && shape.rightAngled) {
        const SphericalRectangle rectangle = rectangleFrom(shape, position);
        if (rectangle.solidAngle() > SphericalRectangle::kLeast) {
            out.position = rectangle.sample(u);
            out.pdf = 1 / rectangle.solidAngle();
            byArea = false;
        }
    }
    if (byArea) {
        const Vec2 p = shape.type == LightType::Disk ? sampleDisk(u) : 2.0f * u - Vec2(1);
        out.position = shape.centre + p.x * shape.halfX + p.y * shape.halfY;
    }
    if (shape.texture) out.radiance = shape.radianceAt(shape.nameOf(out.position));
    const Vec3 toLight = out.position - position;
    const float distance2 = glm::dot(toLight, toLight);
    out.distance = std::sqrt(distance2);
    out.direction = toLight / out.distance;
    if (byArea) out.pdf = distance2 * out.distance / (shape.area * height);
    out.target = offsetOrigin(out.position, shape.normal);
    return true;
}

float Lights::pdfBody(int bodyIndex, const LightReceiver& receiver, const Vec3& direction,
                      const Vec3& hitPosition) const {
    const Vec3& position = receiver.position;
    const BodyRecord& body = tables_->bodies[static_cast<size_t>(bodyIndex)];
    const LightShape shape = body.at(receiver.time);
    const float pick = pickProbability(receiver, firstBody_ + static_cast<uint32_t>(bodyIndex));
    if (!(pick > 0)) return 0;
    if (shape.type == LightType::Sphere) {
        const float oneMinusCos = coneOfSphere(shape, position);
        return oneMinusCos > 0 ? pick * pdfCone(oneMinusCos) : 0;
    }
    const float height = glm::dot(position - shape.centre, shape.normal);
    if (!(height > 0)) return 0;
    if (shape.type == LightType::Rectangle && shape.rightAngled) {
        const SphericalRectangle rectangle = rectangleFrom(shape, position);
        if (rectangle.solidAngle() > SphericalRectangle::kLeast) return pick / rectangle.solidAngle();
    }
    const Vec3 toLight = hitPosition - position;
    const float distance2 = glm::dot(toLight, toLight);
    return pick * distance2 * std::sqrt(distance2) / (shape.area * height);
}

}  // namespace lumi
