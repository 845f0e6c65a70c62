// Back faces of single-sided materials: gone for the camera, solid for every other ray. Blended ones: the same rays
// stop.
#include <gtest/gtest.h>

#include <algorithm>

#include "support/transport_scene.h"

namespace lumi {
namespace {

using namespace test;

Material singleSided(const Vec3& colour = Vec3(0.5f)) {
    Material m = lambert(colour);
    m.doubleSided = false;
    return m;
}

/// Straight down and straight up at the floor, at `x`.
Ray fromAbove(float x, bool camera) { return {Vec3(x, 1, 0), 0, Vec3(0, -1, 0), kInfinity, 0, camera}; }
Ray fromBelow(float x, bool camera) { return {Vec3(x, -1, 0), 0, Vec3(0, 1, 0), kInfinity, 0, camera}; }

bool hits(Tracer& tracer, const Ray& ray) {
    Hit hit;
    tracer.closestHits({&ray, 1}, {&hit, 1});
    uint8_t blocked = 2;
    tracer.occluded({&ray, 1}, {&blocked, 1});
    EXPECT_EQ(blocked, hit.valid() ? 1 : 0);
    return hit.valid();
}

/// A floor of 1 m at each x, facing +Y: placed once, mirrored in place (that keeps it facing +Y in glTF's reading), and
/// two instances of one mesh, one of them mirrored.
TinyScene floors(const Material& material) {
    TinyScene tiny;
    const int m = tiny.addMaterial(material);
    const auto mesh = [] { return std::make_shared<const Mesh>(floorMesh(1)); };
    tiny.add(mesh(), m);
    tiny.add(mesh(), m, translation(Vec3(2, 0, 0)) * scaling(Vec3(-1, 1, 1)));
    const auto shared = mesh();
    tiny.add(shared, m, translation(Vec3(4, 0, 0)));
    tiny.add(shared, m, translation(Vec3(6, 0, 0)) * scaling(Vec3(1, 1, -1)));
    return tiny;
}

TEST(BackFaces, OnlyTheCameraPassesThem) {
    Tracer tracer;
    tracer.bind(floors(singleSided()).pose());
    for (const float x : {0.1f, 2.1f, 4.1f, 6.1f}) {
        SCOPED_TRACE(x);
        EXPECT_TRUE(hits(tracer, fromAbove(x, true)));
        EXPECT_TRUE(hits(tracer, fromAbove(x, false)));
        EXPECT_FALSE(hits(tracer, fromBelow(x, true)));
        EXPECT_TRUE(hits(tracer, fromBelow(x, false)));
    }
}

TEST(BackFaces, ScalingByMinusOneTurnsAFloorOverAndItsFrontWithIt) {
    Tracer tracer;
    TinyScene tiny;
    tiny.add(floorMesh(1), singleSided(), scaling(Vec3(1, -1, 1)));
    tracer.bind(tiny.pose());
    EXPECT_FALSE(hits(tracer, fromAbove(0.1f, true)));
    EXPECT_TRUE(hits(tracer, fromBelow(0.1f, true)));
}

TEST(BackFaces, TwoSidedAndTransmittingMaterialsHaveBoth) {
    Material glass = singleSided();
    glass.transmission = 1;
    for (const Material& material : {lambert(0.5f), glass}) {
        Tracer tracer;
        tracer.bind(floors(material).pose());
        for (const float x : {0.1f, 2.1f, 4.1f, 6.1f}) EXPECT_TRUE(hits(tracer, fromBelow(x, true))) << x;
    }
}

TEST(BackFaces, FollowTheMaterialWhenItIsEdited) {
    Tracer tracer;
    TinyScene tiny = floors(singleSided());
    tracer.bind(tiny.pose());
    EXPECT_FALSE(hits(tracer, fromBelow(0.1f, true)));
    tiny.scene.materials[0].doubleSided = true;
    tracer.bind(tiny.pose());
    EXPECT_TRUE(hits(tracer, fromBelow(0.1f, true)));
    tiny.scene.materials[0].doubleSided = false;
    tracer.bind(tiny.pose());
    EXPECT_FALSE(hits(tracer, fromBelow(0.1f, true)));
}

TEST(BackFaces, AMaterialThatIsNotThereIsTheFirst) {
    Tracer tracer;
    TinyScene tiny = floors(singleSided());
    tiny.scene.instances[0].material = 7;
    tracer.bind(tiny.pose());
    EXPECT_TRUE(hits(tracer, fromAbove(0.1f, true)));
    EXPECT_FALSE(hits(tracer, fromBelow(0.1f, true)));
}

TEST(BackFaces, OfTwoCardsBackToBackEachSideShowsItsOwn) {
    TinyScene tiny;
    tiny.add(floorMesh(1), singleSided());
    tiny.add(floorMesh(1), singleSided(), scaling(Vec3(1, -1, 1)));
    Tracer tracer;
    tracer.bind(tiny.pose());
    std::vector<Ray> rays;
    for (int i = 0; i < 200; ++i) {
        const float x = 0.9f * (static_cast<float>(i) / 200 - 0.5f);
        rays.push_back(fromAbove(x, true)), rays.push_back(fromBelow(x, true));
    }
    std::vector<Hit> found(rays.size());
    tracer.closestHits(rays, found);
    for (size_t i = 0; i < rays.size(); ++i) {
        ASSERT_TRUE(found[i].valid()) << i;
        EXPECT_EQ(found[i].point.instance, i % 2) << i;
    }
}

// Whole frames go in packets.
TEST(BackFaces, AFrameLooksThroughACeilingFromAbove) {
    const auto depth = [](bool doubleSided) {
        TinyScene tiny;
        Material wall = lambert(0.5f);
        wall.doubleSided = doubleSided;
        tiny.add(floorMesh(4), wall, translation(Vec3(0, 0, 0)));
        Mat4 down = translation(Vec3(0, 2, 0)) * scaling(Vec3(1, -1, 1));
        tiny.add(floorMesh(4), wall, down);
        Tracer tracer;
        tracer.bind(tiny.pose());
        Signals signals;
        EXPECT_TRUE(tracer.sample(
            frameOf(lookFrom(Vec3(0.1f, 6, 0.1f), Vec3(0), 20), {16, 16}, 1, plainPaths(1), {Signal::Depth}), signals));
        return signals[Signal::Depth].at(0, 8, 8);
    };
    EXPECT_NEAR(depth(true), 4, 0.02);
    EXPECT_NEAR(depth(false), 6, 0.02);
}

// Whatever a ray meets: floor, box, lamp, nothing; behind a sheet that half of the rays pass, the same half both times.
TEST(Tracer, PathsGoOnFromTheirHits) {
    TinyScene tiny;
    tiny.add(floorMesh(), lambert(0.5f));
    tiny.add(boxMesh(Vec3(1)), lambert(0.5f), translation(Vec3(2, 0.5f, 0)));
    Light lamp;
    lamp.type = LightType::Sphere, lamp.radius = 0.3f, lamp.radiance = Vec3(4);
    tiny.addLight(lamp, translation(Vec3(0, 2, 0)));
    Material gauze = lambert(0.8f);
    gauze.alphaMode = AlphaMode::Blend, gauze.alpha = 0.5f;
    tiny.add(floorMesh(6), gauze, translation(Vec3(0, 0.6f, 0)));
    Tracer tracer;
    tracer.bind(tiny.pose());
    const size_t count = 1000;
    std::vector<PathStart> starts(count);
    std::vector<Ray> rays(count);
    std::vector<uint32_t> ids(count);
    for (uint32_t i = 0; i < count; ++i) {
        const Vec3 target(0.01f * static_cast<float>(i % 250), 0.5f * static_cast<float>(i / 125), 0.1f);
        starts[i].ray = rays[i] = {Vec3(0.5f, 1, 3), 0, glm::normalize(target - Vec3(0.5f, 1, 3)), kInfinity, 0};
        starts[i].cone = {0, 1e-3f};
        starts[i].key = {i, 4, 2}, starts[i].slot = i;
        ids[i] = firstRayId(starts[i].key, 9);
    }
    std::vector<Hit> hits(count);
    std::vector<Vec3> whole(count), continued(count);
    tracer.closestHits(rays, hits, {}, true, ids);
    EXPECT_EQ(tracer.counts().cameraRays, count);
    const auto stopped =
        std::count_if(hits.begin(), hits.end(), [](const Hit& hit) { return hit.point.instance == 2; });
    EXPECT_GT(stopped, 50);
    // A ray alone stops where it stopped among the others.
    for (size_t i = 0; i < count; i += 7) {
        Hit alone;
        tracer.closestHits({&rays[i], 1}, {&alone, 1}, {}, false, {&ids[i], 1});
        EXPECT_EQ(alone.point.instance, hits[i].point.instance) << i;
    }
    ASSERT_TRUE(tracer.continuePaths(starts, hits, plainPaths(3), 9, continued, {}));
    EXPECT_EQ(tracer.counts().cameraRays, count);
    ASSERT_TRUE(tracer.tracePaths(starts, plainPaths(3), 9, whole, {}));
    EXPECT_EQ(continued, whole);
}

}  // namespace
}  // namespace lumi
