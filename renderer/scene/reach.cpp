#include "scene/reach.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <vector>

#include "base/error.h"
#include "base/messages.h"
#include "base/parallel.h"
#include "scene/bounds.h"
#include "scene/posed_scene.h"

namespace lumi {
namespace {

/// A camera that sees all of what just lies in reach stands farther away.
constexpr float kCameraReach = 10 * kReach;

/// A number that tells what is wrong, if something is.
struct Fault {
    float most = kReach;
    bool found = false;
    float number = 0;
    void look(float x) {
        if (!found && !(std::abs(x) <= most)) found = true, number = x;
    }
    void look(const Vec3& p) { look(p.x), look(p.y), look(p.z); }
    void look(const Mat4& m) {
        for (int column = 0; column < 4; ++column) look(Vec3(m[column]));
    }
    void look(std::span<const Vec3> points) {
        const size_t first = firstOutOfReach(points);
        if (first < points.size()) look(points[first]);
    }
};

/// Looks at a matrix and where it places a box.
void lookAtPlaced(const Bounds3& box, const Mat4& m, Fault& fault) {
    fault.look(m);
    const Bounds3 placed = transformedBounds(box, m);
    if (!placed.empty()) fault.look(placed.lower), fault.look(placed.upper);
}

/// `atOpen` is where the instance is when the shutter opens.
Fault faultOf(const PosedInstance& pose, const Bounds3& meshBounds, const Bounds3& atOpen) {
    Fault fault;
    Bounds3 box = pose.deformed ? Bounds3() : meshBounds;
    const auto lookAtShape = [&](const DeformedVertices* shape) {
        if (!shape) return;
        fault.look(shape->positions);
        box.extend(boundsOf(shape->positions));
    };
    lookAtShape(pose.deformed.get());
    if (pose.deformedClose() != pose.deformed) lookAtShape(pose.deformedClose().get());
    if (pose.track())
        for (size_t i = 1; i < pose.track()->deformed.size(); ++i) lookAtShape(pose.track()->deformed[i].get());
    fault.look(pose.worldFromObject);
    if (!atOpen.empty()) fault.look(atOpen.lower), fault.look(atOpen.upper);
    if (pose.worldFromObjectClose() != pose.worldFromObject || pose.deformedClose() != pose.deformed)
        lookAtPlaced(box, pose.worldFromObjectClose(), fault);
    if (pose.track())
        for (const Mat4& m : pose.track()->worldFromObject) lookAtPlaced(box, m, fault);
    return fault;
}

Fault faultOf(const PosedLight& pose) {
    Fault fault;
    fault.look(pose.worldFromLight);
    for (const Mat4& m : pose.track) fault.look(m);
    return fault;
}

std::string shown(float number) { return std::isnan(number) ? "nan" : fmt::format("{:g}", number); }

std::string rangeText(float most) { return fmt::format("coordinates of {:g} to {:g} m", -most, most); }

[[noreturn]] void refuse(const std::string& what, const Fault& fault, const std::string& where) {
    throwBadInput({what, where, rangeText(fault.most), shown(fault.number)});
}

}  // namespace

bool isInReach(const Mat4& m) {
    for (int column = 0; column < 4; ++column)
        if (!isInReach(Vec3(m[column]))) return false;
    return true;
}

bool carriesRays(const Mat4& m) {
    // In double: a float's determinant underflows at a scale of 1e-13.
    constexpr double kMost = 1e7;  // times a camera's distance, 1e10 m: below 1.8e18
    const glm::dmat3 inverse = glm::inverse(glm::dmat3(glm::dmat4(m)));
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row)
            if (!(std::abs(inverse[column][row]) <= kMost)) return false;
    return true;
}

size_t firstOutOfReach(std::span<const Vec3> points) {
    const auto found = std::find_if(points.begin(), points.end(), [](const Vec3& p) { return !isInReach(p); });
    return static_cast<size_t>(found - points.begin());
}

std::string reachText() { return rangeText(kReach); }

std::string outOfReachText(const Vec3& p) {
    Fault fault;
    fault.look(p);
    return shown(fault.number);
}

void requireReach(const PosedScene& posed, std::span<const Bounds3> bounds) {
    const Scene& scene = *posed.scene;
    std::vector<Fault> faults(posed.instances.size());
    parallelRanges(static_cast<int64_t>(faults.size()), 16, [&](int64_t begin, int64_t end) {
        for (auto i = static_cast<size_t>(begin); i < static_cast<size_t>(end); ++i)
            if (!scene.instances[i].mesh->positions.empty())
                faults[i] = faultOf(posed.instances[i], (*posed.meshBounds)[i], bounds[i]);
    });
    const std::string time = posed.time != 0 ? fmt::format(" at {:g} s", posed.time) : std::string();
    for (size_t i = 0; i < faults.size(); ++i)
        if (faults[i].found)
            refuse(fmt::format("\"{}\" is too far or too large{}", scene.instances[i].name, time), faults[i],
                   scene.path);
    for (size_t i = 0; i < posed.lights.size(); ++i)
        if (const Fault fault = faultOf(posed.lights[i]); fault.found)
            refuse(fmt::format("the light \"{}\" is too far or too large{}", scene.lights[i].name, time), fault,
                   scene.path);
}

void requireReach(const CameraPose& camera, const std::string& where) {
    Fault fault{kCameraReach};
    fault.look(camera.worldFromCamera);
    const float height = static_cast<float>(std::max(camera.extent.height, 1));
    fault.look(camera.halfHeight * std::max(1.0f, static_cast<float>(camera.extent.width) / height));
    fault.look(camera.focus);
    if (fault.found) refuse("the camera is too far or sees too much", fault, where);
}

void warnOfDistance(const Scene& scene, MessageLog& log) {
    constexpr float kMostOfSize = 0.005f;
    const Bounds3 box = scene.restBounds();
    if (box.empty()) return;
    const float distance = std::max(maxComponent(-box.lower), maxComponent(box.upper));
    if (!(box.radius() > 0) || !isInReach(distance)) return;  // a single place, or what posing will refuse
    const float coarse = 256 * (std::nextafter(distance, kInfinity) - distance), start = std::max(coarse, 0x1p-16f);
    if (start <= kMostOfSize * box.radius()) return;
    const std::string file = std::filesystem::path(scene.path).filename().string();
    const std::string loss =
        fmt::format("rays may start {:.2g} m off surfaces, which loses shadows and light in corners", start);
    if (coarse >= start)
        log.warning(
            fmt::format("{}: lies {:.3g} m from the origin, where numbers are so coarse that {}; move it to the "
                        "origin",
                        file, distance, loss));
    else log.warning(fmt::format("{}: is {:.2g} m in size: {}; make it larger", file, 2 * box.radius(), loss));
}

}  // namespace lumi
