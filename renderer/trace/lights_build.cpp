// Collecting the lights of a posed scene.
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>

#include "base/memory.h"
#include "base/parallel.h"
#include "trace/lights.h"

namespace lumi {
namespace {

/// About what a triangle that shines takes while the lights are built: its entry, its bounds and its part of the tree.
constexpr uint64_t kBytesATriangle = 450;

/// How many triangles of the instance shine, by their materials.
size_t emittingTriangles(const InstanceRecord& instance, std::span<const MaterialRecord> materials) {
    if (instance.body >= 0 || !instance.positions) return 0;
    if (!instance.triangleMaterial) return materials[instance.material].emits ? instance.triangleCount : 0;
    std::atomic<size_t> total{0};
    parallelRanges(instance.triangleCount, 1 << 16, [&](int64_t begin, int64_t end) {
        size_t here = 0;
        for (int64_t k = begin; k < end; ++k)
            here += materials[instance.materialOf(static_cast<uint32_t>(k))].emits ? 1 : 0;
        total += here;
    });
    return total;
}

/// Moments by which the instance moves while the shutter is open; none if it stands still.
size_t momentsOf(const InstanceRecord& instance) {
    return instance.track ? std::max(instance.track->worldFromObject.size(), instance.track->deformed.size()) : 0;
}

float momentAt(size_t moment, size_t moments) { return static_cast<float>(moment) / static_cast<float>(moments - 1); }

/// Mean luminance that a triangle emits: its emission texture filtered over the triangle's extent. Triangles in
/// darkness near light keep a small share, so that no texel with light is out of reach.
float triangleLuminance(const MaterialRecord& material, const InstanceRecord& instance, const UVec3& t) {
    Vec3 emission = glm::max(material.emission, Vec3(0));
    if (const Vec4* colours = material.unlit ? instance.colours : nullptr)
        emission *= Vec3(colours[t.x] + colours[t.y] + colours[t.z]) * (1.0f / 3.0f);
    const float factor = luminance(emission);
    if (!(material.textures & MaterialRecord::kEmission)) return factor;
    const Texture& texture = material.source->emissionTexture;
    const Vec2* uv = instance.uv[texture.uvSet == 1 ? 1 : 0];
    if (!uv) return factor * luminance(Vec3(texture.sample(Vec2(0))));
    const Vec2 a = uv[t.x], b = uv[t.y], c = uv[t.z];
    const Vec2 size = glm::max(a, glm::max(b, c)) - glm::min(a, glm::min(b, c));
    const float extent = std::max(size.x, size.y);
    const Vec2 middle = (a + b + c) * (1.0f / 3.0f);
    const auto filtered = [&](float width) { return luminance(emission * Vec3(texture.sample(middle, width))); };
    return filtered(extent) + 0.05f * filtered(4 * extent) + 1e-4f * factor;
}

}  // namespace

void Lights::build(const PosedScene& posed, const SceneTables& tables, const std::stop_token& stop) {
    tables_ = &tables;
    environment_.build(posed.scene->environment);
    entries_.clear(), triangles_.clear(), points_.clear(), suns_.clear(), tracks_.clear();
    Collected collected;
    addTriangles(collected);
    addBodies(collected);
    addPoints(posed, collected);
    finiteCount_ = static_cast<uint32_t>(entries_.size());
    addInfinite(posed, collected);
    picks_ = AliasTable(collected.weights);
    collected.weights = {};
    tree_.build(std::move(collected.bounds), stop);

    hasEmitters_ = false;
    for (const MaterialRecord& material : tables.materials) hasEmitters_ |= material.emits;
    for (const BodyRecord& body : tables.bodies) hasEmitters_ |= body.instance != BodyRecord::kNone;
    hittable_ = !environment_.black() || hasEmitters_;
    for (const Sun& sun : suns_) hittable_ |= sun.oneMinusCos > 0;
    hasDelta_ = !points_.empty();
    for (const Sun& sun : suns_) hasDelta_ |= sun.oneMinusCos <= 0;
    for (const BodyRecord& body : tables.bodies) hasDelta_ |= body.instance == BodyRecord::kNone;
}

namespace {

LightBounds triangleBounds(const Vec3& corner, const Vec3& edge1, const Vec3& edge2, bool mirrored, bool bothSides,
                           float intensity) {
    LightBounds bounds;
    for (const Vec3& p : {corner, corner + edge1, corner + edge2}) bounds.box.extend(p);
    const Vec3 cross = glm::cross(edge1, edge2);
    const float length = glm::length(cross);
    if (length > 0) bounds.axis = cross * ((mirrored ? -1.0f : 1.0f) / length);
    bounds.bothSides = bothSides;
    bounds.intensity = intensity;
    return bounds;
}

/// Bounds of one light over two moments: it does not shine twice.
LightBounds swept(const LightBounds& a, const LightBounds& b) {
    LightBounds both = unite(a, b);
    both.intensity = std::max(a.intensity, b.intensity);
    return both;
}

/// Two sides of a flat light at one moment; it emits to where side * cross(x, y) points.
struct FlatLight {
    Vec3 x, y;
    float side = 1;
};

/// Bounds of a flat light at two moments and between them, where its sides change evenly: their cross product goes
/// along a quadratic Bezier curve, whose directions lie within the cone around those of its three control points.
LightBounds turned(const LightBounds& bounds, const FlatLight& from, const FlatLight& to) {
    const Vec3 begin = from.side * glm::cross(from.x, from.y), end = to.side * glm::cross(to.x, to.y);
    const Vec3 middle = from.side * (glm::cross(from.x, to.y) + glm::cross(to.x, from.y));
    LightBounds between = bounds;
    const bool isCone =
        from.side == to.side && glm::dot(begin, middle) >= 0 && glm::dot(middle, end) >= 0 && glm::dot(begin, end) >= 0;
    if (isCone) between.axis = unitOr(middle, unitOr(begin, between.axis));
    between.cosSpread = isCone ? 1.0f : -1.0f;
    return swept(bounds, between);
}

LightBounds bodyBounds(const LightShape& shape) {
    LightBounds bounds;
    if (shape.type == LightType::Sphere) {
        bounds.box = {shape.centre - Vec3(shape.radius), shape.centre + Vec3(shape.radius)};
        bounds.cosSpread = -1;
        bounds.intensity = kPi * sqr(shape.radius) * shape.meanLuminance();
        return bounds;
    }
    const Vec3 x = glm::abs(shape.halfX), y = glm::abs(shape.halfY);
    const Vec3 half = shape.type == LightType::Disk ? glm::sqrt(x * x + y * y) : x + y;
    bounds.box = {shape.centre - half, shape.centre + half};
    bounds.axis = shape.normal;
    bounds.intensity = shape.area * shape.meanLuminance();
    return bounds;
}

FlatLight flatLight(const LightShape& shape) {
    return {shape.halfX, shape.halfY, glm::dot(glm::cross(shape.halfX, shape.halfY), shape.normal) < 0 ? -1.0f : 1.0f};
}

}  // namespace

void Lights::addTriangles(Collected& collected) {
    const std::vector<InstanceRecord>& instances = tables_->instances;
    const bool anyEmits = std::any_of(tables_->materials.begin(), tables_->materials.end(),
                                      [](const MaterialRecord& material) { return material.emits; });
    firstTriangle_.assign(instances.size(), kNone);
    firstEntry_.assign(instances.size(), kNone);
    // Rows of the triangles of instances that emit.
    size_t rows = 0, emitting = 0;
    for (size_t i = 0; anyEmits && i < instances.size(); ++i) {
        const size_t here = emittingTriangles(instances[i], tables_->materials);
        if (here == 0) continue;
        firstTriangle_[i] = static_cast<uint32_t>(rows);
        rows += instances[i].triangleCount, emitting += here;
    }
    // The lights of the frame before go as these come.
    const uint64_t needed = emitting * kBytesATriangle + rows * (sizeof(float) + sizeof(uint32_t));
    const uint64_t held = byteCount() - environment_.byteCount();
    checkMemory(fmt::format("choosing among {} triangles that shine", emitting), needed - std::min(needed, held));

    const auto forEachRow = [&](auto&& visit) {
        for (size_t i = 0; i < instances.size(); ++i)
            if (firstTriangle_[i] != kNone)
                parallelRanges(instances[i].triangleCount, 1024, [&, i](int64_t begin, int64_t end) {
                    for (int64_t k = begin; k < end; ++k)
                        visit(firstTriangle_[i] + static_cast<size_t>(k), static_cast<uint32_t>(i),
                              static_cast<uint32_t>(k));
                });
    };
    std::vector<float> intensity(rows, 0);
    forEachRow([&](size_t row, uint32_t instance, uint32_t primitive) {
        const InstanceRecord& r = instances[instance];
        const MaterialRecord& material = tables_->materials[r.materialOf(primitive)];
        if (!material.emits) return;
        const float most =
            mostArea(makeTriangle(instance, primitive)) * triangleLuminance(material, r, r.triangles[primitive]);
        intensity[row] = most > 0 && std::isfinite(most) ? most : 0;
    });

    const auto shining =
        static_cast<size_t>(std::count_if(intensity.begin(), intensity.end(), [](float x) { return x > 0; }));
    triangleEntry_.assign(rows, kNone);
    entries_.reserve(shining);
    for (size_t row = 0; row < rows; ++row) {
        if (intensity[row] <= 0) continue;
        const auto entry = static_cast<uint32_t>(entries_.size());
        triangleEntry_[row] = entry;
        entries_.push_back({Kind::Triangle, entry});
    }
    triangles_ = std::vector<Triangle>(shining);
    collected.weights.resize(shining), collected.bounds.resize(shining);
    forEachRow([&](size_t row, uint32_t instance, uint32_t primitive) {
        const uint32_t entry = triangleEntry_[row];
        if (entry == kNone) return;
        triangles_[entry] = makeTriangle(instance, primitive);
        const bool bothSides = triangles_[entry].flags & Triangle::kDoubleSided;
        collected.weights[entry] = kPi * intensity[row] * (bothSides ? 2 : 1);
        collected.bounds[entry] = boundsOf(triangles_[entry], intensity[row]);
    });
    // Most instances emit with all their triangles, which then need no table.
    for (size_t i = 0; i < instances.size(); ++i) {
        if (firstTriangle_[i] == kNone) continue;
        const auto begin = triangleEntry_.begin() + firstTriangle_[i], end = begin + instances[i].triangleCount;
        if (std::find(begin, end, kNone) == end) firstEntry_[i] = begin == end ? kNone : *begin;
    }
}

Lights::Triangle Lights::makeTriangle(uint32_t instance, uint32_t primitive) const {
    const InstanceRecord& r = tables_->instances[instance];
    const MaterialRecord& material = tables_->materials[r.materialOf(primitive)];
    const UVec3 t = r.triangles[primitive];
    Vec3 p[3] = {r.positions[t.x], r.positions[t.y], r.positions[t.z]};
    if (!r.inWorld)
        for (Vec3& corner : p) corner = transformPoint(r.worldFromObject, corner);
    Triangle triangle;
    triangle.corner = p[0], triangle.edge1 = p[1] - p[0], triangle.edge2 = p[2] - p[0];
    triangle.radiance = material.emission;
    triangle.instance = instance, triangle.primitive = primitive;
    triangle.offset = r.objectScale * 0x1p-18f;
    // Or in the vertices' colours, which an unlit surface shines in, or through a varnish.
    const bool textured = (material.textures & MaterialRecord::kEmission) || material.source->hasAlpha() ||
                          (material.unlit && r.colours) || material.coatedEmission;
    const auto mark = [&](bool on, uint32_t flag) { triangle.flags |= on ? flag : 0u; };
    mark(material.doubleSided, Triangle::kDoubleSided), mark(textured, Triangle::kTextured);
    mark(r.mirrored, Triangle::kMirrored), mark(r.track != nullptr, Triangle::kMoves);
    return triangle;
}

float Lights::mostArea(const Triangle& triangle) const {
    const auto areaOf = [](const Triangle& t) { return 0.5f * glm::length(glm::cross(t.edge1, t.edge2)); };
    float most = areaOf(triangle);
    const size_t moments = momentsOf(tables_->instances[triangle.instance]), halves = 2 * moments;
    // It may be largest between two moments at which it is nothing.
    for (size_t half = 1; half + 1 < halves; ++half)
        most = std::max(most, areaOf(triangleAt(triangle, momentAt(half, halves - 1))));
    return most;
}

LightBounds Lights::boundsOf(const Triangle& triangle, float intensity) const {
    const auto boundsAt = [&](const Triangle& t) {
        const bool mirrored = t.flags & Triangle::kMirrored, bothSides = t.flags & Triangle::kDoubleSided;
        return triangleBounds(t.corner, t.edge1, t.edge2, mirrored, bothSides, intensity);
    };
    const auto flat = [](const Triangle& t) {
        return FlatLight{t.edge1, t.edge2, t.flags & Triangle::kMirrored ? -1.0f : 1.0f};
    };
    LightBounds bounds = boundsAt(triangle);
    const InstanceRecord& instance = tables_->instances[triangle.instance];
    const size_t moments = momentsOf(instance);
    Triangle earlier = triangle;
    for (size_t m = 1; m < moments; ++m) {
        const Triangle later = triangleAt(triangle, momentAt(m, moments));
        bounds = turned(swept(bounds, boundsAt(later)), flat(earlier), flat(later));
        earlier = later;
    }
    // What moves and deforms at a time does not change evenly.
    if (moments > 0 && instance.track->worldFromObject.size() > 1 && instance.track->deformed.size() > 1)
        bounds.cosSpread = -1;
    return bounds;
}

void Lights::addBodies(Collected& collected) {
    firstBody_ = static_cast<uint32_t>(entries_.size());
    for (size_t i = 0; i < tables_->bodies.size(); ++i) {
        const LightShape& shape = tables_->bodies[i].shape;
        entries_.push_back({Kind::Body, static_cast<uint32_t>(i)});
        const std::vector<LightShape>& track = tables_->bodies[i].shutterShapes;
        LightBounds bounds = bodyBounds(shape);
        float mostArea = shape.area;
        LightShape earlier = shape;
        // It may be largest between two moments at which it is nothing.
        for (size_t half = 1; half + 1 < 2 * track.size(); ++half) {
            const LightShape later = shapeAt(track, momentAt(half, 2 * track.size() - 1));
            mostArea = std::max(mostArea, later.area);
            bounds = swept(bounds, bodyBounds(later));
            if (shape.type != LightType::Sphere) bounds = turned(bounds, flatLight(earlier), flatLight(later));
            earlier = later;
        }
        collected.weights.push_back(kPi * mostArea * shape.meanLuminance());
        collected.bounds.push_back(bounds);
    }
}

int Lights::addTrack(const std::vector<Mat4>& frames) {
    if (frames.size() < 2) return -1;
    tracks_.push_back(frames);
    return static_cast<int>(tracks_.size()) - 1;
}

void Lights::addPoints(const PosedScene& posed, Collected& collected) {
    for (size_t i = 0; i < posed.scene->lights.size(); ++i) {
        const Light& light = posed.scene->lights[i];
        if (light.type != LightType::Point && light.type != LightType::Spot) continue;
        const Mat4& frame = posed.lights[i].worldFromLight;
        const std::vector<Mat4>& frames = posed.lights[i].track;
        Point point{Vec3(frame[3]),
                    unitOr(-Vec3(frame[2]), Vec3(0, 0, -1)),
                    light.intensity * light.power,
                    -1,
                    light.range,
                    0,
                    1};
        LightBounds bounds{{point.position, point.position}, point.axis, -1, 0, false, luminance(point.intensity)};
        float solidAngle = 4 * kPi;
        if (light.type == LightType::Spot) {
            // KHR_lights_punctual: smooth between the two cones, squared.
            const float cosOuter = std::cos(radians(light.outerConeDeg));
            const float cosInner = std::cos(radians(std::min(light.innerConeDeg, light.outerConeDeg)));
            point.spotScale = 1 / std::max(1e-4f, cosInner - cosOuter);
            point.spotOffset = -cosOuter * point.spotScale;
            solidAngle = 2 * kPi * (1 - 0.5f * (cosInner + cosOuter));
            bounds.cosSpread = 1;
            bounds.cosReach = std::max(cosOuter - 1e-6f, 0.0f);
        }
        const float weight = luminance(point.intensity) * solidAngle;
        if (!std::isfinite(weight)) continue;
        point.track = addTrack(frames);
        for (const Mat4& later : frames) {
            LightBounds moved = bounds;
            moved.box = {Vec3(later[3]), Vec3(later[3])};
            moved.axis = unitOr(-Vec3(later[2]), point.axis);
            bounds = swept(bounds, moved);
        }
        entries_.push_back({Kind::Point, static_cast<uint32_t>(points_.size())});
        points_.push_back(point);
        collected.weights.push_back(weight);
        collected.bounds.push_back(bounds);
    }
}

void Lights::addInfinite(const PosedScene& posed, Collected& collected) {
    const float radius = std::max(posed.bounds.empty() ? 1.0f : posed.bounds.radius(), 1e-3f);
    for (size_t i = 0; i < posed.scene->lights.size(); ++i) {
        const Light& light = posed.scene->lights[i];
        if (light.type != LightType::Directional) continue;
        Sun sun;
        sun.towards = unitOr(Vec3(posed.lights[i].worldFromLight[2]), Vec3(0, 0, 1));
        sun.irradiance = light.irradiance * light.power;
        const float weight = luminance(sun.irradiance) * kPi * sqr(radius);
        if (!std::isfinite(weight)) continue;
        sun.track = addTrack(posed.lights[i].track);
        if (light.angleDeg > 0) {
            const float half = std::min(radians(light.angleDeg) * 0.5f, kPi / 2);
            sun.oneMinusCos = 2 * sqr(std::sin(half / 2));
            sun.sine = std::sin(half);
            // The irradiance of a cone of constant radiance L on a plane facing it is pi L sin^2.
            sun.radiance = sun.irradiance / (kPi * sqr(sun.sine));
        }
        entries_.push_back({Kind::Directional, static_cast<uint32_t>(suns_.size())});
        suns_.push_back(sun);
        collected.weights.push_back(weight);
    }
    if (environment_.black()) return;
    // What the sky sends into a sphere around the scene.
    entries_.push_back({Kind::Environment, 0});
    collected.weights.push_back(environment_.meanLuminance() * 4 * kPi * kPi * sqr(radius));
}

}  // namespace lumi
