// What solids absorb, against closed forms.
#include <gtest/gtest.h>

#include <cmath>

#include "support/transport_scene.h"
#include "trace/medium_stack.h"

namespace lumi {
namespace {

using namespace test;

constexpr double kMostSigmas = 4.5;

TEST(Absorption, SlabFollowsBeerLambert) {
    // Straight through a slab with reflections back and forth: R + (1-R)^2 A / (1 - R A), sky 1 on all sides.
    TinyScene tiny;
    Material slab = glass(0);
    slab.attenuationColor = Vec3(0.25f);
    slab.attenuationDistance = 0.5f;
    tiny.add(boxMesh(Vec3(4, 1, 4)), slab);
    tiny.scene.environment.constant = Vec3(1);
    Tracer tracer;
    tracer.bind(tiny.pose());
    const double r = 0.04, a = std::pow(0.25, 2.0);
    const double expected = r + (1 - r) * (1 - r) * a / (1 - r * a);
    const Estimate e = radianceAlong(tracer, Vec3(0.2f, 3, 0.1f), Vec3(0, -1, 0), 60000, plainPaths(32));
    EXPECT_NEAR(e.mean, expected, kMostSigmas * e.standardError + 1e-3 * expected);
}

// A clear cube in the middle of an absorbing one, which goes on behind it.
TEST(Absorption, GoesOnBehindASolidInside) {
    TinyScene tiny;
    Material drink = glass(0);
    drink.ior = 1.0001f;
    drink.attenuationColor = Vec3(0.25f);
    drink.attenuationDistance = 0.5f;
    Material ice = glass(0);
    ice.ior = 1.0001f;
    tiny.add(boxMesh(Vec3(4, 1, 4)), drink);
    tiny.add(boxMesh(Vec3(1, 0.5f, 1)), ice);
    tiny.scene.environment.constant = Vec3(1);
    Tracer tracer;
    tracer.bind(tiny.pose());
    const double expected = 0.25;  // half a metre of it
    const Estimate e = radianceAlong(tracer, Vec3(0.2f, 3, 0.1f), Vec3(0, -1, 0), 20000, plainPaths(8));
    EXPECT_NEAR(e.mean, expected, kMostSigmas * e.standardError + 2e-3 * expected);
}

Estimate seenFromInside(TinyScene& tiny, const Vec3& eye, const Vec3& direction) {
    tiny.scene.environment.constant = Vec3(1);
    Tracer tracer;
    tracer.bind(tiny.pose());
    return radianceAlong(tracer, eye, direction, 20000, plainPaths(8), 1, /*fromCamera=*/true);
}

Material tinted() {
    Material drink = glass(0);
    drink.ior = 1.0001f;
    drink.attenuationColor = Vec3(0.25f);
    drink.attenuationDistance = 0.5f;
    return drink;
}

void expectSeen(const Estimate& e, double expected) {
    EXPECT_NEAR(e.mean, expected, kMostSigmas * e.standardError + 2e-3 * expected);
}

TEST(Absorption, BeginsWhereTheCameraIs) {
    Material ice = glass(0);
    ice.ior = 1.0001f;
    const Vec3 eye(0.1f, -0.25f, 0.2f), up(0, 1, 0);
    TinyScene inside;
    inside.add(boxMesh(Vec3(4, 1, 4)), tinted());
    expectSeen(seenFromInside(inside, eye, up), std::pow(0.25, 1.5));        // 75 cm of it
    expectSeen(seenFromInside(inside, Vec3(0, 0.6f, 0), up), 1);             // above it
    expectSeen(seenFromInside(inside, Vec3(0, -0.6f, 0), up), 0.25 * 0.25);  // below it
    TinyScene inIce;
    inIce.add(boxMesh(Vec3(4, 1, 4)), tinted());
    inIce.add(boxMesh(Vec3(1)), ice, translation(Vec3(0)) * scaling(Vec3(0.75f)));
    expectSeen(seenFromInside(inIce, eye, up), std::pow(0.25, 0.25));  // the last 12.5 cm
    // Water that is a surface over an open basin; without the basin nothing is under it.
    TinyScene pool;
    pool.add(floorMesh(4), tinted(), translation(Vec3(0, 1, 0)));
    expectSeen(seenFromInside(pool, Vec3(0.1f, 0, 0.1f), up), 1);
    pool.add(floorMesh(4), lambert(0), translation(Vec3(0, -1, 0)));
    pool.add(rectangleMesh(4, 2, Facing::X), lambert(0), translation(Vec3(2, 0, 0)));
    pool.add(rectangleMesh(4, 2, Facing::X), lambert(0), translation(Vec3(-2, 0, 0)));
    pool.add(rectangleMesh(4, 2, Facing::Z), lambert(0), translation(Vec3(0, 0, 2)));
    pool.add(rectangleMesh(4, 2, Facing::Z), lambert(0), translation(Vec3(0, 0, -2)));
    expectSeen(seenFromInside(pool, Vec3(0.1f, 0, 0.1f), up), 0.25 * 0.25);
}

// What the plane of an orthographic camera cuts is entered where it begins in front of it.
TEST(Absorption, BeginsWhereAllOfAnOrthographicCameraIs) {
    Camera camera = lookFrom(Vec3(0), Vec3(0, 0, -1), 45);
    camera.projection = Projection::Orthographic;
    camera.yMag = 1;
    const auto corner = [&](float boxSize) {
        TinyScene tiny;
        tiny.add(boxMesh(Vec3(boxSize, boxSize, 1)), tinted());
        tiny.scene.environment.constant = Vec3(1);
        Tracer tracer;
        tracer.bind(tiny.pose());
        Signals frame;
        EXPECT_TRUE(tracer.sample(frameOf(camera, {16, 16}, 64, plainPaths(8), {Signal::Noisy}, 1), frame));
        return frame[Signal::Noisy].at(0, 0, 0);
    };
    EXPECT_NEAR(corner(1), 1, 1e-3) << "beside the box";
    EXPECT_NEAR(corner(4), 0.25, 2e-3) << "half a metre inside it";
}

TEST(Absorption, SolidsAreLeftInAnyOrder) {
    MediumStack media;
    EXPECT_EQ(media.innermost(), MediumStack::kNone);
    media.leave(7);
    EXPECT_EQ(media.innermost(), MediumStack::kNone) << "a solid that the path never entered";
    for (const uint32_t material : {1u, 2u, 3u}) media.enter(material);
    media.leave(2);
    EXPECT_EQ(media.innermost(), 3u);
    media.leave(3);
    EXPECT_EQ(media.innermost(), 1u);
    media.leave(1);
    EXPECT_EQ(media.innermost(), MediumStack::kNone);
    for (uint32_t material = 1; material <= 6; ++material) media.enter(material);
    for (uint32_t material = 6; material > 2; --material) {
        EXPECT_EQ(media.innermost(), material);
        media.leave(material);
    }
}

}  // namespace
}  // namespace lumi
