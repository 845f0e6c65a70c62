// What light samples met, as axis-aligned filtering asks: a plate over a floor, under lights near and infinitely far.
#include <gtest/gtest.h>

#include "reconstruct/aaf/occlusion.h"
#include "support/transport_scene.h"

namespace lumi::test {
namespace {

constexpr Extent2 kExtent{48, 32};
constexpr float kPlateHeight = 0.75f;

/// From above: the light's -Z is the world's -Y.
Mat4 downwards(const Vec3& from) {
    Mat4 m = translation(from);
    m[1] = Vec4(0, 0, -1, 0);
    m[2] = Vec4(0, 1, 0, 0);
    return m;
}

Mat4 facingDown(const Vec3& at) { return translation(at) * scaling(Vec3(1, -1, -1)); }

Material glowing() {
    Material material;
    material.emission = Vec3(5);
    return material;
}

struct Measured {
    Image image;
    Signals signals;
};

/// A floor and a plate over it.
TinyScene plateOverFloor(const Material& floor) {
    TinyScene tiny;
    tiny.add(floorMesh(), floor);
    tiny.add(floorMesh(1), lambert(0.5f), translation({0, kPlateHeight, 0}));
    return tiny;
}

Measured measure(TinyScene& tiny, DirectStrategy strategy = DirectStrategy::Mis) {
    const auto posed = tiny.pose();
    Tracer tracer;
    tracer.bind(posed);
    FrameSampling sampling =
        frameOf(lookFrom({0, 1.5f, 4}, {0, 0, 0}, 40), kExtent, 1, plainPaths(2), SignalSet::all());
    sampling.path.strategy = strategy;
    Measured measured;
    EXPECT_TRUE(tracer.sample(sampling, measured.signals));
    StageTimer timer;
    const TapSet none;
    const FrameContext context{
        0, measured.signals, *posed, sampling.camera, sampling.camera, {}, none, tracer, sampling, timer, {}};
    Emitters emitters;
    EXPECT_TRUE(measureOcclusion(context, emitters, measured.image));
    return measured;
}

Measured measure(const Material& floor, const Light& light, const Vec3& from) {
    TinyScene tiny = plateOverFloor(floor);
    tiny.addLight(light, downwards(from));
    return measure(tiny);
}

/// The floor under the plate's middle is in full shadow; the floor far from it is lit.
bool isUnder(const Signals& signals, int x, int y) {
    const Image& p = signals[Signal::Position];
    return p.at(1, x, y) < 0.01f && std::abs(p.at(0, x, y)) < 0.35f && std::abs(p.at(2, x, y)) < 0.35f &&
           signals.ids(Signal::ObjectId).at(0, x, y) == 1;
}

TEST(Occlusion, OfASunIsTheBlockersDistanceAndTheSunsAngle) {
    Light sun;
    sun.type = LightType::Directional;
    sun.angleDeg = 8;
    Material glossy;
    glossy.roughness = 0.3f;
    // Surfaces that are diffuse and no more are shaded in another way than others.
    for (const Material& floor : {lambert(0.5f), glossy}) {
        const Measured measured = measure(floor, sun, {0, 0, 0});
        int under = 0, lit = 0;
        for (int y = 0; y < kExtent.height; ++y)
            for (int x = 0; x < kExtent.width; ++x) {
                if (isUnder(measured.signals, x, y)) {
                    ++under;
                    ASSERT_EQ(measured.image.at(1, x, y), 1) << x << ' ' << y;
                    ASSERT_NEAR(measured.image.at(0, x, y), kPlateHeight, 0.003f) << "a cosine of 4 degrees more";
                }
                if (measured.signals[Signal::Position].at(2, x, y) < -2) lit += measured.image.at(1, x, y) == 0;
                // A disk of directions: half its radius, along one of its dimensions.
                const bool onFloor = measured.signals.ids(Signal::ObjectId).at(0, x, y) == 1;
                ASSERT_NEAR(measured.image.at(2, x, y), onFloor ? 0.5f * radians(4) : measured.image.at(2, x, y),
                            0.05f * radians(4));
            }
        EXPECT_GT(under, 10);
        EXPECT_GT(lit, 10);
    }
}

TEST(Occlusion, OfALampIsTheRatioOfDistances) {
    Light lamp;
    lamp.type = LightType::Rectangle;
    lamp.size = Vec2(0.2f);
    const float height = 3;
    const Measured measured = measure(lambert(0.5f), lamp, {0, height, 0});
    int under = 0;
    for (int y = 0; y < kExtent.height; ++y)
        for (int x = 0; x < kExtent.width; ++x) {
            if (!isUnder(measured.signals, x, y)) continue;
            ++under;
            // By similar triangles d1/d2 is the same for every point of a horizontal light.
            ASSERT_EQ(measured.image.at(1, x, y), 1);
            ASSERT_NEAR(measured.image.at(0, x, y), height / (height - kPlateHeight) - 1, 1e-3f);
        }
    EXPECT_GT(under, 10);
}

/// Mean of B over the floor's pixels whose light is known, and how many are blocked.
struct Shadow {
    double deviation = 0;
    int known = 0, blocked = 0;
};
Shadow shadowOf(const Measured& measured) {
    Shadow shadow;
    for (int y = 0; y < kExtent.height; ++y)
        for (int x = 0; x < kExtent.width; ++x) {
            if (measured.signals.ids(Signal::ObjectId).at(0, x, y) != 1) continue;
            shadow.blocked += measured.image.at(1, x, y) > 0;
            if (measured.image.at(2, x, y) <= 0) continue;
            shadow.deviation += static_cast<double>(measured.image.at(2, x, y));
            ++shadow.known;
        }
    shadow.deviation /= std::max(shadow.known, 1);
    return shadow;
}

// The tracer samples each triangle of a mesh as a light of its own; what casts the shadow is the whole.
TEST(Occlusion, AMeshThatShinesIsOneLight) {
    TinyScene square = plateOverFloor(lambert(0.5f));
    square.add(floorMesh(0.8f), glowing(), facingDown({0, 3, 0}));
    const Shadow shadow = shadowOf(measure(square));
    EXPECT_NEAR(shadow.deviation, 0.8 / std::sqrt(12.0), 0.02) << "of a square, along a side";
    EXPECT_GT(shadow.blocked, 40);
}

TEST(Occlusion, OneSampleTellsNoSize) {
    // Two thousand bulbs: hardly one is sampled twice in a frame.
    TinyScene bulbs = plateOverFloor(lambert(0.5f));
    for (int i = 0; i < 2000; ++i)
        bulbs.add(floorMesh(0.004f), glowing(),
                  facingDown({0.05f * static_cast<float>(i % 50) - 1.25f, 3, 0.05f * static_cast<float>(i / 50) - 1}));
    const Measured measured = measure(bulbs);
    int ofNoSize = 0;
    for (int64_t i = 0; i < kExtent.area(); ++i)
        ofNoSize += measured.image.plane(1).data[i] > 0 && measured.image.plane(2).data[i] == 0;
    EXPECT_EQ(ofNoSize, 0) << "a width of zero would be the least of every window";
}

TEST(Occlusion, LightsAreSampledAlsoWhereTheFrameSamplesNone) {
    Light lamp;
    lamp.type = LightType::Rectangle;
    TinyScene tiny = plateOverFloor(lambert(0.5f));
    tiny.addLight(lamp, downwards({0, 3, 0}));
    EXPECT_GT(shadowOf(measure(tiny, DirectStrategy::Bsdf)).blocked, 40);
}

TEST(Emitters, TrianglesThatShareAPlaceAreOne) {
    Mesh mesh;
    // Two triangles with corners of their own at the same places, and one apart.
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 0},
                      {0, 1, 0}, {5, 0, 0}, {6, 0, 0}, {5, 1, 0}};
    mesh.triangles = {{0, 1, 2}, {6, 7, 8}, {3, 4, 5}};
    EXPECT_EQ(connectedParts(mesh), (std::vector<uint32_t>{0, 1, 0}));
}

