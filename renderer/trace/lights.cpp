#include "trace/lights.h"

#include <algorithm>
#include <cmath>

#include "math/warp.h"
#include "trace/moving_triangle.h"
#include "trace/surface.h"

namespace lumi {
namespace {

/// The sky counts at least as this part of its mean: parts of it shine from behind the plane that faces away from it.
constexpr float kLeastSky = 0.05f;

}  // namespace

int Lights::entryOf(uint32_t instance, uint32_t primitive) const {
    const uint32_t first = firstTriangle_[instance];
    if (first == kNone || triangleEntry_[first + primitive] == kNone) return -1;
    return static_cast<int>(triangleEntry_[first + primitive]);
}

float Lights::infiniteImportance(const LightReceiver& receiver, uint32_t infinite) const {
    using Facing = LightReceiver::Facing;
    if (infinite == suns_.size()) {
        const float mean = kPi * environment_.meanLuminance();
        if (receiver.facing == Facing::Any) return mean;
        const float front = environment_.irradiance(receiver.normal);
        const float both = receiver.facing == Facing::Both ? front + environment_.irradiance(-receiver.normal) : front;
        return std::max(both, kLeastSky * mean);
    }
    const Sun& sun = suns_[infinite];
    float cosine = 1;
    if (receiver.facing != Facing::Any) {
        cosine = glm::dot(receiver.normal, towards(sun, receiver.time));
        if (receiver.facing == Facing::Both) cosine = std::abs(cosine);
        // Of the part of its disk that stands highest over the receiver.
        const float cosHalf = 1 - sun.oneMinusCos;
        if (cosine < cosHalf) cosine = cosine * cosHalf + std::sqrt(std::max(0.0f, 1 - sqr(cosine))) * sun.sine;
    }
    return luminance(sun.irradiance) * std::max(cosine, 0.0f);
}

float Lights::infiniteImportance(const LightReceiver& receiver) const {
    float sum = 0;
    for (uint32_t i = 0; finiteCount_ + i < entries_.size(); ++i) sum += infiniteImportance(receiver, i);
    return sum;
}

namespace {

LightTreePoint treePoint(const LightReceiver& r) {
    return {r.position.x, r.position.y, r.position.z, r.normal.x, r.normal.y, r.normal.z, static_cast<int>(r.facing)};
}

}  // namespace

Lights::Choice Lights::choose(const LightReceiver& receiver, Vec2 pick) const {
    if (receiver.sampling == LightSampling::Power || entries_.size() == 1) {
        const uint32_t entry = picks_.sample(pick);
        return {entry, picks_.probability(entry)};
    }
    const float elsewhere = infiniteImportance(receiver);
    float u = pick.x, share = 1;
    if (finiteCount_ > 0) {
        const LightTreeChoice choice = tree_.pick(treePoint(receiver), elsewhere, pick);
        if (!choice.elsewhere) return {choice.light, choice.probability};
        u = choice.u, share = choice.probability;
    }
    Choice chosen;
    float rest = u * elsewhere;
    for (uint32_t i = 0; finiteCount_ + i < entries_.size(); ++i) {
        const float own = infiniteImportance(receiver, i);
        if (!(own > 0)) continue;
        chosen = {finiteCount_ + i, share * own / elsewhere};
        if (rest < own) break;
        rest -= own;
    }
    return chosen;
}

float Lights::pickProbability(const LightReceiver& receiver, uint32_t entry) const {
    if (picks_.empty()) return 0;
    if (receiver.sampling == LightSampling::Power || entries_.size() == 1) return picks_.probability(entry);
    const float elsewhere = infiniteImportance(receiver);
    if (entry < finiteCount_) return tree_.probability(treePoint(receiver), elsewhere, entry);
    if (!(elsewhere > 0)) return 0;
    const float share = finiteCount_ > 0 ? tree_.share(treePoint(receiver), elsewhere) : 0;
    return (1 - share) * infiniteImportance(receiver, entry - finiteCount_) / elsewhere;
}

bool Lights::sample(const LightReceiver& receiver, Vec2 pick, Vec2 u, LightSample& out) const {
    if (picks_.empty()) return false;
    const Choice chosen = choose(receiver, pick);
    if (chosen.entry == kNone || !(chosen.probability > 0)) return false;
    const Entry& entry = entries_[chosen.entry];
    out.light = static_cast<int>(chosen.entry);
    out.delta = false;
    out.hittable = true;
    out.sky = false;
    bool reached = false;
    switch (entry.kind) {
        case Kind::Triangle:
            reached = sampleTriangle(triangles_[entry.index], receiver, u, out);
            break;
        case Kind::Body:
            reached = sampleBody(tables_->bodies[entry.index], receiver, u, out);
            break;
        case Kind::Point:
            reached = samplePoint(points_[entry.index], receiver, out);
            break;
        case Kind::Directional:
            reached = sampleSun(suns_[entry.index], receiver.time, u, out);
            break;
        case Kind::Environment:
            out.direction = out.position = environment_.sample(u, out.pdf, out.skyPlace);
            out.distance = kInfinity;
            out.sky = true;
            reached = out.pdf > 0;
            break;
    }
    out.pdf *= chosen.probability;
    return reached && out.pdf > 0 && (out.sky || maxComponent(out.radiance) > 0);
}

Lights::Triangle Lights::triangleAt(const Triangle& triangle, float time) const {
    const InstanceRecord& instance = tables_->instances[triangle.instance];
    if (!instance.track) return triangle;
    const MovingTriangle moving(instance, triangle.primitive, time);
    const Vec3 corner = moving.corner(0);
    return {corner, moving.corner(1) - corner, moving.corner(2) - corner, triangle.instance, triangle.primitive};
}

Mat4 Lights::frameAt(int track, float time) const {
    const std::vector<Mat4>& frames = tracks_[static_cast<size_t>(track)];
    const TrackPlace place = trackPlace(frames.size(), time);
    return frames[place.first] * (1 - place.fraction) + frames[place.first + 1] * place.fraction;
}

bool Lights::sampleTriangle(const Triangle& atOpen, const LightReceiver& receiver, Vec2 u, LightSample& out) const {
    const Vec2 b = lumi::sampleTriangle(u);
    const Triangle triangle = triangleAt(atOpen, receiver.time);
    const InstanceRecord& instance = tables_->instances[triangle.instance];
    const MaterialRecord& material = tables_->materials[instance.materialOf(triangle.primitive)];
    out.position = triangle.corner + triangle.edge1 * b.x + triangle.edge2 * b.y;
    const Vec3 toLight = out.position - receiver.position;
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

bool Lights::samplePoint(const Point& point, const LightReceiver& receiver, LightSample& out) const {
    Vec3 place = point.position, axis = point.axis;
    if (point.track >= 0) {
        const Mat4 frame = frameAt(point.track, receiver.time);
        place = Vec3(frame[3]), axis = glm::normalize(-Vec3(frame[2]));
    }
    const Vec3 toLight = place - receiver.position;
    const float distance2 = glm::dot(toLight, toLight);
    if (!(distance2 > 0)) return false;
    out.distance = std::sqrt(distance2);
    out.direction = toLight / out.distance;
    const float spot =
        std::clamp(-glm::dot(axis, out.direction) * point.spotScale + point.spotOffset, 0.0f, 1.0f);
    const float window =
        std::isfinite(point.range) ? std::clamp(1 - sqr(sqr(out.distance / point.range)), 0.0f, 1.0f) : 1;
    out.radiance = point.intensity * (sqr(spot) * window / distance2);
    out.position = out.target = place;
    out.pdf = 1;
    out.delta = true;
    out.hittable = false;
    return true;
}

bool Lights::sampleSun(const Sun& sun, float time, Vec2 u, LightSample& out) const {
    const Vec3 middle = towards(sun, time);
    out.distance = kInfinity;
    if (sun.oneMinusCos > 0) {
        out.direction = glm::normalize(Frame(middle).toWorld(sampleCone(u, sun.oneMinusCos)));
        out.pdf = pdfCone(sun.oneMinusCos);
        out.radiance = sun.radiance;
    } else {
        out.direction = middle;
        out.pdf = 1;
        out.radiance = sun.irradiance;
        out.delta = true;
        out.hittable = false;
    }
    out.position = out.direction;
    return true;
}

float Lights::pdfTriangle(uint32_t instance, uint32_t primitive, const LightReceiver& receiver, const Vec3& direction,
                          const Vec3& hitPosition, const Vec3& hitNormal) const {
    const int entry = entryOf(instance, primitive);
    if (entry < 0) return 0;
    const Triangle triangle = triangleAt(triangles_[entries_[static_cast<size_t>(entry)].index], receiver.time);
    const float area = 0.5f * glm::length(glm::cross(triangle.edge1, triangle.edge2));
    const float cosine = std::abs(glm::dot(hitNormal, direction));
    const Vec3 toLight = hitPosition - receiver.position;
    if (!(area * cosine > 0)) return 0;
    return pickProbability(receiver, static_cast<uint32_t>(entry)) * glm::dot(toLight, toLight) / (area * cosine);
}

size_t Lights::byteCount() const {
    return entries_.capacity() * sizeof(Entry) + triangles_.capacity() * sizeof(Triangle) +
           (firstTriangle_.capacity() + triangleEntry_.capacity()) * sizeof(uint32_t) + picks_.byteCount() +
           tree_.byteCount() + environment_.byteCount();
}

}  // namespace lumi
