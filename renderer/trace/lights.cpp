#include "trace/lights.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "math/warp.h"
#include "trace/surface.h"

namespace lumi {
namespace {

/// Mean luminance that a triangle emits: its emission texture filtered over the triangle's extent. Triangles in
/// darkness near light keep a small share, so that no texel with light is out of reach.
float triangleLuminance(const MaterialRecord& material, const InstanceRecord& instance, const UVec3& t) {
    const float factor = luminance(glm::max(material.emission, Vec3(0)));
    if (!(material.textures & MaterialRecord::kEmission)) return factor;
    const Texture& texture = material.source->emissionTexture;
    const Vec2* uv = instance.uv[texture.uvSet == 1 ? 1 : 0];
    if (!uv) return factor * luminance(Vec3(texture.sample(Vec2(0))));
    const Vec2 a = uv[t.x], b = uv[t.y], c = uv[t.z];
    const Vec2 size = glm::max(a, glm::max(b, c)) - glm::min(a, glm::min(b, c));
    const float extent = std::max(size.x, size.y);
    const Vec2 middle = (a + b + c) * (1.0f / 3.0f);
    const auto filtered = [&](float width) {
        return luminance(material.emission * Vec3(texture.sample(middle, width)));
    };
    return filtered(extent) + 0.05f * filtered(4 * extent) + 1e-4f * factor;
}

}  // namespace

void Lights::build(const PosedScene& posed, const SceneTables& tables) {
    tables_ = &tables;
    environment_.build(posed.scene->environment);
    entries_.clear(), triangles_.clear(), points_.clear(), suns_.clear();
    std::vector<float> weights;
    addTriangles(weights);
    addShapedAndPunctual(posed, weights);
    environmentEntry_ = -1;
    if (!environment_.black()) {
        // What the sky sends into a sphere around the scene.
        const float radius = std::max(posed.bounds.empty() ? 1.0f : posed.bounds.radius(), 1e-3f);
        environmentEntry_ = static_cast<int>(entries_.size());
        entries_.push_back({Kind::Environment, 0});
        weights.push_back(environment_.meanLuminance() * 4 * kPi * kPi * sqr(radius));
    }
    picks_ = AliasTable(weights);
    hasEmitters_ = false;
    for (const MaterialRecord& material : tables.materials) hasEmitters_ |= material.emits;
    for (const BodyRecord& body : tables.bodies) hasEmitters_ |= body.instance != BodyRecord::kNone;
    hittable_ = !environment_.black() || hasEmitters_;
    for (const Sun& sun : suns_) hittable_ |= sun.oneMinusCos > 0;
    hasDelta_ = !points_.empty();
    for (const Sun& sun : suns_) hasDelta_ |= sun.oneMinusCos <= 0;
    for (const BodyRecord& body : tables.bodies) hasDelta_ |= body.instance == BodyRecord::kNone;
}

void Lights::addTriangles(std::vector<float>& weights) {
    const std::vector<InstanceRecord>& instances = tables_->instances;
    firstTriangle_.assign(instances.size(), kNone);
    // Rows of triangles that may emit, by instance.
    size_t total = 0;
    for (size_t i = 0; i < instances.size(); ++i) {
        const InstanceRecord& r = instances[i];
        if (r.body >= 0 || !r.positions) continue;
        bool emits = !r.triangleMaterial && tables_->materials[r.material].emits;
        if (r.triangleMaterial)
            for (const MaterialRecord& m : tables_->materials) emits |= m.emits;
        if (!emits) continue;
        firstTriangle_[i] = static_cast<uint32_t>(total);
        total += r.triangleCount;
    }
    triangleEntry_.assign(total, kNone);
    std::vector<Triangle> all(total);
    std::vector<float> power(total, 0);
    for (size_t i = 0; i < instances.size(); ++i) {
        if (firstTriangle_[i] == kNone) continue;
        const InstanceRecord& r = instances[i];
        parallelRanges(r.triangleCount, 1024, [&, i](int64_t begin, int64_t end) {
            for (int64_t k = begin; k < end; ++k) {
                const auto primitive = static_cast<uint32_t>(k);
                const MaterialRecord& material = tables_->materials[r.materialOf(primitive)];
                if (!material.emits) continue;
                const UVec3 t = r.triangles[primitive];
                Vec3 p[3] = {r.positions[t.x], r.positions[t.y], r.positions[t.z]};
                if (!r.inWorld)
                    for (Vec3& corner : p) corner = transformPoint(r.worldFromObject, corner);
                Triangle& triangle = all[firstTriangle_[i] + primitive];
                triangle = {p[0], p[1] - p[0], p[2] - p[0], static_cast<uint32_t>(i), primitive};
                const float area = 0.5f * glm::length(glm::cross(triangle.edge1, triangle.edge2));
                const float sides = material.doubleSided ? 2 : 1;
                const float watts = kPi * area * sides * triangleLuminance(material, r, t);
                power[firstTriangle_[i] + primitive] = watts > 0 && std::isfinite(watts) ? watts : 0;
            }
        });
    }
    for (size_t k = 0; k < total; ++k) {
        if (power[k] <= 0) continue;
        triangleEntry_[k] = static_cast<uint32_t>(entries_.size());
        entries_.push_back({Kind::Triangle, static_cast<uint32_t>(triangles_.size())});
        triangles_.push_back(all[k]);
        weights.push_back(power[k]);
    }
}

void Lights::addShapedAndPunctual(const PosedScene& posed, std::vector<float>& weights) {
    bodyEntry_.assign(tables_->bodies.size(), kNone);
    for (size_t i = 0; i < tables_->bodies.size(); ++i) {
        const LightShape& shape = tables_->bodies[i].shape;
        bodyEntry_[i] = static_cast<uint32_t>(entries_.size());
        entries_.push_back({Kind::Body, static_cast<uint32_t>(i)});
        weights.push_back(kPi * shape.area * luminance(shape.radiance));
    }
    const float radius = posed.bounds.empty() ? 1.0f : std::max(posed.bounds.radius(), 1e-3f);
    for (size_t i = 0; i < posed.scene->lights.size(); ++i) {
        const Light& light = posed.scene->lights[i];
        const Mat4& frame = posed.lights[i].worldFromLight;
        const Vec3 axis = glm::normalize(-Vec3(frame[2]));
        if (light.type == LightType::Directional) {
            Sun sun;
            sun.towards = -axis;
            sun.irradiance = light.irradiance * light.power;
            if (light.angleDeg > 0) {
                const float half = std::min(radians(light.angleDeg) * 0.5f, kPi / 2);
                sun.oneMinusCos = 2 * sqr(std::sin(half / 2));
                // The irradiance of a cone of constant radiance L on a plane facing it is pi L sin^2.
                sun.radiance = sun.irradiance / (kPi * sqr(std::sin(half)));
            }
            sun.entry = static_cast<int>(entries_.size());
            entries_.push_back({Kind::Directional, static_cast<uint32_t>(suns_.size())});
            suns_.push_back(sun);
            weights.push_back(luminance(sun.irradiance) * kPi * sqr(radius));
        } else if (!hasBody(light.type)) {
            Point point{Vec3(frame[3]), axis, light.intensity * light.power, light.range, 0, 1};
            float solidAngle = 4 * kPi;
            if (light.type == LightType::Spot) {
                // KHR_lights_punctual: smooth between the two cones, squared.
                const float cosOuter = std::cos(radians(light.outerConeDeg));
                const float cosInner = std::cos(radians(std::min(light.innerConeDeg, light.outerConeDeg)));
                point.spotScale = 1 / std::max(1e-4f, cosInner - cosOuter);
                point.spotOffset = -cosOuter * point.spotScale;
                solidAngle = 2 * kPi * (1 - 0.5f * (cosInner + cosOuter));
            }
            entries_.push_back({Kind::Point, static_cast<uint32_t>(points_.size())});
            points_.push_back(point);
            weights.push_back(luminance(point.intensity) * solidAngle);
        }
    }
}

int Lights::entryOf(uint32_t instance, uint32_t primitive) const {
    const uint32_t first = firstTriangle_[instance];
    if (first == kNone || triangleEntry_[first + primitive] == kNone) return -1;
    return static_cast<int>(triangleEntry_[first + primitive]);
}

bool Lights::sample(const Vec3& position, Vec2 pick, Vec2 u, LightSample& out) const {
    if (picks_.empty()) return false;
    const uint32_t chosen = picks_.sample(pick);
    const Entry& entry = entries_[chosen];
    out.light = static_cast<int>(chosen);
    out.delta = false;
    out.hittable = true;
    out.sky = false;
    bool reached = false;
    switch (entry.kind) {
        case Kind::Triangle:
            reached = sampleTriangle(triangles_[entry.index], position, u, out);
            break;
        case Kind::Body:
            reached = sampleBody(tables_->bodies[entry.index], position, u, out);
            break;
        case Kind::Point:
            reached = samplePoint(points_[entry.index], position, out);
            break;
        case Kind::Directional:
            reached = sampleSun(suns_[entry.index], u, out);
            break;
        case Kind::Environment:
            out.direction = out.position = environment_.sample(u, out.pdf, out.skyPlace);
            out.distance = kInfinity;
            out.sky = true;
            reached = out.pdf > 0;
            break;
    }
    out.pdf *= picks_.probability(chosen);
    return reached && out.pdf > 0 && (out.sky || maxComponent(out.radiance) > 0);
}

bool Lights::sampleTriangle(const Triangle& triangle, const Vec3& position, Vec2 u, LightSample& out) const {
    const Vec2 b = lumi::sampleTriangle(u);
    const InstanceRecord& instance = tables_->instances[triangle.instance];
    const MaterialRecord& material = tables_->materials[instance.materialOf(triangle.primitive)];
    out.position = triangle.corner + triangle.edge1 * b.x + triangle.edge2 * b.y;
    const Vec3 toLight = out.position - position;
    const float distance2 = glm::dot(toLight, toLight);
    const Vec3 cross = glm::cross(triangle.edge1, triangle.edge2);
    const float twiceArea = glm::length(cross);
    if (!(distance2 > 0) || !(twiceArea > 0)) return false;
    out.distance = std::sqrt(distance2);
    out.direction = toLight / out.distance;
    const Vec3 normal = cross / twiceArea;
    const float cosine = -glm::dot(normal, out.direction);
    const bool front = instance.mirrored ? cosine < 0 : cosine > 0;
    if (cosine == 0 || (!front && !material.doubleSided)) return false;
    out.pdf = distance2 / (0.5f * twiceArea * std::abs(cosine));
    out.radiance = triangleEmission(*tables_, triangle.instance, triangle.primitive, b);
    out.target = offsetOrigin(out.position, cosine > 0 ? normal : -normal, instance.objectScale * 0x1p-18f);
    return true;
}

bool Lights::samplePoint(const Point& point, const Vec3& position, LightSample& out) const {
    const Vec3 toLight = point.position - position;
    const float distance2 = glm::dot(toLight, toLight);
    if (!(distance2 > 0)) return false;
    out.distance = std::sqrt(distance2);
    out.direction = toLight / out.distance;
    const float spot =
        std::clamp(-glm::dot(point.axis, out.direction) * point.spotScale + point.spotOffset, 0.0f, 1.0f);
    const float window =
        std::isfinite(point.range) ? std::clamp(1 - sqr(sqr(out.distance / point.range)), 0.0f, 1.0f) : 1;
    out.radiance = point.intensity * (sqr(spot) * window / distance2);
    out.position = out.target = point.position;
    out.pdf = 1;
    out.delta = true;
    out.hittable = false;
    return true;
}

bool Lights::sampleSun(const Sun& sun, Vec2 u, LightSample& out) const {
    out.distance = kInfinity;
    if (sun.oneMinusCos > 0) {
        out.direction = glm::normalize(Frame(sun.towards).toWorld(sampleCone(u, sun.oneMinusCos)));
        out.pdf = pdfCone(sun.oneMinusCos);
        out.radiance = sun.radiance;
    } else {
        out.direction = sun.towards;
        out.pdf = 1;
        out.radiance = sun.irradiance;
        out.delta = true;
        out.hittable = false;
    }
    out.position = out.direction;
    return true;
}

float Lights::pdfTriangle(uint32_t instance, uint32_t primitive, const Vec3& position, const Vec3& direction,
                          const Vec3& hitPosition, const Vec3& hitNormal) const {
    const int entry = entryOf(instance, primitive);
    if (entry < 0) return 0;
    const Triangle& triangle = triangles_[entries_[static_cast<size_t>(entry)].index];
    const float area = 0.5f * glm::length(glm::cross(triangle.edge1, triangle.edge2));
    const float cosine = std::abs(glm::dot(hitNormal, direction));
    const Vec3 toLight = hitPosition - position;
    if (!(area * cosine > 0)) return 0;
    return picks_.probability(static_cast<uint32_t>(entry)) * glm::dot(toLight, toLight) / (area * cosine);
}

size_t Lights::byteCount() const {
    return entries_.capacity() * sizeof(Entry) + triangles_.capacity() * sizeof(Triangle) +
           (firstTriangle_.capacity() + triangleEntry_.capacity()) * sizeof(uint32_t) + picks_.byteCount() +
           environment_.byteCount();
}

}  // namespace lumi
