// Lights and light samples for the receivers of a batch.
#include <algorithm>

#include "trace/light_lanes.h"
#include "trace/lights.h"

namespace lumi {

void Lights::weighInfinite(uint32_t infinite, const PlainLanes& lanes, std::span<const LightReceiver> receivers,
                           float* weights) const {
    if (infinite == suns_.size()) {
        const SkyCube cube = environment_.cube(kLeastSky * kPi * environment_.meanLuminance());
        return lightLaneKernels().weighSky(cube, lanes, weights);
    }
    const Sun& sun = suns_[infinite];
    if (sun.track < 0)
        return lightLaneKernels().weighSun(
            {sun.towards.x, sun.towards.y, sun.towards.z, 1 - sun.oneMinusCos, sun.sine, luminance(sun.irradiance)},
            lanes, weights);
    for (size_t i = 0; i < receivers.size(); ++i) weights[i] = infiniteImportance(receivers[i], infinite);
}

void Lights::chooseByImportance(const PlainLanes& lanes, std::span<const LightReceiver> receivers,
                                std::span<Choice> choices) const {
    const size_t count = receivers.size();
    // What the first infinite lights weigh is kept for the choice among them.
    constexpr uint32_t kKept = 4;
    alignas(64) float kept[kKept][PlainLanes::kMost], elsewhere[PlainLanes::kMost] = {};
    const auto infinite = static_cast<uint32_t>(entries_.size()) - finiteCount_;
    for (uint32_t k = 0; k < infinite; ++k) {
        float more[PlainLanes::kMost];
        float* const weights = k < kKept ? kept[k] : more;
        weighInfinite(k, lanes, receivers, weights);
        for (size_t i = 0; i < count; ++i) elsewhere[i] += weights[i];
    }
    LightTreeChoice found[PlainLanes::kMost];
    const auto &at = lanes.position, &normal = lanes.geometricNormal;
    if (finiteCount_ > 0)
        tree_.pick({at.x, at.y, at.z, normal.x, normal.y, normal.z, static_cast<int>(LightReceiver::Facing::Front)},
                   elsewhere, lanes.lightX, lanes.lightY, found, lanes.count);
    else
        for (size_t i = 0; i < count; ++i) found[i] = {kNone, true, 1, lanes.lightX[i]};
    for (size_t i = 0; i < count; ++i) {
        const LightTreeChoice& tree = found[i];
        const auto importanceOf = [&](uint32_t k) {
            return k < kKept ? kept[k][i] : infiniteImportance(receivers[i], k);
        };
        const Choice infinitely = chosenInfinite(tree.u, tree.probability, elsewhere[i], importanceOf);
        choices[i].entry = tree.elsewhere ? infinitely.entry : tree.light;
        choices[i].probability = tree.elsewhere ? infinitely.probability : tree.probability;
        prefetch(choices[i]);
    }
}

void Lights::choose(const PlainLanes& lanes, std::span<const LightReceiver> receivers,
                    std::span<Choice> choices) const {
    const size_t count = receivers.size();
    std::fill_n(choices.begin(), count, Choice());
    if (picks_.empty() || count == 0) return;
    if (receivers[0].sampling == LightSampling::Tree && entries_.size() > 1)
        return chooseByImportance(lanes, receivers, choices);
    for (size_t i = 0; i < count; ++i)
        prefetch(choices[i] = choose(receivers[i], Vec2(lanes.lightX[i], lanes.lightY[i])));
}

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

void Lights::placeSun(const Sun& sun, LightLanes& lights, int i) {
    lights.first.set(i, sun.towards);
    lights.second.x[i] = sun.oneMinusCos;
    lights.value.set(i, sun.oneMinusCos > 0 ? sun.radiance : sun.irradiance);
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
    if (entry.kind == Kind::Directional && suns_[entry.index].track < 0) {
        placeSun(suns_[entry.index], lights, i);
        return LightLanes::kSun;
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
    if (lights.has[LightLanes::kSun]) kernels.suns(lights, lanes);
    if (lights.has[LightLanes::kSky]) kernels.sky(environment_.grid(), lights, lanes);
}

}  // namespace lumi
