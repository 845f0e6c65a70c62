// Motion vectors against the true previous position of each sample's point, computed in double precision.
#include <gtest/gtest.h>

#include <bit>

#include "support/transport_scene.h"

namespace lumi {
namespace {

using namespace test;
using DVec3 = glm::dvec3;
using DVec4 = glm::dvec4;
using DMat4 = glm::dmat4;

constexpr Extent2 kExtent{48, 36};
constexpr double kMostPixels = 0.01;

DVec3 projectExactly(const Camera& camera, const DVec3& p) {
    const DVec3 back = glm::normalize(DVec3(camera.eye) - DVec3(camera.target));
    const DVec3 right = glm::normalize(glm::cross(DVec3(camera.up), back)), up = glm::cross(back, right);
    const DVec3 d = p - DVec3(camera.eye);
    const double depth = -glm::dot(d, back);
    const double scale = kExtent.height / 2.0 / std::tan(double(camera.fovYDeg) * 3.14159265358979323846 / 360);
    return {kExtent.width / 2.0 + glm::dot(d, right) / depth * scale,
            kExtent.height / 2.0 - glm::dot(d, up) / depth * scale, depth};
}

/// Renders one frame and compares each surface pixel's motion with `previous` of its point.
template <class Previous>
void expectMotion(const std::shared_ptr<const PosedScene>& posed, const Camera& camera, const Camera& before,
                  Previous&& previous, int leastPixels) {
    Tracer tracer;
    tracer.bind(posed);
    FrameSampling sampling = frameOf(camera, kExtent, 1, plainPaths(1),
                                     {Signal::Motion, Signal::Position, Signal::Surface, Signal::ObjectId});
    sampling.previousCamera = poseCamera(before, kExtent);
    Signals s;
    ASSERT_TRUE(tracer.sample(sampling, s));
    int compared = 0;
    double largest = 0;
    for (int y = 0; y < kExtent.height; ++y)
        for (int x = 0; x < kExtent.width; ++x) {
            if (s.ids(Signal::ObjectId).at(0, x, y) == 0) continue;
            const DVec3 now(s[Signal::Position].at(0, x, y), s[Signal::Position].at(1, x, y),
                            s[Signal::Position].at(2, x, y));
            const IdImage& id = s.ids(Signal::Surface);
            const SurfacePoint point{id.at(0, x, y),
                                     id.at(1, x, y),
                                     {std::bit_cast<float>(id.at(2, x, y)), std::bit_cast<float>(id.at(3, x, y))},
                                     0};
            const DVec3 truth = projectExactly(before, previous(point, now)) - projectExactly(camera, now);
            const Image& motion = s[Signal::Motion];
            EXPECT_NEAR(motion.at(0, x, y), truth.x, kMostPixels) << x << ' ' << y;
            EXPECT_NEAR(motion.at(1, x, y), truth.y, kMostPixels) << x << ' ' << y;
            EXPECT_NEAR(motion.at(2, x, y), truth.z, 1e-3);
            largest = std::max(largest, std::hypot(truth.x, truth.y));
            ++compared;
        }
    EXPECT_GE(compared, leastPixels);
    EXPECT_GT(largest, 0.5);  // something did move
}

const Camera kNow = lookFrom(Vec3(0.5f, 1.2f, 4), Vec3(0, 0.5f, 0), 45);

TEST(Motion, OfTheCamera) {
    TinyScene tiny;
    tiny.add(floorMesh(8), lambert(0.5f));
    tiny.add(sphereMesh(0.6f, 32, 16), lambert(0.5f), translation(Vec3(0, 0.6f, 0)));
    const Camera before = lookFrom(Vec3(0.3f, 1.3f, 4.2f), Vec3(0.1f, 0.45f, 0.1f), 45);
    expectMotion(
        tiny.pose(), kNow, before, [](const SurfacePoint&, const DVec3& p) { return p; }, 900);
}

TEST(Motion, OfTheSkyIsRotationAlone) {
    TinyScene tiny;
    tiny.scene.environment.constant = Vec3(1);
    Tracer tracer;
    tracer.bind(tiny.pose());
    const Camera moved = lookFrom(kNow.eye + Vec3(3, 1, 0), kNow.target + Vec3(3, 1, 0), 45);
    FrameSampling sampling = frameOf(kNow, kExtent, 1, plainPaths(1), {Signal::Motion});
    sampling.previousCamera = poseCamera(moved, kExtent);
    Signals s;
    ASSERT_TRUE(tracer.sample(sampling, s));
    for (size_t i = 0; i < s[Signal::Motion].size(); ++i) EXPECT_NEAR(s[Signal::Motion].data()[i], 0, 1e-3);

    const Camera turned = lookFrom(kNow.eye, kNow.target + Vec3(0.2f, 0, 0), 45);
    sampling.previousCamera = poseCamera(turned, kExtent);
    sampling.jitter = Jitter::None;
    ASSERT_TRUE(tracer.sample(sampling, s));
    const Vec3 ray = cameraStart(sampling.camera, Vec2(10.5f, 20.5f), Vec2(0.5f), 0).ray.direction;
    const DVec3 truth = projectExactly(turned, DVec3(kNow.eye) + DVec3(ray)) - DVec3(10.5, 20.5, 0);
    EXPECT_NEAR(s[Signal::Motion].at(0, 10, 20), truth.x, kMostPixels);
    EXPECT_NEAR(s[Signal::Motion].at(1, 10, 20), truth.y, kMostPixels);
}

AnimationChannel channel(int node, AnimatedProperty property, int components, std::vector<float> values) {
    AnimationChannel c;
    c.node = node, c.property = property, c.components = components;
    c.times = {0, 1};
    c.values = std::move(values);
    return c;
}

void animate(Scene& scene, std::vector<AnimationChannel> channels) {
    Animation animation;
    animation.channels = std::move(channels);
    animation.duration = 1;
    animation.loop = false;
    scene.animations.push_back(animation);
}

DMat4 rotationAboutY(double angle) {
    DMat4 m(1);
    m[0][0] = std::cos(angle), m[0][2] = -std::sin(angle);
    m[2][0] = std::sin(angle), m[2][2] = std::cos(angle);
    return m;
}

TEST(Motion, OfRigidThings) {
    // A box that turns a right angle a second about Y and moves along X, with uneven scale.
    TinyScene tiny;
    const int box = tiny.add(boxMesh(Vec3(1)), lambert(0.5f));
    const int node = tiny.scene.instances[static_cast<size_t>(box)].node;
    Node& n = tiny.scene.nodes[static_cast<size_t>(node)];
    n.hasMatrix = false;
    n.local.scale = Vec3(1, 0.7f, 1.4f);
    const float h = std::sqrt(0.5f);
    animate(tiny.scene, {channel(node, AnimatedProperty::Translation, 3, {0, 0.5f, 0, 2, 0.5f, 0}),
                         channel(node, AnimatedProperty::Rotation, 4, {0, 0, 0, 1, 0, h, 0, h})});
    const float t0 = 0.2f, t1 = 0.25f;
    const auto at = [&](double t) {
        DMat4 m = rotationAboutY(t * 3.14159265358979323846 / 2);
        m[3] = DVec4(2 * t, 0.5, 0, 1);
        return m;
    };
    const DMat4 back = at(t0) * glm::inverse(at(t1));
    expectMotion(
        tiny.pose({t1, t1, t0}), kNow, kNow,
        [&](const SurfacePoint&, const DVec3& p) { return DVec3(back * DVec4(p, 1)); }, 150);
}

TEST(Motion, OfMorphingThings) {
    // A wall whose morph target shears it: displacement (0.8 y, 0, 0.3 x), weight growing with time.
    TinyScene tiny;
    Mesh wall = rectangleMesh(2, 2, Facing::Z, 6, 6);
    MorphTarget target;
    for (const Vec3& p : wall.positions) target.positions.push_back(Vec3(0.8f * p.y, 0, 0.3f * p.x));
    wall.morphTargets.push_back(target);
    const int instance = tiny.add(std::move(wall), lambert(0.5f), translation(Vec3(0, 0.5f, 0)));
    const int node = tiny.scene.instances[static_cast<size_t>(instance)].node;
    tiny.scene.nodes[static_cast<size_t>(node)].morphWeights = {0};
    animate(tiny.scene, {channel(node, AnimatedProperty::MorphWeights, 1, {0, 1})});
    const double t0 = 0.4, t1 = 0.6;
    expectMotion(
        tiny.pose({float(t1), float(t1), float(t0)}), kNow, kNow,
        [&](const SurfacePoint&, const DVec3& p) {
            // Undo the shear of now: x + 0.8 w y, y, z + 0.3 w x.
            const double y = p.y - 0.5, x = p.x - 0.8 * t1 * y;
            return DVec3(x + 0.8 * t0 * y, p.y, 0.3 * t0 * x);
        },
        300);
}

TEST(Motion, OfSkinnedThings) {
    // A strip that hangs on one joint which turns about Y: rigid, but by way of the skin.
    TinyScene tiny;
    Mesh strip = rectangleMesh(1.5f, 1.5f, Facing::Z, 4, 4);
    for (uint32_t v = 0; v <= strip.positions.size(); ++v) strip.skin.first.push_back(v);
    strip.skin.joint.assign(strip.positions.size(), 0);
    strip.skin.weight.assign(strip.positions.size(), 1);
    const int instance = tiny.add(std::move(strip), lambert(0.5f));
    const int joint = tiny.addNode(Mat4(1));
    tiny.scene.nodes[static_cast<size_t>(joint)].hasMatrix = false;
    tiny.scene.nodes[static_cast<size_t>(joint)].local.translation = Vec3(0, 0.5f, 0);
    tiny.scene.instances[static_cast<size_t>(instance)].skin = 0;
    tiny.scene.skins.push_back({{joint}, {Mat4(1)}});
    const float h = std::sqrt(0.5f);
    animate(tiny.scene, {channel(joint, AnimatedProperty::Rotation, 4, {0, 0, 0, 1, 0, h, 0, h})});
    const double t0 = 0.2, t1 = 0.3;
    expectMotion(
        tiny.pose({float(t1), float(t1), float(t0)}), kNow, kNow,
        [&](const SurfacePoint&, const DVec3& p) {
            const DMat4 back = rotationAboutY((t0 - t1) * 3.14159265358979323846 / 2);
            return DVec3(back * DVec4(p, 1));
        },
        200);
}

TEST(Motion, FollowsAcrossBindsOfTheSameTracer) {
    // The Embree scene is updated, not rebuilt: positions must be those of each time.
    TinyScene tiny;
    const int box = tiny.add(boxMesh(Vec3(1)), lambert(0.5f));
    const int node = tiny.scene.instances[static_cast<size_t>(box)].node;
    tiny.scene.nodes[static_cast<size_t>(node)].hasMatrix = false;
    animate(tiny.scene, {channel(node, AnimatedProperty::Translation, 3, {0, 0, 0, 4, 0, 0})});
    const auto scene = tiny.pose()->scene;
    Tracer tracer;
    for (const float t : {0.0f, 0.5f, 0.25f, 1.0f}) {
        tracer.bind(poseScene(scene, {t, t, t}));
        const Ray ray{Vec3(4 * t, 0, 5), 0, Vec3(0, 0, -1), kInfinity, 0};
        const Ray beside{Vec3(4 * t + 1, 0, 5), 0, Vec3(0, 0, -1), kInfinity, 0};
        Hit hits[2];
        const Ray rays[] = {ray, beside};
        tracer.closestHits(rays, hits);
        EXPECT_NEAR(hits[0].distance, 4.5f, 1e-5) << t;
        EXPECT_FALSE(hits[1].valid()) << t;
    }
}

}  // namespace
}  // namespace lumi
