#include "scene/animation.h"

#include <gtest/gtest.h>

#include <cmath>

#include "gltf_support.h"
#include "math/vector.h"
#include "scene/node_pose.h"

namespace lumi {
namespace {

AnimationChannel scalar(Interpolation interpolation, std::vector<float> times, std::vector<float> values) {
    AnimationChannel channel;
    channel.components = 1;
    channel.interpolation = interpolation;
    channel.times = std::move(times);
    channel.values = std::move(values);
    return channel;
}

float at(const AnimationChannel& channel, float time) {
    float value = -999;
    channel.evaluate(time, &value);
    return value;
}

AnimationChannel rotation(Interpolation interpolation, std::vector<float> times, const std::vector<Quat>& keys) {
    AnimationChannel channel;
    channel.property = AnimatedProperty::Rotation;
    channel.components = 4;
    channel.interpolation = interpolation;
    channel.times = std::move(times);
    for (const Quat& q : keys) channel.values.insert(channel.values.end(), {q.x, q.y, q.z, q.w});
    return channel;
}

Quat rotationAt(const AnimationChannel& channel, float time) {
    float v[4];
    channel.evaluate(time, v);
    return Quat(v[3], v[0], v[1], v[2]);
}

Quat aroundZ(float angleDeg) { return glm::angleAxis(radians(angleDeg), Vec3(0, 0, 1)); }

float angleBetweenDeg(const Quat& a, const Quat& b) {
    return degrees(2 * std::acos(std::min(1.0f, std::abs(glm::dot(a, b)))));
}

TEST(Animation, HoldsTheEndsOutsideItsKeys) {
    const AnimationChannel channel = scalar(Interpolation::Linear, {1, 2, 4}, {10, 20, 0});
    EXPECT_EQ(at(channel, -5), 10);
    EXPECT_EQ(at(channel, 1), 10);
    EXPECT_EQ(at(channel, 4), 0);
    EXPECT_EQ(at(channel, 100), 0);
}

TEST(Animation, LinearIsLinear) {
    const AnimationChannel channel = scalar(Interpolation::Linear, {1, 2, 4}, {10, 20, 0});
    EXPECT_FLOAT_EQ(at(channel, 1.25f), 12.5f);
    EXPECT_FLOAT_EQ(at(channel, 3), 10);
}

TEST(Animation, StepKeepsTheLastKey) {
    const AnimationChannel channel = scalar(Interpolation::Step, {0, 1, 2}, {1, 2, 3});
    EXPECT_EQ(at(channel, 0.999f), 1);
    EXPECT_EQ(at(channel, 1), 2);
    EXPECT_EQ(at(channel, 1.999f), 2);
    EXPECT_EQ(at(channel, 2), 3);
}

TEST(Animation, CubicSplineReproducesACubic) {
    // f(t) = t^3 - 2 t, with its derivative as both tangents, at uneven keys.
    const auto f = [](float t) { return t * t * t - 2 * t; };
    const auto slope = [](float t) { return 3 * t * t - 2; };
    const std::vector<float> times{0, 0.5f, 2};
    std::vector<float> values;
    for (const float t : times) values.insert(values.end(), {slope(t), f(t), slope(t)});
    const AnimationChannel channel = scalar(Interpolation::CubicSpline, times, values);
    for (float t = 0; t <= 2; t += 0.0625f) EXPECT_NEAR(at(channel, t), f(t), 1e-5f) << t;
}

TEST(Animation, CatmullRomReproducesAParabolaInsideAndALineAtTheEnds) {
    const auto f = [](float t) { return t * t; };
    const AnimationChannel parabola = scalar(Interpolation::CatmullRom, {0, 1, 2, 3}, {f(0), f(1), f(2), f(3)});
    for (float t = 1; t <= 2; t += 0.125f) EXPECT_NEAR(at(parabola, t), f(t), 1e-5f) << t;
    const AnimationChannel line = scalar(Interpolation::CatmullRom, {0, 1, 1.5f, 4}, {1, 3, 4, 9});
    for (float t = 0; t <= 4; t += 0.125f) EXPECT_NEAR(at(line, t), 1 + 2 * t, 1e-5f) << t;
}

TEST(Animation, LinearRotationIsSlerpOnTheShorterArc) {
    const AnimationChannel channel = rotation(Interpolation::Linear, {0, 1}, {aroundZ(0), aroundZ(90)});
    EXPECT_LT(angleBetweenDeg(rotationAt(channel, 0.25f), aroundZ(22.5f)), 0.05f);
    const AnimationChannel negated = rotation(Interpolation::Linear, {0, 1}, {aroundZ(0), -aroundZ(90)});
    EXPECT_LT(angleBetweenDeg(rotationAt(negated, 0.5f), aroundZ(45)), 0.05f);
}

TEST(Animation, RotationsComeOutUnit) {
    for (const Interpolation interpolation : {Interpolation::Linear, Interpolation::CatmullRom, Interpolation::Step}) {
        const AnimationChannel channel =
            rotation(interpolation, {0, 1, 2}, {aroundZ(0) * 3.0f, aroundZ(100) * 0.2f, -aroundZ(170)});
        for (float t = 0; t <= 2; t += 0.25f) {
            const Quat q = rotationAt(channel, t);
            EXPECT_NEAR(glm::dot(q, q), 1, 1e-5f) << t;
        }
    }
    const AnimationChannel zero = rotation(Interpolation::Linear, {0, 1}, {Quat(0, 0, 0, 0), Quat(0, 0, 0, 0)});
    EXPECT_EQ(rotationAt(zero, 0.5f), Quat(1, 0, 0, 0));
}

TEST(Animation, CatmullRomRotationPassesThroughItsKeys) {
    const AnimationChannel channel =
        rotation(Interpolation::CatmullRom, {0, 1, 3}, {aroundZ(0), -aroundZ(60), aroundZ(120)});
    EXPECT_LT(angleBetweenDeg(rotationAt(channel, 1), aroundZ(60)), 0.05f);
    const Quat between = rotationAt(channel, 0.5f);
    EXPECT_GT(angleBetweenDeg(between, aroundZ(0)), 20);
    EXPECT_GT(angleBetweenDeg(between, aroundZ(60)), 20);
}

TEST(Animation, OneKeyIsConstant) {
    for (const Interpolation interpolation : {Interpolation::Step, Interpolation::Linear, Interpolation::CatmullRom}) {
        const AnimationChannel channel = scalar(interpolation, {2}, {7});
        for (const float t : {-1.0f, 2.0f, 5.0f}) EXPECT_EQ(at(channel, t), 7);
    }
    EXPECT_EQ(at(scalar(Interpolation::CubicSpline, {2}, {1, 7, 1}), 3), 7);
}

TEST(Animation, CoincidentKeysJump) {
    const AnimationChannel channel = scalar(Interpolation::Linear, {0, 1, 1, 2}, {0, 1, 5, 6});
    EXPECT_NEAR(at(channel, 0.9999f), 1, 1e-3f);
    EXPECT_EQ(at(channel, 1), 5);
    EXPECT_NEAR(at(channel, 1.5f), 5.5f, 1e-6f);
}

TEST(Animation, LoopsWrapAtTheirDuration) {
    Animation animation;
    animation.duration = 2;
    EXPECT_FLOAT_EQ(localTime(animation, 2), 2);
    EXPECT_FLOAT_EQ(localTime(animation, 2.5f), 0.5f);
    EXPECT_FLOAT_EQ(localTime(animation, 7), 1);
    EXPECT_FLOAT_EQ(localTime(animation, -0.5f), 1.5f);
    animation.loop = false;
    EXPECT_FLOAT_EQ(localTime(animation, 7), 7);
}

TEST(Animation, OneOfAGltfPlaysAlone) {
    test::GltfBuilder file;
    file.triangle();
    const int times = file.floats({0, 1}, "SCALAR", 1);
    for (const float end : {1.0f, 2.0f, 3.0f})
        file.json["animations"].push_back(
            {{"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}}}},
             {"samplers", {{{"input", times}, {"output", file.floats({0, 0, 0, end, 0, 0}, "VEC3", 3)}}}}});
    file.json["animations"][1]["name"] = "run";
    const auto endOf = [&](const std::string& animation) {
        MessageLog log;
        LoadOptions options;
        options.choice.animation = animation;
        const Scene scene = file.load(log, options);
        EXPECT_EQ(scene.animations.size(), 1u);
        EXPECT_EQ(log.messages().size(), animation.empty() ? 1u : 0u) << "of the others one line tells";
        return poseNodes(scene, 1.0f).worldFromNode[0][3].x;
    };
    EXPECT_EQ(endOf(""), 1);
    EXPECT_EQ(endOf("run"), 2);
    EXPECT_EQ(endOf("1"), 2);
    EXPECT_EQ(endOf("2"), 3);
    test::expectError(ErrorKind::Usage, [&] { endOf("walk"); }, {"no such animation", "0, run, 2", "walk"});
}

}  // namespace
}  // namespace lumi
