#pragma once
#include <map>
#include <memory>
#include <string>
#include <utility>

#include "support/module_harness.h"
#include "support/transport_scene.h"

namespace lumi::test {

/// A frame of a sequence: where the camera stands, and the size of the ball (-1: there is none).
struct Moment {
    float shift = 0, ball = 1;
    bool operator==(const Moment&) const = default;
};

/// A floor, a ball, a sheet that half of all rays pass, a lamp that is a sphere, and a dim sky.
inline std::shared_ptr<const PosedScene> sceneOf(float ball, float lamp = 20) {
    TinyScene tiny;
    tiny.add(floorMesh(), lambert(Vec3(0.6f, 0.5f, 0.4f)));
    Material gauze = lambert(0.7f);
    gauze.alphaMode = AlphaMode::Blend, gauze.alpha = 0.5f;
    tiny.add(boxMesh(Vec3(0.8f, 0.8f, 0.02f)), gauze, translation(Vec3(-0.8f, 0.5f, 1)));
    if (ball >= 0)
        tiny.add(sphereMesh(0.4f, 24, 12), lambert(0.6f), translation(Vec3(0.5f, 0.4f, 0)) * scaling(Vec3(ball)));
    Light light;
    light.type = LightType::Sphere, light.radius = 0.25f, light.radiance = Vec3(lamp);
    tiny.addLight(light, translation(Vec3(0, 1.3f, -0.5f)));
    tiny.scene.environment.constant = Vec3(0.1f);
    return tiny.pose();
}

inline Camera view(float shift = 0) { return lookFrom(Vec3(shift, 1.2f, 3.5f), Vec3(0.6f * shift, 0.6f, 0)); }

/// Runs frames of sequences.
class Player {
public:
    explicit Player(Extent2 extent) : extent_(extent) {}

    RunResult run(Module& module, FrameNumber frame, const std::shared_ptr<const PosedScene>& posed,
                  const Camera& camera, const Camera& before, Changes changes, std::stop_token stop = {}) {
        tracer_.bind(posed);
        changes.cut |= frame == 0;
        const CameraPose pose = poseCamera(camera, extent_);
        FrameSampling sampling = frameOf(camera, extent_, 1, plainPaths(2), {});
        sampling.frame = static_cast<uint32_t>(frame);
        TapSet wanted;
        for (const Tap& tap : module.taps()) wanted.insert(tap.name);
        StageTimer timer;
        return module.run({frame,
                           signals_,
                           *posed,
                           pose,
                           changes.cut ? pose : poseCamera(before, extent_),
                           changes,
                           wanted,
                           tracer_,
                           sampling,
                           timer,
                           std::move(stop),
                           {}},
                          image);
    }
    RunResult run(Module& module, FrameNumber frame, const Moment& now, const Moment& before,
                  std::stop_token stop = {}) {
        auto& posed = scenes_[now.ball];
        if (!posed) posed = sceneOf(now.ball);
        return run(module, frame, posed, view(now.shift), view(before.shift),
                   {.camera = now.shift != before.shift, .objects = now.ball != before.ball}, std::move(stop));
    }
    std::string digest(const Module& module) const { return digestOf(image, module); }

    Image image;

private:
    Extent2 extent_;
    Signals signals_;
    Tracer tracer_;
    std::map<float, std::shared_ptr<const PosedScene>> scenes_;
};

}  // namespace lumi::test
