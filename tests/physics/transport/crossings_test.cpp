// What passes a border while the shutter is open: things and lights that mirror, cameras that dive.
#include <gtest/gtest.h>

#include <cstring>

#include "support/image_tests.h"
#include "support/posed_frames.h"
#include "support/transport_scene.h"

namespace lumi {
namespace {

using namespace test;

constexpr Extent2 kExtent{20, 14};

Camera camera() { return lookFrom(Vec3(0.3f, 1.8f, 4), Vec3(0, 0.6f, 0), 45); }

FrameSampling shutterFrame(int spp, DirectStrategy strategy, uint32_t seed) {
    FrameSampling sampling = frameOf(camera(), kExtent, spp, plainPaths(2, strategy), kMoments, seed);
    sampling.shutterOpen = true;
    return sampling;
}

/// A node whose scale goes from one to the other in the first second.
int scaledNode(TinyScene& tiny, const Vec3& from, const Vec3& to) {
    const int node = tiny.addNode(Mat4(1));
    tiny.scene.nodes[static_cast<size_t>(node)].hasMatrix = false;
    Animation animation;
    animation.duration = 1, animation.loop = false;
    animation.channels.push_back(channel(node, AnimatedProperty::Scale, 3, {from.x, from.y, from.z, to.x, to.y, to.z}));
    tiny.scene.animations.push_back(animation);
    return node;
}

/// Over a floor: a wedge, dull or shining on its outside alone, a rectangle and a disk, under nodes that mirror.
/// The wedge may be carried by a joint.
TinyScene mirroring(bool wedgeShines, bool wedgeMorphs = false, bool wedgeIsSkinned = false) {
    TinyScene tiny;
    tiny.add(floorMesh(10), lambert(0.7f));
    // Parents come before their children.
    const int flip = scaledNode(tiny, Vec3(1), Vec3(-1, 1, 1)), flop = scaledNode(tiny, Vec3(1), Vec3(1, 0.6f, -1));
    const auto putUnder = [&](int parent) { tiny.scene.nodes.back().parent = parent; };
    const std::shared_ptr<Mesh> wedge = std::make_shared<Mesh>(boxMesh(Vec3(0.7f, 0.9f, 0.5f)));
    for (Vec3& p : wedge->positions)
        if (p.y > 0) p.x *= 0.2f;
    wedge->normals.clear();
    if (wedgeMorphs) {
        MorphTarget target;
        for (const Vec3& p : wedge->positions) target.positions.push_back(Vec3(0.5f * p.y, 0.4f * p.x, 0));
        wedge->morphTargets.push_back(target);
    }
    Material material = lambert(Vec3(0.8f, 0.4f, 0.2f));
    material.doubleSided = false;
    if (wedgeShines) material.emission = Vec3(3, 2, 1);
    tiny.add(wedge, tiny.addMaterial(material), translation(Vec3(0.6f, 0.5f, 0.2f)));
    putUnder(flip);
    int node = static_cast<int>(tiny.scene.nodes.size()) - 1;
    if (wedgeIsSkinned) {
        for (uint32_t v = 0; v <= wedge->positions.size(); ++v) wedge->skin.first.push_back(v);
        wedge->skin.joint.assign(wedge->positions.size(), 0);
        wedge->skin.weight.assign(wedge->positions.size(), 1);
        tiny.scene.skins.push_back({{node}, {Mat4(1)}});
        node = tiny.addNode(Mat4(1));
        tiny.scene.instances.back().node = node, tiny.scene.instances.back().skin = 0;
    }
    if (wedgeMorphs) {
        tiny.scene.nodes.back().morphWeights = {0};
        tiny.scene.animations[0].channels.push_back(channel(node, AnimatedProperty::MorphWeights, 1, {0, 1}));
    }
    Light lamp;
    lamp.radiance = Vec3(9);
    lamp.size = Vec2(0.9f, 0.6f), lamp.radius = 0.4f;
    lamp.type = LightType::Rectangle;
    tiny.addLight(lamp, lookAt(Vec3(-1.4f, 1.6f, 0.3f), Vec3(-1, 0, 0)));
    putUnder(flop);
    lamp.type = LightType::Disk;
    tiny.addLight(lamp, lookAt(Vec3(1, 1.6f, 0.3f), Vec3(0.7f, 0, 0)));
    putUnder(flip);
    tiny.scene.environment.constant = Vec3(0.1f);
    return tiny;
}

TEST(Mirroring, ConvergesToTheMeanOfPosedFrames) {
    for (const int kind : {0, 1, 2, 3}) {
        SCOPED_TRACE(kind);
        const auto scene = mirroring(kind > 0, kind > 1, kind > 2).pose()->scene;
        Tracer tracer;
        Signals frame, blurred;
        Mean mean;
        for (uint32_t i = 0; i < 600; ++i) {
            const float t = number(static_cast<uint32_t>(kind), i);
            tracer.bind(poseScene(scene, {t, t, t}));
            ASSERT_TRUE(tracer.sample(frameOf(camera(), kExtent, 1, plainPaths(2), {Signal::Noisy}, 100 + i), frame));
            mean.add(frame);
        }
        const Signals posed = mean.signals(kExtent);
        tracer.bind(poseScene(scene, {0, 1, 0}));
        for (const DirectStrategy strategy : {DirectStrategy::Mis, DirectStrategy::Light, DirectStrategy::Bsdf}) {
            const int spp = strategy == DirectStrategy::Bsdf ? 2400 : 600;
            ASSERT_TRUE(tracer.sample(shutterFrame(spp, strategy, 7), blurred));
            EXPECT_GE(agreeingShare(blurred, posed), 0.9975) << static_cast<int>(strategy);
            EXPECT_LT(std::abs(biasInSigmas(blurred, posed)), 4) << static_cast<int>(strategy);
        }
        tracer.bind(poseScene(scene, {0, 0, 0}));
        ASSERT_TRUE(tracer.sample(shutterFrame(600, DirectStrategy::Mis, 8), frame));
        EXPECT_LT(agreeingShare(frame, posed), 0.9) << "the still image";
    }
}

TEST(Mirroring, FollowsInOneTracer) {
    const auto scene = mirroring(true).pose()->scene;
    Tracer kept;
    Signals a, b;
    for (const Vec2 open : {Vec2(0, 0), Vec2(0, 0.4f), Vec2(0.3f, 0.7f), Vec2(0.4f, 0.8f), Vec2(0.6f, 1), Vec2(1, 1)}) {
        const auto posed = poseScene(scene, {open.x, open.y, open.x});
        Tracer fresh;
        fresh.bind(posed);
        kept.bind(posed);
        FrameSampling sampling = shutterFrame(2, DirectStrategy::Mis, 1);
        sampling.shutterOpen = open.y > open.x;
        ASSERT_TRUE(fresh.sample(sampling, a));
        ASSERT_TRUE(kept.sample(sampling, b));
        const Image &x = a[Signal::Noisy], &y = b[Signal::Noisy];
        EXPECT_EQ(std::memcmp(x.data(), y.data(), x.bytes()), 0) << open.x;
    }
}

constexpr float kFrom = 0.9f, kTo = -0.4f, kTop = 0.5f;

/// Drink up to kTop, and the sky.
TinyScene pool() {
    TinyScene tiny;
    Material drink = glass(0);
    drink.ior = 1.0001f;
    drink.attenuationColor = Vec3(0.25f);
    drink.attenuationDistance = 0.5f;
    tiny.add(boxMesh(Vec3(4, 1, 4)), drink);
    tiny.scene.environment.constant = Vec3(1);
    return tiny;
}

/// The sky straight above an eye that goes down evenly: 1 as long as it is above the water, then less.
double skyOnTheWayDown() {
    const double rate = -std::log(0.25) / 0.5;
    return ((kFrom - kTop) + (1 - std::exp(-rate * (kTop - kTo))) / rate) / (kFrom - kTo);
}

Camera upwards(float y) {
    Camera camera = lookFrom(Vec3(0.1f, y, 0.2f), Vec3(0.1f, y + 1, 0.2f), 1);
    camera.up = Vec3(0, 0, 1);
    return camera;
}

double meanOf(const Signals& frame) {
    double sum = 0;
    for (int y = 0; y < kExtent.height; ++y)
        for (int x = 0; x < kExtent.width; ++x) sum += frame[Signal::Noisy].at(0, x, y);
    return sum / static_cast<double>(kExtent.area());
}

TEST(Diving, IsInTheWaterWhenTheCameraIs) {
    Tracer tracer;
    tracer.bind(pool().pose());
    FrameSampling sampling = frameOf(upwards(kFrom), kExtent, 256, plainPaths(4), {Signal::Noisy}, 3);
    sampling.shutterOpen = true;
    for (int i = 0; i <= 4; ++i)
        sampling.cameraTrack.push_back(poseCamera(upwards(kFrom + (kTo - kFrom) * static_cast<float>(i) / 4), kExtent));
    Signals frame;
    ASSERT_TRUE(tracer.sample(sampling, frame));
    EXPECT_NEAR(meanOf(frame), skyOnTheWayDown(), 0.003);
}

TEST(Diving, IsInTheWaterWhenThatRises) {
    TinyScene tiny = pool();
    const int node = tiny.scene.instances[0].node;
    tiny.scene.nodes[static_cast<size_t>(node)].hasMatrix = false;
    Animation rise;
    rise.duration = 1, rise.loop = false;
    rise.channels.push_back(channel(node, AnimatedProperty::Translation, 3, {0, 0, 0, 0, kFrom - kTo, 0}));
    tiny.scene.animations.push_back(rise);
    Tracer tracer;
    tracer.bind(tiny.pose({0, 1, 0}));
    FrameSampling sampling = frameOf(upwards(kFrom), kExtent, 256, plainPaths(4), {Signal::Noisy}, 3);
    sampling.shutterOpen = true;
    Signals frame;
    ASSERT_TRUE(tracer.sample(sampling, frame));
    EXPECT_NEAR(meanOf(frame), skyOnTheWayDown(), 0.003);
}

// Starts of a method of its own, in any order.
TEST(Diving, EachStartHasItsTime) {
    Tracer tracer;
    tracer.bind(pool().pose());
    std::vector<PathStart> starts(20000);
    for (size_t i = 0; i < starts.size(); ++i) {
        const float time = number(5, static_cast<uint32_t>(i));
        starts[i].ray.origin = Vec3(0.1f, kFrom + (kTo - kFrom) * time, 0.2f);
        starts[i].ray.direction = Vec3(0, 1, 0);
        starts[i].ray.time = time, starts[i].ray.fromCamera = true;
        starts[i].cone.spread = 1e-3f;
        starts[i].key = {7, 11, static_cast<uint32_t>(i)};
        starts[i].slot = static_cast<uint32_t>(i);
    }
    std::vector<Vec3> radiance(starts.size());
    ASSERT_TRUE(tracer.tracePaths(starts, plainPaths(4), 1, radiance, {}));
    for (size_t i = 0; i < starts.size(); ++i) {
        const float depth = kTop - starts[i].ray.origin.y;
        if (std::abs(depth) < 1e-3f) continue;
        ASSERT_NEAR(radiance[i].y, std::pow(0.25f, std::max(depth, 0.0f) / 0.5f), 1e-3f) << depth;
    }
}

}  // namespace
}  // namespace lumi
