#include "trace/light_shape.h"

#include <algorithm>
#include <cmath>

#include "scene/light_body.h"
#include "scene/posed_scene.h"

namespace lumi {
namespace {

/// Octahedral map between unit directions and the unit square [Cigolle 2014].
Vec2 octahedronFromDirection(const Vec3& d) {
    const float scale = 1 / (std::abs(d.x) + std::abs(d.y) + std::abs(d.z));
    Vec2 p(d.x * scale, d.y * scale);
    if (d.z < 0)
        p = Vec2((1 - std::abs(p.y)) * std::copysign(1.0f, p.x), (1 - std::abs(p.x)) * std::copysign(1.0f, p.y));
    return p * 0.5f + Vec2(0.5f);
}

Vec3 directionFromOctahedron(Vec2 uv) {
    const Vec2 p = uv * 2.0f - Vec2(1);
    Vec3 d(p.x, p.y, 1 - std::abs(p.x) - std::abs(p.y));
    if (d.z < 0) {
        const Vec2 folded((1 - std::abs(p.y)) * std::copysign(1.0f, p.x),
                          (1 - std::abs(p.x)) * std::copysign(1.0f, p.y));
        d.x = folded.x, d.y = folded.y;
    }
    return glm::normalize(d);
}

/// Directions of the light's axes: a frame for naming points of spheres.
Frame frameOf(const LightShape& shape) {
    const Frame around(shape.normal);
    const Vec3 x = unitOr(shape.halfX - shape.normal * glm::dot(shape.halfX, shape.normal), around.x);
    return Frame(x, glm::cross(shape.normal, x), shape.normal);
}

}  // namespace

Vec3 LightShape::position(Vec2 uv) const {
    if (type == LightType::Sphere) return centre + radius * normalAt(uv);
    return centre + (2 * uv.x - 1) * halfX + (2 * uv.y - 1) * halfY;
}

Vec3 LightShape::texel(Vec2 uv) const { return Vec3(texture->sample(Vec2(1) - uv)); }

float LightShape::meanLuminance() const {
    const float factor = luminance(radiance);
    if (!texture) return factor;
    // The widest footprint is the whole image; what is dark there may still have small lights in it.
    return luminance(radiance * Vec3(texture->sample(Vec2(0.5f), 1))) + 1e-3f * factor;
}

Vec3 LightShape::normalAt(Vec2 uv) const {
    return type == LightType::Sphere ? frameOf(*this).toWorld(directionFromOctahedron(uv)) : normal;
}

Vec2 LightShape::nameOf(const Vec3& positionWorld) const {
    const Vec3 offset = positionWorld - centre;
    if (type == LightType::Sphere) return octahedronFromDirection(frameOf(*this).toLocal(unitOr(offset, normal)));
    // Coordinates in the skewed basis (halfX, halfY) by Cramer's rule.
    const float xx = glm::dot(halfX, halfX), yy = glm::dot(halfY, halfY), xy = glm::dot(halfX, halfY);
    const float determinant = xx * yy - xy * xy;
    if (!(determinant > 0)) return Vec2(0.5f);
    const float px = glm::dot(offset, halfX), py = glm::dot(offset, halfY);
    return Vec2((px * yy - py * xy) / determinant, (py * xx - px * xy) / determinant) * 0.5f + Vec2(0.5f);
}

namespace {

bool areOrthogonal(const Vec3& a, const Vec3& b) {
    return std::abs(glm::dot(a, b)) <= 1e-5f * glm::length(a) * glm::length(b);
}

float areaOf(const LightShape& flat) {
    return (flat.type == LightType::Disk ? kPi : 4.0f) * glm::length(glm::cross(flat.halfX, flat.halfY));
}

}  // namespace

bool LightShape::isCircle() const {
    const float x = glm::length(halfX), y = glm::length(halfY);
    return rightAngled && std::abs(x - y) <= 1e-5f * std::max(x, y);
}

LightShape lightShape(const Light& light, const Mat4& worldFromLight) {
    const Vec3 axisX(worldFromLight[0]), axisY(worldFromLight[1]);
    LightShape shape;
    shape.type = light.type;
    shape.radiance = light.radiance * light.power;
    if (light.radianceTexture && light.type != LightType::Sphere) shape.texture = &light.radianceTexture;
    shape.centre = Vec3(worldFromLight[3]);
    shape.normal = unitOr(-(normalMatrix(worldFromLight) * Vec3(0, 0, 1)), Vec3(0, 0, -1));
    if (light.type != LightType::Sphere) {
        const bool isDisk = light.type == LightType::Disk;
        shape.back = Vec3(worldFromLight[2]);
        shape.halfX = axisX * (isDisk ? light.radius : 0.5f * light.size.x);
        shape.halfY = axisY * (isDisk ? light.radius : 0.5f * light.size.y);
        shape.area = areaOf(shape);
        shape.rightAngled = areOrthogonal(shape.halfX, shape.halfY);
        if (isDisk) shape.radius = std::sqrt(shape.area / kPi);
        return shape;
    }
    shape.radius = light.radius * sphereScale(worldFromLight);
    shape.area = 4 * kPi * sqr(shape.radius);
    // A frame across the normal, turned with the light.
    shape.halfX = axisX, shape.halfY = axisY;
    const Frame frame = frameOf(shape);
    shape.halfX = frame.x * shape.radius;
    shape.halfY = -frame.y * shape.radius;
    return shape;
}

std::vector<LightShape> lightShapes(const Light& light, std::span<const Mat4> worldFromLight) {
    std::vector<LightShape> shapes;
    for (const Mat4& frame : worldFromLight) shapes.push_back(lightShape(light, frame));
    return shapes;
}

LightShape shapeAt(std::span<const LightShape> shapes, float time) {
    const TrackPlace place = trackPlace(shapes.size(), time);
    if (!(place.fraction > 0)) return shapes[place.first];
    const LightShape &a = shapes[place.first], &b = shapes[place.first + 1];
    const float t = place.fraction;
    LightShape shape = a;
    shape.centre = glm::mix(a.centre, b.centre, t);
    shape.halfX = glm::mix(a.halfX, b.halfX, t);
    shape.halfY = glm::mix(a.halfY, b.halfY, t);
    shape.normal = unitOr(glm::mix(a.normal, b.normal, t), a.normal);
    if (shape.type == LightType::Sphere) {
        shape.radius = glm::mix(a.radius, b.radius, t);
        shape.area = 4 * kPi * sqr(shape.radius);
        return shape;
    }
    // A frame that mirrors on the way turns the light over.
    shape.back = glm::mix(a.back, b.back, t);
    const Vec3 across = glm::cross(shape.halfX, shape.halfY);
    shape.area = areaOf(shape);
    shape.normal = unitOr(glm::dot(across, shape.back) > 0 ? -across : across, a.normal);
    shape.rightAngled = areOrthogonal(shape.halfX, shape.halfY);
    return shape;
}

}  // namespace lumi
