// Rays that are no rays meet nothing, directions that are none look up some light, and what a transform flattens is
// seen.
#include <gtest/gtest.h>

#include <cmath>

#include <limits>

#include "support/expect_error.h"
#include "support/transport_scene.h"
#include "trace/environment.h"

namespace lumi {
namespace {

using namespace test;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
const float kBad[] = {kNan, kInfinity, -kInfinity, 3e38f, -1e19f};

void expectNothing(Tracer& tracer, const Ray& bad) {
    const Ray good{Vec3(0, 1, 0), 0, Vec3(0, -1, 0)};
    for (const size_t count : {size_t(1), size_t(40)}) {
        std::vector<Ray> rays(count, bad);
        if (count > 1) rays[7] = good;
        for (const bool coherent : {false, true}) {
            std::vector<Hit> hits(count);
            tracer.closestHits(rays, hits, {}, coherent);
            for (size_t i = 0; i < count; ++i) EXPECT_EQ(hits[i].valid(), count > 1 && i == 7);
        }
        std::vector<uint8_t> blocked(count, 2);
        tracer.occluded(rays, blocked);
        for (size_t i = 0; i < count; ++i) EXPECT_EQ(blocked[i], count > 1 && i == 7 ? 1 : 0);
    }
}

TEST(SafeRays, WhatIsNoRayMeetsNothing) {
    // Few triangles and many: shadow rays of the two go to Embree in different ways.
    for (const int segments : {4, 200}) {
        TinyScene tiny;
        tiny.add(floorMesh(), lambert(0.5f));
        const auto ball = std::make_shared<const Mesh>(sphereMesh(0.2f, segments, segments / 2));
        const int grey = tiny.addMaterial(lambert(0.5f));
        tiny.add(ball, grey, translation(Vec3(3, 0, 0)));
        tiny.add(ball, grey, translation(Vec3(4, 0, 0)));
        Tracer tracer;
        tracer.bind(tiny.pose());
        for (const float bad : kBad)
            for (int c = 0; c < 3; ++c) {
                Ray ray{Vec3(0, 1, 0), 0, Vec3(0, -1, 0)};
                ray.origin[c] = bad;
                expectNothing(tracer, ray);
                ray = {Vec3(0, 1, 0), 0, Vec3(0, -1, 0)};
                ray.direction[c] = bad;
                expectNothing(tracer, ray);
            }
        Ray ray{Vec3(0, 1, 0), 0, Vec3(0, -1, 0)};
        ray.tmin = kNan;
        expectNothing(tracer, ray);
        ray.tmin = 0, ray.tmax = kNan;
        expectNothing(tracer, ray);
    }
}

TEST(SafeRays, DirectionsThatAreNoneLookUpSomeLight) {
    auto image = std::make_shared<Image>(Extent2{16, 8}, 3);
    image->fill(0.5f);
    Environment sky;
    sky.image = image;
    EnvironmentLight light;
    light.build(sky);
    for (const float bad : kBad)
        for (int c = 0; c < 3; ++c) {
            Vec3 direction(0, 0, -1);
            direction[c] = bad;
            EXPECT_EQ(light.radiance(direction), Vec3(0.5f));
            EXPECT_GE(light.pdf(direction), 0);
        }
    EXPECT_EQ(light.radianceAt(Vec2(kNan, -3e38f)), Vec3(0.5f));
    EXPECT_EQ(light.radianceAt(Vec2(kInfinity, 7)), Vec3(0.5f));
}

Hit above(Tracer& tracer, float x) {
    const Ray down{Vec3(x, 5, 0), 0, Vec3(0, -1, 0)};
    Hit hit;
    tracer.closestHits({&down, 1}, {&hit, 1});
    return hit;
}

TEST(SafeRays, WhatATransformFlattensIsSeen) {
    TinyScene tiny;
    const int grey = tiny.addMaterial(lambert(0.5f));
    const auto ball = std::make_shared<const Mesh>(sphereMesh(1, 16, 8));
    const float heights[] = {0, 1e-30f, 1e-12f, 1};
    for (int i = 0; i < 4; ++i) tiny.add(ball, grey, translation(Vec3(3 * i, 0, 0)) * scaling(Vec3(1, heights[i], 1)));
    tiny.add(ball, grey, translation(Vec3(20, 0, 0)) * scaling(Vec3(0)));
    const auto posed = tiny.pose();
    Tracer tracer;
    tracer.bind(posed);
    for (int i = 0; i < 4; ++i) {
        const Hit hit = above(tracer, static_cast<float>(3 * i) + 0.1f);
        ASSERT_TRUE(hit.valid()) << heights[i];
        EXPECT_EQ(hit.point.instance, static_cast<uint32_t>(i));
        EXPECT_NEAR(hit.distance, 5 - (i == 3 ? 0.98f : 0), 0.03f);
        EXPECT_NEAR(tracer.position(hit.point).x, static_cast<float>(3 * i) + 0.1f, 1e-3f);
    }
    // A whole frame of it, with sky and reflections.
    Signals signals;
    const FrameSampling whole =
        frameOf(lookFrom({4, 3, 9}, {4, 0, 0}), {32, 18}, 2, PathSettings(), SignalSet{Signal::Noisy});
    ASSERT_TRUE(tracer.sample(whole, signals));
    const Image& noisy = signals[Signal::Noisy];
    for (size_t i = 0; i < noisy.size(); ++i) ASSERT_TRUE(std::isfinite(noisy.data()[i])) << i;
}

/// A mesh that bends, or one of two that move, is flat at time 0.5 and upright again after it.
TEST(SafeRays, WhatIsFlatForAMomentMovesOn) {
    for (const bool bends : {false, true}) {
        TinyScene tiny;
        Mesh ball = sphereMesh(1, 16, 8);
        if (bends) ball.morphTargets = {{std::vector<Vec3>(ball.positions.size(), Vec3(0)), {}, {}}};
        tiny.add(std::move(ball), lambert(0.5f));
        tiny.scene.nodes[0].hasMatrix = false;
        tiny.scene.nodes[0].morphWeights = {1};
        AnimationChannel channel;
        channel.node = 0;
        channel.property = AnimatedProperty::Scale;
        channel.times = {0, 0.5f, 1};
        channel.values = {1, 1, 1, 1, 0, 1, 1, -1, 1};
        tiny.scene.animations = {{{channel}, 1, false}};
        const auto scene = tiny.pose()->scene;
        Tracer tracer;
        std::shared_ptr<const PosedScene> before;
        for (const auto& [open, close, height] : {std::tuple(0.0f, 0.0f, 0.98f),
                                                  {0.5f, 0.5f, 0.0f},
                                                  {0.75f, 0.75f, 0.49f},
                                                  {0.5f, 0.6f, 0.0f},
                                                  {0.4f, 0.6f, 0.196f},
                                                  {0.25f, 0.25f, 0.49f}}) {
            before = poseScene(scene, {open, close, open}, before.get());
            tracer.bind(before);
            const Hit hit = above(tracer, 0.1f);
            ASSERT_TRUE(hit.valid()) << bends << ' ' << open << ' ' << close;
            EXPECT_NEAR(hit.distance, 5 - height, 0.02f) << bends << ' ' << open << ' ' << close;
        }
    }
}

TEST(SafeRays, FramesOfCamerasOutOfReachAreRefused) {
    TinyScene tiny;
    tiny.add(floorMesh(), lambert(0.5f));
    Tracer tracer;
    tracer.bind(tiny.pose());
    Signals signals;
    Camera camera = lookFrom({0, 1e30f, 0}, Vec3(0));
    const SignalSet wanted{Signal::Noisy};
    expectError(ErrorKind::BadInput,
                [&] {
                    tracer.sample(frameOf(camera, {8, 8}, 1, PathSettings(), wanted), signals);
                },
                {"the camera", "1e+30"});
    camera = lookFrom({0, 1, 3}, Vec3(0));
    FrameSampling sampling = frameOf(camera, {8, 8}, 1, PathSettings(), wanted);
    EXPECT_TRUE(tracer.sample(sampling, signals));
    sampling.cameraTrack = {sampling.camera, sampling.camera};
    sampling.cameraTrack[1].worldFromCamera[3].x = kNan;
    expectError(ErrorKind::BadInput, [&] { tracer.sample(sampling, signals); }, {"the camera", "nan"});
}

}  // namespace
}  // namespace lumi
