#include "session/signals_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "math/transform.h"
#include "scene/camera_frame.h"

namespace lumi {
namespace {

constexpr int kLargestSide = 320;
constexpr float kOrbitDeg = 0.5f;
constexpr int kSamples = 2;

/// The document's image, made small.
Extent2 smallExtent(const RenderSettings& render) {
    const double scale = std::min(1.0, static_cast<double>(kLargestSide) / std::max(render.width, render.height));
    const auto side = [&](int full) { return std::max(1, static_cast<int>(std::lround(full * scale))); };
    return {side(render.width), side(render.height)};
}

/// The camera on a circle around its target, about its up direction; one that looks along that turns about the image's
/// up.
Camera orbited(Camera camera, float degrees) {
    const float angle = glm::radians(degrees);
    const Vec3 up = unitUp(camera), arm = camera.eye - camera.target;
    const bool along = glm::length(glm::cross(up, arm)) <= 1e-6f * glm::length(arm);
    const Vec3 axis = along ? Vec3(lookAt(camera.eye, camera.target, up)[1]) : up;
    camera.eye = camera.target + arm * std::cos(angle) + glm::cross(axis, arm) * std::sin(angle) +
                 axis * (glm::dot(axis, arm) * (1 - std::cos(angle)));
    return camera;
}

/// The document's camera over the open shutter, for the small image.
CameraTrack smallTrack(const Document& document, Extent2 extent) {
    CameraTrack track = document.cameraTrack();
    for (CameraPose& pose : track) pose.extent = extent;
    return track;
}

FrameCheck checkFrame(Tracer& tracer, const Tracer& before, const FrameSampling& sampling, std::stop_token stop) {
    Signals signals;
    if (!tracer.sample(sampling, signals, stop)) throw Error(ErrorKind::Interrupted, {"interrupted", "", "", ""});
    FrameCheck check;
    check.frame = static_cast<int>(sampling.frame);
    check.findings = checkSignals(signals, sampling, tracer, before);
    return check;
}

}  // namespace

bool FrameCheck::holds() const {
    return std::all_of(findings.begin(), findings.end(),
                       [](const ContractFinding& finding) { return finding.holds(); });
}

std::vector<FrameCheck> checkFrames(Document document, Tracer& tracer, std::stop_token stop,
                                    std::stop_token sceneStop) {
    const Extent2 extent = smallExtent(document.render());
    const std::string size = fmt::format("{}x{}, {} samples a pixel", extent.width, extent.height, kSamples);
    const float start = document.time();
    FrameSampling sampling;
    sampling.extent = extent;
    sampling.camera = sampling.previousCamera = poseCamera(document.camera(), extent);
    sampling.samplesPerPixel = kSamples;
    sampling.seed = static_cast<uint32_t>(document.render().seed);
    sampling.jitter = Jitter::PerPixel;
    sampling.path = document.path();
    sampling.wanted = contractSignals();

    // With the shutter open every pixel has a time of its own, and the rules hold at that time.
    const float open = document.camera().shutter / document.render().fps;
    sampling.shutterOpen = open > 0;
    sampling.cameraTrack = sampling.previousCameraTrack = smallTrack(document, extent);

    const auto first = poseScene(document.scene(), {start, start + open, start}, nullptr, sceneStop);
    // What moves is looked up in a scene of its own, not in what the signals were made of.
    const bool animated = document.scene()->isAnimated();
    Tracer other;
    Tracer& before = animated ? other : tracer;
    before.bind(first, sceneStop);
    std::vector<FrameCheck> checks{checkFrame(before, before, sampling, stop)};
    checks.back().what = size + ", jitter per pixel";

    if (animated) document.setTime(start + 1 / document.render().fps);
    sampling.frame = 1;
    sampling.firstSample = kSamples;
    sampling.previousCamera = sampling.camera;
    sampling.cameraTrack = smallTrack(document, extent);
    const bool moving = !sampling.cameraTrack.empty() || !sampling.previousCameraTrack.empty();
    // A camera that moves by itself is left to that.
    sampling.camera = poseCamera(moving ? document.camera() : orbited(document.camera(), kOrbitDeg), extent);
    sampling.jitter = Jitter::PerFrame;
    tracer.bind(poseScene(document.scene(), {document.time(), document.time() + open, start}, first.get(), sceneStop),
                sceneStop);
    checks.push_back(checkFrame(tracer, before, sampling, stop));
    checks.back().what = size + ", jitter per frame, camera " + (moving ? "moving under an open shutter" : "moved") +
                         (animated ? ", one frame later" : "");
    return checks;
}

}  // namespace lumi
