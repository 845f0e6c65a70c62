#include "trace/lights.h"

#include <algorithm>
#include <cmath>

#include "math/warp.h"
#include "trace/moving_triangle.h"
#include "trace/surface.h"

namespace lumi {
int Lights::entryOf(uint32_t instance, uint32_t primitive) const {
    if (firstEntry_[instance] != kNone) return static_cast<int>(firstEntry_[instance] + primitive);
    const uint32_t first = firstTriangle_[instance];
    if (first == kNone || triangleEntry_[first + primitive] == kNone) return -1;
    return static_cast<int>(triangleEntry_[first + primitive]);
}

bool Lights::isDelta(uint32_t entry) const {
    const Entry& light = entries_[entry];
    return light.kind == Kind::Point || (light.kind == Kind::Directional && suns_[light.index].oneMinusCos <= 0);
}

std::optional<SurfacePoint> Lights::triangleOf(uint32_t entry) const {
    if (entry >= entries_.size() || entries_[entry].kind != Kind::Triangle) return std::nullopt;
    const Triangle& triangle = triangles_[entries_[entry].index];
    return SurfacePoint{triangle.instance, triangle.primitive};
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
    if (entries_.size() == 1) return {0, 1};
    if (receiver.sampling == LightSampling::Power) {
        const uint32_t entry = picks_.sample(pick);
        return {entry, picks_.probability(entry)};
    }
    const auto importanceOf = [&](uint32_t infinite) { return infiniteImportance(receiver, infinite); };
    const float elsewhere = infiniteImportance(receiver);
    if (finiteCount_ == 0) return chosenInfinite(pick.x, 1, elsewhere, importanceOf);
    const LightTreeChoice choice = tree_.pick(treePoint(receiver), elsewhere, pick);
    if (!choice.elsewhere) return {choice.light, choice.probability};
    return chosenInfinite(choice.u, choice.probability, elsewhere, importanceOf);
}

/// What its sample reads.
void Lights::prefetch(const Choice& choice) const {
    if (choice.entry < triangles_.size()) __builtin_prefetch(&triangles_[choice.entry]);
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
    return !picks_.empty() && samplePoint(choose(receiver, pick), receiver, u, out);
}

bool Lights::samplePoint(const Choice& chosen, const LightReceiver& receiver, Vec2 u, LightSample& out) const {
    if (chosen.entry == kNone || !(chosen.probability > 0)) return false;
    out.light = static_cast<int>(chosen.entry);
    out.delta = false;
    out.hittable = true;
    out.sky = false;
    if (chosen.entry < triangles_.size()) {
        if (!sampleTriangle(triangles_[chosen.entry], receiver, u, out)) return false;
        out.pdf *= chosen.probability;
        return out.pdf > 0 && maxComponent(out.radiance) > 0;
    }
    const Entry& entry = entries_[chosen.entry];
    bool reached = false;
    switch (entry.kind) {
        case Kind::Triangle: break;
        case Kind::Body: reached = sampleBody(tables_->bodies[entry.index], receiver, u, out); break;
        case Kind::Point: reached = samplePunctual(points_[entry.index], receiver, out); break;
        case Kind::Directional: reached = sampleSun(suns_[entry.index], receiver.time, u, out); break;
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
    if (!(triangle.flags & Triangle::kMoves)) return triangle;
    const MovingTriangle moving(tables_->instances[triangle.instance], triangle.primitive, time);
    Triangle moved = triangle;
    moved.corner = moving.corner(0);
    moved.edge1 = moving.corner(1) - moved.corner, moved.edge2 = moving.corner(2) - moved.corner;
    moved.flags &= ~uint32_t(Triangle::kMirrored);
    if (moving.instance().mirrored) moved.flags |= Triangle::kMirrored;
    return moved;
}

Mat4 Lights::frameAt(int track, float time) const {
    const std::vector<Mat4>& frames = tracks_[static_cast<size_t>(track)];
    const TrackPlace place = trackPlace(frames.size(), time);
    return frames[place.first] * (1 - place.fraction) + frames[place.first + 1] * place.fraction;
}

bool Lights::sampleTriangle(const Triangle& atOpen, const LightReceiver& receiver, Vec2 u, LightSample& out) const {
    const Vec2 b = lumi::sampleTriangle(u);
    const Triangle triangle = triangleAt(atOpen, receiver.time);
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
    const bool front = triangle.flags & Triangle::kMirrored ? cosine < 0 : cosine > 0;
    if (cosine == 0 || (!front && !(triangle.flags & Triangle::kDoubleSided))) return false;
    out.pdf = distance2 / (0.5f * twiceArea * std::abs(cosine));
    out.radiance =
        triangle.flags & Triangle::kTextured
            ? triangleEmission(*tables_, {triangle.instance, triangle.primitive, b, receiver.time}, -out.direction)
            : triangle.radiance;
    out.target = offsetOrigin(out.position, cosine > 0 ? normal : -normal, triangle.offset);
    return true;
}

bool Lights::samplePunctual(const Point& point, const LightReceiver& receiver, LightSample& out) const {
    Vec3 place = point.position, axis = point.axis;
    if (point.track >= 0) {
        const Mat4 frame = frameAt(point.track, receiver.time);
        place = Vec3(frame[3]), axis = unitOr(-Vec3(frame[2]), point.axis);
    }
    const Vec3 toLight = place - receiver.position;
    const float distance2 = glm::dot(toLight, toLight);
    if (!(distance2 > 0)) return false;
    out.distance = std::sqrt(distance2);
    out.direction = toLight / out.distance;
    const float spot = std::clamp(-glm::dot(axis, out.direction) * point.spotScale + point.spotOffset, 0.0f, 1.0f);
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
                          const Vec3& hitPosition, const Vec3& hitNormal, float area) const {
    const int entry = entryOf(instance, primitive);
    if (entry < 0) return 0;
    if (!(area > 0)) {
        const Triangle triangle = triangleAt(triangles_[static_cast<size_t>(entry)], receiver.time);
        area = 0.5f * glm::length(glm::cross(triangle.edge1, triangle.edge2));
    }
    const float cosine = std::abs(glm::dot(hitNormal, direction));
    const Vec3 toLight = hitPosition - receiver.position;
    if (!(area * cosine > 0)) return 0;
    return pickProbability(receiver, static_cast<uint32_t>(entry)) * glm::dot(toLight, toLight) / (area * cosine);
}

size_t Lights::byteCount() const {
    return entries_.capacity() * sizeof(Entry) + triangles_.capacity() * sizeof(Triangle) +
           (firstTriangle_.capacity() + firstEntry_.capacity() + triangleEntry_.capacity()) * sizeof(uint32_t) +
           picks_.byteCount() + tree_.byteCount() + environment_.byteCount();
}

}  // namespace lumi
