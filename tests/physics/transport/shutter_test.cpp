// The open shutter and the lens against brute force: posed frames at random times, rays through random points of the
// lens.
#include <gtest/gtest.h>

#include <cstring>

#include "support/image_tests.h"
#include "support/light_scene.h"
#include "support/posed_frames.h"

namespace lumi {
namespace {

using namespace test;

constexpr Extent2 kExtent{20, 14};
constexpr float kExposure = 0.8f;  ///< seconds that the shutter is open

/// Makes the node of the last instance or light an animated one.
int movingNode(TinyScene& tiny, int node, std::vector<float> from, std::vector<float> turn) {
    Node& n = tiny.scene.nodes[static_cast<size_t>(node)];
    n.hasMatrix = false;
    Animation animation;
    animation.duration = 1;
    animation.loop = false;
    animation.channels.push_back(channel(node, AnimatedProperty::Translation, 3, std::move(from)));
    if (!turn.empty()) animation.channels.push_back(channel(node, AnimatedProperty::Rotation, 4, std::move(turn)));
    tiny.scene.animations.push_back(animation);
    return node;
}

const float kHalf = std::sqrt(0.5f);

/// A box that turns a right angle on its way, a wall that shears, a strip on a turning joint, a shining crystal, a lamp
/// of each shape, all moving; over a floor under a dim sky.
TinyScene everythingMoves() {
    TinyScene tiny;
    tiny.add(floorMesh(12), lambert(0.6f));
    tiny.scene.environment.constant = Vec3(0.25f);
    const auto nodeOf = [&](int instance) { return tiny.scene.instances[static_cast<size_t>(instance)].node; };
    movingNode(tiny, nodeOf(tiny.add(boxMesh(Vec3(0.8f, 0.5f, 0.6f)), lambert(Vec3(0.8f, 0.3f, 0.2f)))),
               {-1.4f, 0.5f, 0, -0.6f, 0.6f, 0.3f}, {0, 0, 0, 1, 0, kHalf, 0, kHalf});

    Mesh wall = rectangleMesh(1, 1, Facing::Z, 3, 3);
    MorphTarget target;
    for (const Vec3& p : wall.positions) target.positions.push_back(Vec3(0.7f * p.y, 0.3f * p.x * p.x, 0.3f * p.x));
    wall.morphTargets.push_back(target);
    const int shearing =
        nodeOf(tiny.add(std::move(wall), lambert(Vec3(0.2f, 0.7f, 0.3f)), translation(Vec3(0.3f, 0.7f, -0.5f))));
    tiny.scene.nodes[static_cast<size_t>(shearing)].morphWeights = {0};
    Animation morph;
    morph.duration = 1, morph.loop = false;
    morph.channels.push_back(channel(shearing, AnimatedProperty::MorphWeights, 1, {0, 1}));
    tiny.scene.animations.push_back(morph);

    Mesh strip = rectangleMesh(0.7f, 0.7f, Facing::Z, 3, 3);
    for (uint32_t v = 0; v <= strip.positions.size(); ++v) strip.skin.first.push_back(v);
    strip.skin.joint.assign(strip.positions.size(), 0);
    strip.skin.weight.assign(strip.positions.size(), 1);
    const int skinned = tiny.add(std::move(strip), lambert(Vec3(0.2f, 0.3f, 0.8f)));
    const int joint =
        movingNode(tiny, tiny.addNode(Mat4(1)), {1.3f, 0.6f, 0, 1.1f, 0.8f, 0}, {0, 0, 0, 1, 0, kHalf, 0, kHalf});
    tiny.scene.instances[static_cast<size_t>(skinned)].skin = 0;
    tiny.scene.skins.push_back({{joint}, {Mat4(1)}});

    Material glow = lambert(0);
    glow.emission = Vec3(2, 2.5f, 1);
    movingNode(tiny, nodeOf(tiny.add(facetedSphere(0.25f, 6), glow)), {0.2f, 0.5f, 1, 0.9f, 0.9f, 0.9f}, {});
    Light lamp;
    lamp.size = Vec2(0.8f, 0.4f), lamp.radius = 0.25f;
    const float x[] = {-1.5f, 0, 1.5f};
    const LightType types[] = {LightType::Rectangle, LightType::Disk, LightType::Sphere};
    for (int i = 0; i < 3; ++i) {
        lamp.type = types[i];
        lamp.radiance = Vec3(i == 0 ? 5 : 2, i == 1 ? 5 : 2, i == 2 ? 5 : 2);
        tiny.addLight(lamp, Mat4(1));
        // -Z turned down, and somewhat to the side on the way.
        movingNode(tiny, tiny.scene.lights.back().node, {x[i], 2, 0, x[i] + 0.5f, 1.7f, 0.4f},
                   {-kHalf, 0, 0, kHalf, -0.85f * kHalf, 0.3f * kHalf, 0, 1.1f * kHalf});
    }
    Light spot;
    spot.type = LightType::Spot;
    spot.intensity = Vec3(4), spot.outerConeDeg = 30, spot.innerConeDeg = 20;
    tiny.addLight(spot, Mat4(1));
    movingNode(tiny, tiny.scene.lights.back().node, {-1, 2.5f, 1.5f, 1, 2.5f, 1.5f},
               {-kHalf, 0, 0, kHalf, -kHalf, 0, 0, kHalf});
    return tiny;
}

Camera camera() { return lookFrom(Vec3(0.2f, 1.7f, 4.2f), Vec3(0, 0.6f, 0), 42); }

FrameSampling shutterFrame(int spp, const PathSettings& path, uint32_t seed) {
    FrameSampling sampling = frameOf(camera(), kExtent, spp, path, kMoments, seed);
    sampling.shutterOpen = true;
    return sampling;
}

TEST(Shutter, ConvergesToTheMeanOfPosedFrames) {
    const auto scene = everythingMoves().pose()->scene;
    Tracer tracer;
    Signals frame, blurred;
    for (const LightSampling choice : {LightSampling::Tree, LightSampling::Power}) {
        PathSettings path = plainPaths(2);
        path.lightSampling = choice;
        Mean mean;
        for (uint32_t i = 0; i < 600; ++i) {
            const float t = kExposure * number(static_cast<uint32_t>(choice), i);
            tracer.bind(poseScene(scene, {t, t, t}));
            ASSERT_TRUE(tracer.sample(frameOf(camera(), kExtent, 1, path, {Signal::Noisy}, 100 + i), frame));
            mean.add(frame);
        }
        tracer.bind(poseScene(scene, {0, kExposure, 0}));
        ASSERT_TRUE(tracer.sample(shutterFrame(600, path, 7), blurred));
        const Signals posed = mean.signals(kExtent);
        EXPECT_GE(agreeingShare(blurred, posed), 0.9975);
        EXPECT_LT(std::abs(biasInSigmas(blurred, posed)), 4);
        // It is not the still image that agrees.
        tracer.bind(poseScene(scene, {0, 0, 0}));
        ASSERT_TRUE(tracer.sample(shutterFrame(600, path, 8), frame));
        EXPECT_LT(agreeingShare(frame, posed), 0.9);
    }
}

/// A shining card whose scale goes straight from one to the other in the first second.
TinyScene scaledCard(const Vec3& from, const Vec3& to) {
    TinyScene tiny;
    Material glow = lambert(0);
    glow.emission = Vec3(1), glow.doubleSided = true;
    const int card = tiny.add(rectangleMesh(1, 1, Facing::Z), glow);
    const int node = tiny.scene.instances[static_cast<size_t>(card)].node;
    tiny.scene.nodes[static_cast<size_t>(node)].hasMatrix = false;
    Animation animation;
    animation.duration = 1, animation.loop = false;
    animation.channels.push_back(channel(node, AnimatedProperty::Scale, 3, {from.x, from.y, from.z, to.x, to.y, to.z}));
    tiny.scene.animations.push_back(animation);
    return tiny;
}

/// Mean of its picture while the shutter is open.
double meanOfScaledCard(const Vec3& from, const Vec3& to) {
    Tracer tracer;
    tracer.bind(scaledCard(from, to).pose({0, 1, 0}));
    FrameSampling sampling =
        frameOf(lookFrom(Vec3(0, 0, 2), Vec3(0), 60), {32, 32}, 256, plainPaths(1), {Signal::Noisy}, 3);
    sampling.shutterOpen = true;
    Signals frame;
    EXPECT_TRUE(tracer.sample(sampling, frame));
    double sum = 0;
    for (int y = 0; y < 32; ++y)
        for (int x = 0; x < 32; ++x) sum += frame[Signal::Noisy].at(0, x, y);
    return sum / (32 * 32);
}

TEST(Shutter, ThingsGrowFromNothingAndVanish) {
    const double whole = meanOfScaledCard(Vec3(1), Vec3(1));
    EXPECT_GT(whole, 0.1);
    EXPECT_NEAR(meanOfScaledCard(Vec3(0), Vec3(1)) / whole, 1.0 / 3, 0.005);
    EXPECT_NEAR(meanOfScaledCard(Vec3(1), Vec3(0)) / whole, 1.0 / 3, 0.005);
    EXPECT_NEAR(meanOfScaledCard(Vec3(1), Vec3(0, 1, 1)) / whole, 0.5, 0.005);
    EXPECT_NEAR(meanOfScaledCard(Vec3(1, 1, 0), Vec3(1)) / whole, 1, 0.005) << "flat as it is";
    EXPECT_EQ(meanOfScaledCard(Vec3(0), Vec3(0)), 0);
}

TEST(Shutter, LightsThatGrowAreChosenByTheMostThatTheyShine) {
    TinyScene tiny = scaledCard(Vec3(0), Vec3(1));
    Material glow = lambert(0);
    glow.emission = Vec3(1), glow.doubleSided = true;
    tiny.add(rectangleMesh(1, 1, Facing::Z), glow);
    TraceScene scene;
    bindTo(scene, tiny.pose({0, 1, 0}));
    ASSERT_EQ(scene.lights.count(), 4u);
    const LightReceiver receiver{Vec3(0, 0, 5), Vec3(0, 0, -1), 0.9f, LightReceiver::Facing::Front,
                                 LightSampling::Power};
    for (uint32_t i = 0; i < 4; ++i) EXPECT_NEAR(scene.lights.pickProbability(receiver, i), 0.25f, 1e-5f);
}

TEST(Shutter, WhatIsFlatAtTheOpeningStandsStillWhileTimeDoes) {
    TinyScene tiny = scaledCard(Vec3(0), Vec3(1));
    const auto posed = tiny.pose({0, 1, 0});
    for (const PosedInstance& instance : posed->instances)
        EXPECT_EQ(instance.worldFromObject, instance.worldFromObjectPrevious());
}

TEST(Shutter, StrategiesAgreeWhileLightsMove) {
    Tracer tracer;
    tracer.bind(poseScene(everythingMoves().pose()->scene, {0, kExposure, 0}));
    Signals mis, other;
    ASSERT_TRUE(tracer.sample(shutterFrame(256, plainPaths(2), 1), mis));
    for (const auto strategy : {DirectStrategy::Light, DirectStrategy::Bsdf}) {
        ASSERT_TRUE(tracer.sample(shutterFrame(1024, plainPaths(2, strategy), 2), other));
        EXPECT_GE(agreeingShare(mis, other), 0.9975) << static_cast<int>(strategy);
        EXPECT_LT(std::abs(biasInSigmas(mis, other)), 4) << static_cast<int>(strategy);
    }
}

TEST(Shutter, PointsKeepTheirTimeAFrameEarlier) {
    // The frame before lasted from 0.1 on, this one from 0.5 on, both open for 0.3.
    const auto scene = everythingMoves().pose()->scene;
    const float open = 0.5f, before = 0.1f, length = 0.3f;
    const auto first = poseScene(scene, {before, before + length, before});
    for (const PosedScene* earlier : {static_cast<const PosedScene*>(nullptr), first.get()}) {
        Tracer tracer, still;
        tracer.bind(poseScene(scene, {open, open + length, before}, earlier));
        std::vector<bool> seen(scene->instances.size(), false);
        for (uint32_t i = 0; i < 400; ++i) {
            const float time = number(1, i % 20);
            if (i % 20 == 0) continue;
            const Ray ray{camera().eye, 0,
                          glm::normalize(Vec3(4 * number(2, i) - 2, 2.4f * number(3, i), 0) - camera().eye), kInfinity,
                          time};
            Hit hit;
            tracer.closestHits({&ray, 1}, {&hit, 1});
            if (!hit.valid()) continue;
            const Vec3 position = tracer.position(hit.point);
            EXPECT_LT(glm::distance(position, ray.origin + ray.direction * hit.distance), 1e-4f);
            seen[hit.point.instance] = true;
            // The same point in still scenes of both moments.
            for (const bool previous : {false, true}) {
                const float moment = (previous ? before : open) + time * length;
                still.bind(poseScene(scene, {moment, moment, moment}));
                SurfacePoint point = hit.point;
                point.time = 0;
                const Vec3 expected = still.position(point);
                const Vec3 found = previous ? tracer.previousPosition(hit.point) : position;
                EXPECT_LT(glm::distance(found, expected), 2e-3f) << hit.point.instance << ' ' << previous;
                if (!previous) {
                    EXPECT_GT(glm::dot(tracer.normal(hit.point), still.normal(point)), 0.999f);
                }
            }
        }
        EXPECT_GE(std::count(seen.begin(), seen.end(), true), 6);
    }
}

TEST(Shutter, OpensAndClosesInOneTracer) {
    const auto scene = everythingMoves().pose()->scene;
    Tracer kept;
    Signals a, b;
    for (const float exposure : {0.0f, 0.4f, 0.8f, 0.0f, 0.1f}) {
        const auto posed = poseScene(scene, {0.1f, 0.1f + exposure, 0.1f});
        Tracer fresh;
        fresh.bind(posed);
        kept.bind(posed);
        FrameSampling sampling = shutterFrame(2, plainPaths(2), 1);
        sampling.shutterOpen = exposure > 0;
        ASSERT_TRUE(fresh.sample(sampling, a));
        ASSERT_TRUE(kept.sample(sampling, b));
        const Image &x = a[Signal::Noisy], &y = b[Signal::Noisy];
        EXPECT_EQ(std::memcmp(x.data(), y.data(), x.bytes()), 0) << exposure;
    }
}

TEST(Shutter, AMovingCameraBlursWhatStandsStill) {
    TinyScene tiny;
    tiny.add(floorMesh(6), lambert(0.7f));
    tiny.add(boxMesh(Vec3(1)), lambert(0.3f), translation(Vec3(0, 0.5f, 0)));
    tiny.scene.environment.constant = Vec3(1);
    Tracer tracer;
    tracer.bind(tiny.pose());
    const auto at = [](float t) { return lookFrom(Vec3(-0.6f + 1.2f * t, 1.7f, 4), Vec3(0.3f * t, 0.5f, 0), 42); };
    Mean mean;
    Signals frame, blurred;
    for (uint32_t i = 0; i < 400; ++i) {
        ASSERT_TRUE(tracer.sample(frameOf(at(number(5, i)), kExtent, 1, plainPaths(2), {Signal::Noisy}, i), frame));
        mean.add(frame);
    }
    FrameSampling sampling = shutterFrame(400, plainPaths(2), 7);
    for (int i = 0; i <= 16; ++i) sampling.cameraTrack.push_back(poseCamera(at(static_cast<float>(i) / 16), kExtent));
    ASSERT_TRUE(tracer.sample(sampling, blurred));
    EXPECT_GE(agreeingShare(blurred, mean.signals(kExtent)), 0.9975);
    EXPECT_LT(std::abs(biasInSigmas(blurred, mean.signals(kExtent))), 4);
}

TEST(Lens, ConvergesToTheMeanOfPinholes) {
    TinyScene tiny;
    tiny.add(floorMesh(30), lambert(0.7f));
    tiny.scene.environment.constant = Vec3(0.6f);
    Material glow = lambert(0);
    glow.emission = Vec3(6, 5, 4);
    for (int i = 0; i < 4; ++i)
        tiny.add(boxMesh(Vec3(0.5f)), i == 3 ? glow : lambert(0.2f + 0.2f * static_cast<float>(i)),
                 translation(Vec3(-1.2f + 0.8f * static_cast<float>(i), 0.5f, 1.5f - 1.6f * static_cast<float>(i))));
    Tracer tracer;
    tracer.bind(tiny.pose());
    for (const int blades : {0, 5}) {
        Camera lens = camera();
        lens.aperture = 0.2f, lens.focus = 4;
        lens.apertureShape = blades ? ApertureShape::Bladed : ApertureShape::Round;
        lens.apertureBlades = 5, lens.apertureRotationDeg = 25;
        Signals blurred;
        ASSERT_TRUE(tracer.sample(frameOf(lens, kExtent, 600, plainPaths(1), kMoments, 3), blurred));

        // A pinhole at a random place of the lens, and a film that is moved along so that the plane in focus stays.
        const CameraPose pose = poseCamera(lens, kExtent);
        uint32_t drawn = 0;
        const auto onLens = [&] {
            for (;;) {
                const Vec2 p(2 * number(11, drawn) - 1, 2 * number(12, drawn) - 1);
                ++drawn;
                bool inside = glm::dot(p, p) < 1;
                for (int side = 0; side < blades; ++side) {
                    const float middle =
                        radians(25) + 2 * kPi * (static_cast<float>(side) + 0.5f) / static_cast<float>(blades);
                    inside &= glm::dot(p, Vec2(std::cos(middle), std::sin(middle))) <
                              std::cos(kPi / static_cast<float>(blades));
                }
                if (inside) return p;
            }
        };
        Mean mean;
        Signals frame;
        frame.reset(kExtent, {Signal::Noisy}, 1);
        std::vector<PathStart> starts;
        std::vector<Vec3> radiance(static_cast<size_t>(kExtent.area()));
        for (uint32_t s = 0; s < 600; ++s) {
            starts.clear();
            const Vec2 hole = onLens() * lens.aperture;
            for (int y = 0; y < kExtent.height; ++y)
                for (int x = 0; x < kExtent.width; ++x) {
                    const auto slot = static_cast<uint32_t>(y * kExtent.width + x);
                    PathStart start =
                        cameraStart(poseCamera(camera(), kExtent),
                                    Vec2(x + number(13 + s, slot), y + number(10013 + s, slot)), Vec2(0.5f), 0);
                    const float depth = glm::dot(start.ray.direction, pose.forward());
                    const Vec3 inFocus = start.ray.origin + start.ray.direction * (4 / depth);
                    start.ray.origin += transformVector(pose.worldFromCamera, Vec3(hole, 0));
                    start.ray.direction = glm::normalize(inFocus - start.ray.origin);
                    start.key = {slot, 77, s};
                    start.slot = slot;
                    starts.push_back(start);
                }
            ASSERT_TRUE(tracer.tracePaths(starts, plainPaths(1), 5, radiance, {}));
            for (size_t i = 0; i < radiance.size(); ++i)
                for (int c = 0; c < 3; ++c)
                    frame[Signal::Noisy].at(c, static_cast<int>(i) % kExtent.width,
                                            static_cast<int>(i) / kExtent.width) = radiance[i][c];
            mean.add(frame);
        }
        const Signals pinholes = mean.signals(kExtent);
        EXPECT_GE(agreeingShare(blurred, pinholes), 0.9975) << blades;
        EXPECT_LT(std::abs(biasInSigmas(blurred, pinholes)), 4) << blades;
    }
}

TEST(Lens, StereoPairIsRectified) {
    Camera lens = camera();
    lens.interaxial = 0.07f;
    lens.eyeOfPair = StereoEye::Left;
    const CameraPose left = poseCamera(lens, {640, 480});
    lens.eyeOfPair = StereoEye::Right;
    const CameraPose right = poseCamera(lens, {640, 480});
    EXPECT_NEAR(glm::distance(left.position(), right.position()), 0.07f, 1e-6f);
    for (const Vec3& p : {Vec3(0), Vec3(1, 0.5f, 1), Vec3(-2, 3, -6)}) {
        const Vec3 a = left.project(p), b = right.project(p);
        EXPECT_NEAR(a.z, b.z, 1e-5f);
        EXPECT_NEAR(a.y, b.y, 1e-3f);
        EXPECT_NEAR(a.x - b.x, 0.07f / a.z / left.pixelSize(), 1e-3f);
    }
}

}  // namespace
}  // namespace lumi
