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
    // Through walls in and around it, at any depth.
    inside.add(boxMesh(Vec3(0.02f, 0.4f, 0.4f)), lambert(0), translation(Vec3(0.5f, 0, 0.5f)));
    inside.add(boxMesh(Vec3(6, 6, 6)), lambert(0), translation(Vec3(0, -3.45f, 0)));
    expectSeen(seenFromInside(inside, Vec3(0.1f, -0.4f, 0.2f), up), std::pow(0.25, 1.8));
    expectSeen(seenFromInside(inside, Vec3(0.1f, 0.4f, 0.2f), up), std::pow(0.25, 0.2));
}

// A basin five centimetres around the water, wherever the scene is.
TEST(Absorption, BeginsWhereTheCameraIsFarFromTheOrigin) {
    for (const Vec3 place : {Vec3(0), Vec3(-31, 5, 44), Vec3(100, 0, 100), Vec3(1000, -40, 7)}) {
        TinyScene pool;
        pool.add(boxMesh(Vec3(4, 1, 4)), tinted(), translation(place));
        pool.add(boxMesh(Vec3(6, 1, 6)), lambert(0), translation(place + Vec3(0, -1.05f, 0)));
        for (const float side : {-1.0f, 1.0f}) {
            pool.add(boxMesh(Vec3(1, 1, 6)), lambert(0), translation(place + Vec3(2.55f * side, 0, 0)));
            pool.add(boxMesh(Vec3(4, 1, 1)), lambert(0), translation(place + Vec3(0, 0, 2.55f * side)));
        }
        const Estimate e = seenFromInside(pool, place + Vec3(0.1f, -0.25f, 0.2f), Vec3(0, 1, 0));
        EXPECT_NEAR(e.mean, std::pow(0.25, 1.5), 4e-3 * e.mean) << place.x;
    }
}

// Rays leave them in either order.
TEST(Absorption, BeginsInSolidsThatOverlap) {
    TinyScene tiny;
    tiny.add(boxMesh(Vec3(4)), tinted());
    tiny.add(boxMesh(Vec3(4, 3.6f, 4)), tinted(), translation(Vec3(1, 0, 0)));
    const Vec3 up(0, 1, 0);
    expectSeen(seenFromInside(tiny, Vec3(0.5f, 1, 0.2f), up), std::pow(0.25, 2));
    expectSeen(seenFromInside(tiny, Vec3(-1.5f, 1, 0.2f), up), std::pow(0.25, 2));   // in the first alone
    expectSeen(seenFromInside(tiny, Vec3(2.5f, 1, 0.2f), up), std::pow(0.25, 1.6));  // in the other
}

// Panes of a room and the surface of a pool have no other side to be left through.
TEST(Absorption, SheetsAreNoSolidsToBeginIn) {
    TinyScene room;
    room.add(floorMesh(4), tinted(), translation(Vec3(0, 1, 0)));
    room.add(floorMesh(4), lambert(0), translation(Vec3(0, -1, 0)));
    for (const float x : {-2.0f, 2.0f})
        room.add(rectangleMesh(4, 2, Facing::X), tinted(),
                 scaling(Vec3(x < 0 ? -1 : 1, 1, 1)) * translation(Vec3(2, 0, 0)));
    expectSeen(seenFromInside(room, Vec3(0.1f, 0.9f, 0.1f), Vec3(0, 1, 0)), 1);
    expectSeen(seenFromInside(room, Vec3(0.1f, -0.9f, 0.1f), Vec3(0, 1, 0)), 1);
}

// Its plane may cut what it sees.
TEST(Absorption, OrthographicCamerasBeginOutside) {
    Camera camera = lookFrom(Vec3(0), Vec3(0, 0, -1), 45);
    camera.projection = Projection::Orthographic;
    camera.yMag = 1;
    TinyScene tiny;
    tiny.add(boxMesh(Vec3(4, 4, 1)), tinted());
    tiny.scene.environment.constant = Vec3(1);
    Tracer tracer;
    tracer.bind(tiny.pose());
    Signals frame;
    EXPECT_TRUE(tracer.sample(frameOf(camera, {16, 16}, 64, plainPaths(8), {Signal::Noisy}, 1), frame));
    EXPECT_NEAR(frame[Signal::Noisy].at(0, 0, 0), 1, 1e-3);
}

// A point that a camera sees through what it is in, shaded again, and the frame that shows it.
TEST(Absorption, PointsAreShadedAsTheirCameraSeesThem) {
    TinyScene tiny;
    tiny.add(boxMesh(Vec3(4, 2, 4)), tinted());
    Material glow = lambert(0.5f);
    glow.emission = Vec3(1);
    tiny.add(floorMesh(3), glow, translation(Vec3(0, -0.9f, 0)));
    tiny.scene.environment.constant = Vec3(1);
    Tracer tracer;
    tracer.bind(tiny.pose());
    const CameraPose camera = poseCamera(lookFrom(Vec3(0.1f, 0.6f, 0.2f), Vec3(0, -0.9f, 0), 40), {16, 16});
    std::vector<PathStart> starts;
    std::vector<Ray> rays;
    for (uint32_t i = 0; i < 256; ++i) {
        starts.push_back(cameraStart(camera, Vec2(float(i % 16) + 0.5f, float(i / 16) + 0.5f), Vec2(0.5f), 0));
        starts.back().key = {i % 16, i / 16, 0}, starts.back().slot = i;
        rays.push_back(starts.back().ray);
    }
    std::vector<Hit> hits(rays.size());
    tracer.closestHits(rays, hits);
    std::vector<SurfacePoint> points;
    std::vector<Vec3> wo, seen(rays.size()), shaded(rays.size());
    std::vector<RandomKey> keys;
    std::vector<RayCone> cones;
    for (size_t i = 0; i < rays.size(); ++i) {
        ASSERT_TRUE(hits[i].valid());
        points.push_back(hits[i].point), wo.push_back(-rays[i].direction), keys.push_back(starts[i].key);
        cones.push_back({starts[i].cone.spread * hits[i].distance, starts[i].cone.spread});
    }
    ASSERT_TRUE(tracer.tracePaths(starts, plainPaths(4), 3, seen, {}));
    ASSERT_TRUE(tracer.shade(points, wo, keys, plainPaths(4), 3, shaded, {}, {}, cones));
    for (size_t i = 0; i < rays.size(); ++i) {
        EXPECT_LT(seen[i].y, 0.25f);
        EXPECT_NEAR(shaded[i].y / seen[i].y, 1, 2e-3) << i;
    }
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
