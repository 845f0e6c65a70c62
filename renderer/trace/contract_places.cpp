// Rules of the signals' contract about where things are and were.
#include <array>
#include <bitset>
#include <cmath>
#include <optional>

#include "math/statistics.h"
#include "trace/blue_noise.h"
#include "trace/camera_starts.h"
#include "trace/contract_rules.h"

namespace lumi::contract {
namespace {

/// Parallel rays also see what is close to the plane of the camera, where depths have no digits.
bool isClose(const CameraPose& camera, const Vec3& world) {
    const Vec3 place = transformPoint(camera.cameraFromWorld, world);
    return camera.projection == Projection::Orthographic &&
           std::abs(place.z) < 0.01f * std::max(glm::length(place), camera.halfHeight);
}

/// What motion has to be, and the view depth that it is measured against.
struct ExpectedMotion {
    Vec3 motion;
    double depth;
};

/// The camera at the world's origin: it sees directions as points.
CameraPose atOrigin(CameraPose camera) {
    camera.worldFromCamera[3] = camera.cameraFromWorld[3] = Vec4(0, 0, 0, 1);
    return camera;
}

/// Only turning moves the sky, and only where rays are not parallel. None where the sky is not empty, which is another
/// rule's, or was behind the camera.
std::optional<ExpectedMotion> skyMotionAt(const CheckedFrame& frame, Pixel p, const CameraPose& now,
                                          const CameraPose& before) {
    if (frame.signals[Signal::Depth].at(0, p.x, p.y) != kInfinity) return {};
    if (now.projection != Projection::Perspective || before.projection != Projection::Perspective)
        return ExpectedMotion{Vec3(0), 1};
    const Vec3 direction = frame.direction(p);
    const Vec3 from = atOrigin(before).project(direction), to = atOrigin(now).project(direction);
    if (!(from.z > 0)) return {};
    return ExpectedMotion{{from.x - to.x, from.y - to.y, 0}, 1};
}

/// None where it was behind the camera.
std::optional<ExpectedMotion> expectedMotion(const CheckedFrame& frame, Pixel p) {
    const CameraPose now = frame.camera(p), before = frame.sampling.previousCameraAt(frame.time(p));
    if (frame.sky(p)) return skyMotionAt(frame, p, now, before);
    const SurfacePoint point = frame.point(p);
    const Vec3 to = now.project(frame.tracer.position(point)), from = before.project(frame.before.position(point));
    if (!(from.z > 0) && before.projection == Projection::Perspective) return {};
    return ExpectedMotion{from - to, std::max(std::abs(from.z), std::abs(to.z))};
}

/// Offset of the frame's first sample from the pixel's upper left corner, in pixels; through a pinhole.
Vec2 offsetAt(const CheckedFrame& frame, Pixel p) {
    const Vec3 at = frame.camera(p).project(colourAt(frame.signals[Signal::Position], p));
    return {at.x - static_cast<float>(p.x), at.y - static_cast<float>(p.y)};
}

/// Whether a float holds places on the surface to a few hundredths of a pixel: neither the place nor its triangle's
/// corners, between which it is found, are too far away for that, nor is it seen edge-on, where the barycentrics of a
/// sliver do not.
bool holdsOffsets(const CheckedFrame& frame, Pixel p) {
    const Vec3 place = colourAt(frame.signals[Signal::Position], p);
    const CameraPose camera = frame.camera(p);
    const Vec3 away =
        camera.projection == Projection::Perspective ? glm::normalize(place - camera.position()) : camera.forward();
    if (std::abs(glm::dot(away, colourAt(frame.signals[Signal::GeometricNormal], p))) < 0.05f) return false;
    float scale = std::max(maxComponent(glm::abs(place)), frame.signals[Signal::Depth].at(0, p.x, p.y));
    SurfacePoint corner = frame.point(p);
    for (const Vec2 b : {Vec2(0, 0), Vec2(1, 0), Vec2(0, 1)}) {
        corner.barycentrics = b;
        scale = std::max(scale, maxComponent(glm::abs(frame.tracer.position(corner))));
    }
    const Vec3 aside = place + Vec3(camera.worldFromCamera[0]) * (scale * 0x1p-22f);
    return glm::distance(Vec2(camera.project(aside)), Vec2(camera.project(place))) < 0.05f;
}

/// 1 / depth, on the surface's tangent plane, of what is at `pixel`; plane and place as the camera sees them.
double inverseDepthAt(const CameraPose& camera, const Vec3& place, const Vec3& normal, double pixelX, double pixelY) {
    const double x = (pixelX - 0.5 * camera.extent.width) * camera.pixelSize(),
                 y = (0.5 * camera.extent.height - pixelY) * camera.pixelSize();
    const double across = normal.x * x + normal.y * y;
    const double plane = double(normal.x) * place.x + double(normal.y) * place.y + double(normal.z) * place.z;
    return camera.projection == Projection::Perspective ? (across - normal.z) / plane : normal.z / (across - plane);
}

/// Needs a pinhole and enough surface; else there is nothing to check.
ContractFinding uniformOffsets(const CheckedFrame& frame) {
    constexpr int kCells = 8, kEnough = 5 * kCells * kCells, kSide = BlueNoiseTile::kSide;
    Rule rule("sub-pixel offsets are uniform (chi-square test; -log10 of the p-value)", 6);
    std::array<double, kCells * kCells> observed{};
    int64_t count = 0;
    std::bitset<kSide * kSide> seen;
    const bool repeats = frame.sampling.path.sampler == SamplerKind::BlueNoise;
    frame.eachSurface([&](Pixel p) {
        // Blue noise repeats from tile to tile: the same offsets again would make a small deviation a sure one.
        const size_t place = static_cast<size_t>(p.y % kSide * kSide + p.x % kSide);
        if ((repeats && seen[place]) || !holdsOffsets(frame, p)) return;
        seen[place] = true;
        const Vec2 offset = offsetAt(frame, p);
        const auto cell = [&](float o) { return std::clamp(static_cast<int>(o * kCells), 0, kCells - 1); };
        observed[static_cast<size_t>(cell(offset.y) * kCells + cell(offset.x))] += 1;
        ++count;
    });
    if (frame.sampling.camera.aperture > 0 || count < kEnough) return rule.take();
    const std::vector<double> expected(observed.size(),
                                       static_cast<double>(count) / static_cast<double>(observed.size()));
    rule.checkTogether(count, -std::log10(std::max(chiSquareTest(observed, expected), 1e-300)));
    return rule.take();
}

ContractFinding oneOffset(const CheckedFrame& frame) {
    Rule rule("all pixels have the frame's one sub-pixel offset", 0.1, "px");
    if (frame.sampling.camera.aperture > 0) return rule.take();
    const Vec2 centre(0.5f), expected = frame.sampling.jitter == Jitter::PerFrame
                                            ? centre + frameJitter(frame.sampling.firstSample, frame.sampling.seed)
                                            : centre;
    frame.eachSurface([&](Pixel p) {
        if (holdsOffsets(frame, p)) rule.check(p, glm::distance(offsetAt(frame, p), expected));
    });
    return rule.take();
}

}  // namespace

/// By small differences on the plane; not where a surface is seen edge-on, which leaves no digits.
ContractFinding depthGradients(const CheckedFrame& frame) {
    Rule rule("depthGradient is the change of 1/depth from pixel to pixel, relative to it", 1e-3);
    constexpr double kStep = 1e-3;  // of a pixel: what parallel rays see is not straight
    frame.eachSurface([&](Pixel p) {
        const CameraPose camera = frame.camera(p);
        const Vec3 world = colourAt(frame.signals[Signal::Position], p), at = camera.project(world);
        if (!holdsOffsets(frame, p) || isClose(camera, world)) return;
        const Vec3 place = transformPoint(camera.cameraFromWorld, world);
        const Vec3 normal =
            transformVector(camera.cameraFromWorld, colourAt(frame.signals[Signal::GeometricNormal], p));
        const auto slope = [&](double stepX, double stepY) {
            return (inverseDepthAt(camera, place, normal, at.x + stepX, at.y + stepY) -
                    inverseDepthAt(camera, place, normal, at.x - stepX, at.y - stepY)) /
                   (2 * kStep);
        };
        const double x = slope(kStep, 0), y = slope(0, kStep);
        const Image& found = frame.signals[Signal::DepthGradient];
        const double error = std::hypot(found.at(0, p.x, p.y) - x, found.at(1, p.x, p.y) - y);
        rule.check(p, error / (std::hypot(x, y) + 1e-3 * camera.pixelSize() / std::abs(place.z)), error);
    });
    return rule.take();
}

ContractFinding motionVectors(const CheckedFrame& frame) {
    Rule rule("motion leads to the previous pixel", 0.01, "px");
    frame.eachPixel([&](Pixel p) {
        const auto expected = expectedMotion(frame, p);
        if (!expected) return;
        const Vec3 motion = colourAt(frame.signals[Signal::Motion], p);
        const double error = glm::distance(Vec2(expected->motion), Vec2(motion));
        // Far off the image a float holds no hundredth of a pixel.
        rule.check(p, error / std::max(1.0, std::hypot(motion.x, motion.y) * 1e-3), error);
    });
    return rule.take();
}

ContractFinding depthMotion(const CheckedFrame& frame) {
    Rule rule("motion's third channel is the change of view depth, relative to it", 1e-3);
    frame.eachPixel([&](Pixel p) {
        if (!frame.sky(p) && isClose(frame.camera(p), colourAt(frame.signals[Signal::Position], p))) return;
        const auto expected = expectedMotion(frame, p);
        if (!expected) return;
        const double error = std::abs(double(frame.signals[Signal::Motion].at(2, p.x, p.y)) - expected->motion.z);
        rule.check(p, error / expected->depth, error);
    });
    return rule.take();
}

ContractFinding jitterDistribution(const CheckedFrame& frame) {
    return frame.sampling.jitter == Jitter::PerPixel ? uniformOffsets(frame) : oneOffset(frame);
}

}  // namespace lumi::contract
