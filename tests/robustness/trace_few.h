#pragma once
#include <cmath>
#include <memory>
#include <stdexcept>
#include <utility>

#include "scene/posed_scene.h"
#ifndef LUMISCOPE_POSE_ONLY
#include "trace/contract_check.h"
#include "trace/tracer.h"
#endif

namespace lumi {

#ifdef LUMISCOPE_POSE_ONLY
inline void traceAFew(std::shared_ptr<const Scene> scene) { poseScene(std::move(scene), {0.3f, 0.3f, 0.2f}); }
#else

/// The first camera; where there is none, one that sees what is there.
inline Camera someCamera(const PosedScene& posed) {
    if (!posed.scene->cameras.empty()) return cameraAt(*posed.scene, 0, posed.time);
    Camera camera;
    if (!posed.bounds.empty()) {
        camera.target = posed.bounds.centre();
        camera.eye = camera.target + Vec3(0.1f, 0.2f, 1) * (3 * posed.bounds.radius() + 1);
    }
    return camera;
}

/// `scene` with a sky of few texels in place of the built-in one, whose tables would take longer than all the rest, and
/// with one where there is no light: what leaves the scene looks its direction up.
inline std::shared_ptr<const Scene> underSmallSky(std::shared_ptr<const Scene> scene) {
    static const auto sky = [] {
        auto image = std::make_shared<Image>(Extent2{16, 8}, 3);
        image->fill(0.5f);
        return image;
    }();
    if (!scene->environment.file.empty()) return scene;
    auto copy = std::make_shared<Scene>(*scene);
    copy->environment.image = sky;
    return copy;
}

/// What a session does with a scene once it is open: two small frames, the second with the shutter open and one step
/// on, all signals asked for. Throws Error as they do, and std::runtime_error for light that is no number.
inline void traceAFew(std::shared_ptr<const Scene> loaded) {
    static Tracer tracer;
    const std::shared_ptr<const Scene> scene = underSmallSky(std::move(loaded));
    FrameSampling sampling;
    sampling.extent = {8, 6};
    sampling.path.maxDepth = 3;
    sampling.wanted = contractSignals();
    std::shared_ptr<const PosedScene> posed;
    for (const ShutterTimes& times : {ShutterTimes{0.3f, 0.3f, 0.3f}, ShutterTimes{0.4f, 0.43f, 0.3f}}) {
        posed = poseScene(scene, times, posed.get());
        tracer.bind(posed);
        sampling.camera = poseCamera(someCamera(*posed), sampling.extent);
        if (sampling.frame == 0) sampling.previousCamera = sampling.camera;
        sampling.shutterOpen = times.close > times.open;
        Signals signals;
        tracer.sample(sampling, signals);
        const Image& noisy = signals[Signal::Noisy];
        for (int y = 0; y < sampling.extent.height; ++y)
            for (int x = 0; x < sampling.extent.width; ++x)
                for (int c = 0; c < 3; ++c)
                    if (!std::isfinite(noisy.at(c, x, y))) throw std::runtime_error("a pixel is no number");
        ++sampling.frame, ++sampling.firstSample;
    }
}
#endif

}  // namespace lumi
