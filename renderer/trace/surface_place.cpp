// Where surface points are, now and in the previous frame, without their shading.
#include <cmath>

#include "trace/moving_triangle.h"
#include "trace/quick_unit.h"
#include "trace/surface.h"

namespace lumi {
namespace {

/// Place among the vertices `t`, in their space.
Vec3 placeAmong(const Vec3* positions, const UVec3& t, Vec2 b) {
    const Vec3 p0 = positions[t.x];
    return p0 + (positions[t.y] - p0) * b.x + (positions[t.z] - p0) * b.y;
}

Vec3 smoothNormal(const InstanceRecord& r, const UVec3& t, Vec2 barycentrics) {
    const Vec3 edge1 = r.positions[t.y] - r.positions[t.x], edge2 = r.positions[t.z] - r.positions[t.x];
    Vec3 outward = glm::cross(edge1, edge2);
    if (r.inWorld ? r.mirrored : r.turned) outward = -outward;
    if (!r.inWorld) outward = r.normalFromObject * outward;
    outward = quickUnitOr(outward, Vec3(0, 1, 0));
    return r.normals ? quickUnitOr(r.normalFromObject * placeAmong(r.normals, t, barycentrics), outward) : outward;
}

}  // namespace

Vec3 smoothNormal(const SceneTables& tables, const SurfacePoint& point) {
    const InstanceRecord& r = tables.instances[point.instance];
    if (r.body >= 0) return tables.bodies[static_cast<size_t>(r.body)].at(point.time).normalAt(point.barycentrics);
    if (!r.track) return smoothNormal(r, r.triangles[point.primitive], point.barycentrics);
    const MovingTriangle moving(r, point.primitive, point.time);
    return smoothNormal(moving.instance(), MovingTriangle::kCorners, point.barycentrics);
}

Vec3 surfacePosition(const SceneTables& tables, const SurfacePoint& point) {
    const InstanceRecord& r = tables.instances[point.instance];
    if (r.body >= 0) return tables.bodies[static_cast<size_t>(r.body)].at(point.time).position(point.barycentrics);
    if (r.track) {
        const MovingTriangle moving(r, point.primitive, point.time);
        const Vec3 corners[] = {moving.corner(0), moving.corner(1), moving.corner(2)};
        return placeAmong(corners, MovingTriangle::kCorners, point.barycentrics);
    }
    const Vec3 p = placeAmong(r.positions, r.triangles[point.primitive], point.barycentrics);
    return r.inWorld ? p : transformPoint(r.worldFromObject, p);
}

Vec3 previousSurfacePosition(const SceneTables& tables, const PosedScene& posed, const SurfacePoint& point) {
    const InstanceRecord& r = tables.instances[point.instance];
    if (r.body >= 0)
        return tables.bodies[static_cast<size_t>(r.body)].previousAt(point.time).position(point.barycentrics);
    const PosedInstance& pose = posed.instances[point.instance];
    const UVec3 t = r.triangles[point.primitive];
    const Vec3* rest = pose.deformedPrevious() ? pose.deformedPrevious()->positions.data() : r.restPositions;
    if (pose.previousTrack()) {
        const ShutterTrack& track = *pose.previousTrack();
        Vec3 place = placeAmong(rest, t, point.barycentrics);
        if (!track.deformed.empty()) {
            const TrackPlace at = trackPlace(track.deformed.size(), point.time);
            place = placeAmong(track.deformed[at.first]->positions.data(), t, point.barycentrics);
            if (at.fraction > 0)
                place =
                    glm::mix(place, placeAmong(track.deformed[at.first + 1]->positions.data(), t, point.barycentrics),
                             at.fraction);
        }
        return transformPoint(track.worldFromObjectAt(point.time), place);
    }
    const bool still = pose.worldFromObject == pose.worldFromObjectPrevious() &&
                       pose.deformed == pose.deformedPrevious() && !pose.track();
    if (still) return surfacePosition(tables, point);
    return transformPoint(pose.worldFromObjectPrevious(), placeAmong(rest, t, point.barycentrics));
}

}  // namespace lumi