TEST(Occlusion, TheSharpestShadowCountsWhoseverSlopeIsLess) {
    Light lamp;
    lamp.type = LightType::Rectangle;
    const Measured measured = measure(lambert(0.5f), lamp, {0, 3, 0});
    const int x = kExtent.width / 2, y = kExtent.height - 4;  // floor, as its neighbours
    Image blocked(kExtent, 3), gathered;
    blocked.fill(0);
    const auto put = [&](int at, float slope, float deviation) {
        blocked.at(0, at, y) = slope, blocked.at(1, at, y) = 1, blocked.at(2, at, y) = deviation;
    };
    put(x - 1, 0.125f, 0.5f);     // a panel far away: a penumbra of 0.0625 m
    put(x + 1, 0.5f, 0.015625f);  // a lamp near by: 0.0078125 m
    gatherOcclusion(measured.signals, 1, blocked, gathered);
    const auto expect = [&](int at, float slope, float found, float width) {
        EXPECT_EQ(gathered.at(0, at, y), slope) << at;
        EXPECT_EQ(gathered.at(1, at, y), found) << at;
        EXPECT_EQ(gathered.at(2, at, y), width) << at;
    };
    expect(x - 3, 0, 0, 0);
    expect(x - 2, 0.125f, 1, 0.0625f);
    for (const int at : {x, x + 1, x + 2}) expect(at, 0.5f, 1, 0.0078125f);
}

}  // namespace
}  // namespace lumi::test
