#include "base/timer.h"
#include "session/frame_engine.h"
#include "session/frame_pose.h"
#include "session/view_buffers.h"

namespace lumi {

std::optional<FrameOutput> FrameEngine::preview(const Document& document, Extent2 extent, std::stop_token stop,
                                                std::stop_token sceneStop) {
    Timer total;
    const float time = document.time();
    previewed_ = pose(document, time, current_ ? current_->scene.get() : nullptr,
                      {current_ ? current_->scene : nullptr, previewed_}, sceneStop);
    if (!previewed_ || !bind(previewed_, sceneStop)) return std::nullopt;
    FrameSampling sampling;
    sampling.extent = extent;
    sampling.camera = sampling.previousCamera = poseCamera(document.camera(), extent);
    sampling.shutterOpen = sampling.camera.shutter > 0;
    sampling.seed = static_cast<uint32_t>(document.render().seed);
    sampling.jitter = Jitter::PerPixel;
    sampling.path = document.path();
    sampling.wanted = shownSignals(document);
    sampling.wanted.add(Signal::Noisy);
    const std::shared_ptr<Signals> signals = previewPool_.take();
    tracer_.resetCounts();
    Timer tracing;
    if (!tracer_.sample(sampling, *signals, stop)) return std::nullopt;

    FrameOutput frame;
    frame.time = time;
    frame.camera = sampling.camera;
    frame.scene = previewed_;
    frame.signals = signals;
    const auto raw = std::make_shared<Image>((*signals)[Signal::Noisy]);
    for (const std::string& name : document.activeInstances()) frame.results[name] = raw;
    frame.rays = tracer_.counts();
    frame.stagesMs = {{"trace", tracing.elapsedMs()}};
    frame.frameMs = total.elapsedMs();
    return frame;
}

std::vector<FrameCheck> FrameEngine::checkSignals(const Document& document, std::stop_token stop,
                                                  std::stop_token sceneStop) {
    bound_ = nullptr;  // the tracer is left bound to moments of the check
    return checkFrames(document, tracer_, stop, sceneStop);
}

std::shared_ptr<const Signals> FrameEngine::sampleAgain(const FrameSampling& sampling, std::stop_token stop) {
    auto signals = std::make_shared<Signals>();
    if (!tracer_.sample(sampling, *signals, stop)) return nullptr;
    return signals;
}

std::optional<Vec3> FrameEngine::surfaceAt(const CameraPose& camera, Pixel pixel) {
    if (!bound_) return std::nullopt;
    const Vec2 middle(static_cast<float>(pixel.x) + 0.5f, static_cast<float>(pixel.y) + 0.5f);
    const Ray ray = cameraStart(camera, middle, Vec2(0.5f), 0).ray;
    Hit hit;
    tracer_.closestHits({&ray, 1}, {&hit, 1});
    if (!hit.valid()) return std::nullopt;
    return ray.origin + ray.direction * hit.distance;
}

}  // namespace lumi
