#pragma once
#include <gtest/gtest.h>

#include <memory>

#include "support/module_harness.h"
#include "support/transport_scene.h"
#include "trace/tracer.h"

namespace lumi::test {

/// Frames of one module in posed scenes of the test's own.
class Rig {
public:
    explicit Rig(Extent2 extent) : extent_(extent) { path.maxDepth = 2; }

    Image run(Module& module, FrameNumber frame, const std::shared_ptr<const PosedScene>& posed, const Camera& camera,
              Changes changes) {
        posed_ = posed;
        tracer.bind(posed);
        changes.cut |= frame == 0;
        const CameraPose pose = poseCamera(camera, extent_);
        if (changes.cut) previous_ = pose;
        FrameSampling sampling = frameOf(camera, extent_, 1, path, {});
        sampling.frame = static_cast<uint32_t>(frame);
        TapSet wanted;
        for (const Tap& tap : module.taps()) wanted.insert(tap.name);
        StageTimer timer;
        Image out;
        EXPECT_EQ(
            module.run({frame, signals_, *posed, pose, previous_, changes, wanted, tracer, sampling, timer, {}, {}},
                       out),
            RunResult::Completed);
        EXPECT_EQ(countNonFinite(out), 0);
        previous_ = pose;
        return out;
    }

    Tracer tracer;
    PathSettings path;

private:
    Extent2 extent_;
    Signals signals_;
    CameraPose previous_;
    std::shared_ptr<const PosedScene> posed_;
};

template <class T>
void set(T& module, const char* id, const ParameterValue& value) {
    setParameter([&](ParameterVisitor& v) { module.describe(v); }, id, value);
}

/// Balls over a floor under a lamp and a dim sky.
inline TinyScene balls(float scale = 1) {
    TinyScene tiny;
    tiny.add(floorMesh(), lambert(Vec3(0.6f, 0.5f, 0.4f)));
    for (int i = 0; i < 5; ++i)
        tiny.add(sphereMesh(0.4f, 24, 12), lambert(0.2f + 0.15f * static_cast<float>(i)),
                 translation(Vec3(static_cast<float>(i) - 2, 0.4f, 0.5f * static_cast<float>(i % 2))) *
                     scaling(Vec3(scale)));
    Light lamp;
    lamp.type = LightType::Sphere;
    lamp.radius = 0.3f;
    lamp.radiance = Vec3(20);
    tiny.addLight(lamp, translation(Vec3(1, 4, 2)));
    tiny.scene.environment.constant = Vec3(0.2f);
    return tiny;
}

inline Camera view(float shift = 0) { return lookFrom(Vec3(shift, 1.5f, 4), Vec3(shift, 0.4f, 0)); }

}  // namespace lumi::test
