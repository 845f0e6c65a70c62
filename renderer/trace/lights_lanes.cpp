// Light samples for the receivers of a batch.
#include "trace/light_lanes.h"
#include "trace/lights.h"

namespace lumi {

void Lights::placeTriangle(const Triangle& triangle, LightLanes& lights, int i) {
    lights.first.set(i, triangle.corner), lights.second.set(i, triangle.edge1), lights.third.set(i, triangle.edge2);
    lights.value.set(i, triangle.radiance);
    lights.offset[i] = triangle.offset;
    lights.side[i] = triangle.flags & Triangle::kDoubleSided ? 0.0f
                     : triangle.flags & Triangle::kMirrored  ? -1.0f
                                                             : 1.0f;
}

void Lights::placePoint(const Point& point, LightLanes& lights, int i) {
    lights.first.set(i, point.position), lights.second.set(i, point.axis);
    lights.third.set(i, Vec3(point.range, point.spotScale, point.spotOffset));
    lights.value.set(i, point.intensity);
}

/// What kernels make of the choice; kMade: nothing, the general way does.
uint32_t Lights::placeLight(const Choice& choice, Vec2 u, LightLanes& lights, int i) const {
    if (choice.entry < triangles_.size()) {
        const Triangle& triangle = triangles_[choice.entry];
        if (triangle.flags & (Triangle::kMoves | Triangle::kTextured)) return LightLanes::kMade;
        placeTriangle(triangle, lights, i);
        return LightLanes::kTriangle;
    }
    const Entry& entry = entries_[choice.entry];
    if (entry.kind == Kind::Point && points_[entry.index].track < 0) {
        placePoint(points_[entry.index], lights, i);
        return LightLanes::kPoint;
    }
    if (entry.kind == Kind::Environment && environment_.hasImage()) {
        const EnvironmentLight::Cell cell = environment_.cellAt(u);
        lights.first.x[i] = static_cast<float>(cell.column), lights.first.y[i] = static_cast<float>(cell.row);
        lights.second.x[i] = cell.columnLow, lights.second.y[i] = cell.columnHigh;
        lights.third.x[i] = cell.rowLow, lights.third.y[i] = cell.rowHigh;
        return LightLanes::kSky;
    }
    return LightLanes::kMade;
}

void Lights::samplePoints(std::span<const Choice> choices, std::span<const LightReceiver> receivers, LightLanes& lights,
                          PlainLanes& lanes) const {
    for (bool& has : lights.has) has = false;
    for (int i = 0; i < lanes.count; ++i) {
        const Choice& choice = choices[static_cast<size_t>(i)];
        const Vec2 u(lanes.lightPointX[i], lanes.lightPointY[i]);
        lanes.lightPdf[i] = 0;
        lights.kind[i] = LightLanes::kMade;
        if (choice.entry == kNone || !(choice.probability > 0)) continue;
        lights.kind[i] = placeLight(choice, u, lights, i);
        lights.chance[i] = choice.probability;
        lights.has[lights.kind[i]] = true;
        if (lights.kind[i] != LightLanes::kMade) continue;
        LightSample light;
        if (!samplePoint(choice, receivers[static_cast<size_t>(i)], u, light)) continue;
        lanes.lightPdf[i] = light.pdf;
        lanes.lightDirection.set(i, light.direction), lanes.lightTarget.set(i, light.target);
        lanes.lightRadiance.set(i, light.sky ? Vec3(1) : light.radiance);
        lanes.lightDistance[i] = light.distance;
        lanes.lightWeighs[i] = light.hittable ? 1.0f : 0.0f;
        lights.position.set(i, light.position);
        lights.skyU[i] = light.skyPlace.x, lights.skyV[i] = light.skyPlace.y;
    }
    const LightLaneKernels& kernels = lightLaneKernels();
    if (lights.has[LightLanes::kTriangle]) kernels.triangles(lights, lanes);
    if (lights.has[LightLanes::kPoint]) kernels.points(lights, lanes);
    if (lights.has[LightLanes::kSky]) kernels.sky(environment_.grid(), lights, lanes);
}

}  // namespace lumi
