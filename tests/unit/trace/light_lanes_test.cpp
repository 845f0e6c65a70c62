// Lights for the lanes of a batch: kernels do what is done one by one.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "base/isa.h"
#include "math/warp.h"
#include "support/light_scene.h"
#include "trace/light_lanes.h"

namespace lumi {
namespace {

using namespace test;

void addSun(TinyScene& tiny, float angleDeg, const Vec3& from) {
    Light sun;
    sun.type = LightType::Directional;
    sun.angleDeg = angleDeg;
    sun.irradiance = Vec3(3, 2, 1);
    tiny.addLight(sun, lookAt(from, Vec3(0)));
}

/// The sky an image, turned; its lower half is dark.
void addSky(TinyScene& tiny) {
    auto sky = std::make_shared<Image>(Extent2{16, 8}, 3);
    for (int c = 0; c < 3; ++c)
        for (int i = 0; i < 64; ++i) sky->at(c, i % 16, i / 16) = 0.1f + static_cast<float>((i + c) * 7 % 13);
    tiny.scene.environment.image = sky;
    tiny.scene.environment.rotateDeg = 40;
}

/// Of every kind.
TinyScene everyLight() {
    TinyScene tiny = manyLights();
    Material glow = lambert(0);
    glow.emission = Vec3(1, 2, 3);
    glow.doubleSided = false;
    tiny.add(facetedSphere(0.5f, 8), glow, translation(Vec3(2, 2, 2)));
    Light spot;
    spot.type = LightType::Spot;
    spot.range = 6;
    tiny.addLight(spot, lookAt(Vec3(1, 2, 1), Vec3(0)));
    addSun(tiny, 30, Vec3(1, 2, 3));
    addSun(tiny, 0, Vec3(-2, 3, 1));
    addSky(tiny);
    return tiny;
}

void expectNear(const Vec3& a, const Vec3& b, float tolerance, size_t lane) {
    EXPECT_LT(maxComponent(glm::abs(a - b)), tolerance * (1 + maxComponent(glm::abs(b)))) << lane;
}

/// Batches are sampled by kernels, lane by lane what samplePoint() gives: every kind of light, each side of triangles.
/// And the same bytes on every instruction set.
TEST(LightLanes, SampleAsOneByOne) {
    TraceScene scene;
    bindTo(scene, everyLight().pose());

    const auto lanes = std::make_unique<PlainLanes>(), inputs = std::make_unique<PlainLanes>(),
               plain = std::make_unique<PlainLanes>();
    const auto lights = std::make_unique<LightLanes>();
    std::vector<LightReceiver> receivers(PlainLanes::kMost);
    std::vector<Lights::Choice> choices(PlainLanes::kMost);
    Numbers numbers(11);
    size_t reached = 0, infinite = 0;
    for (uint32_t first = 0; first < scene.lights.count(); first += PlainLanes::kMost) {
        inputs->count = PlainLanes::kMost;
        for (uint32_t i = 0; i < PlainLanes::kMost; ++i) {
            const Vec3 place = (Vec3(numbers.one(), numbers.one(), numbers.one()) - Vec3(0.5f)) * 6.0f;
            receivers[i] = {place, sampleSphere(numbers.two()), 0, LightReceiver::Facing::Front, LightSampling::Tree};
            // The last entries are those without a triangle.
            const uint32_t entry =
                i % 2 == 0 ? first + i : static_cast<uint32_t>(scene.lights.count()) - 1 - i % 19 / 2;
            choices[i] = {entry % static_cast<uint32_t>(scene.lights.count()), 0.3f};
            inputs->position.set(static_cast<int>(i), place);
            inputs->lightPointX[i] = numbers.one(), inputs->lightPointY[i] = numbers.one();
        }
        const Isa best = activeIsa();
        for (const Isa isa : {Isa::Baseline, Isa::V3, Isa::V4}) {
            if (isa > best) continue;
            setIsa(isa);
            *lanes = *inputs;
            scene.lights.samplePoints(choices, receivers, *lights, *lanes);
            if (isa == Isa::Baseline) *plain = *lanes;
            EXPECT_EQ(std::memcmp(lanes.get(), plain.get(), sizeof(PlainLanes)), 0) << isaName(isa);
        }
        for (size_t i = 0; i < PlainLanes::kMost; ++i) {
            LightSample one;
            const int lane = static_cast<int>(i);
            const bool some =
                scene.lights.samplePoint(choices[i], receivers[i], {lanes->lightPointX[i], lanes->lightPointY[i]}, one);
            ASSERT_EQ(lanes->lightPdf[i] > 0, some) << i;
            if (!some) continue;
            ++reached;
            EXPECT_NEAR(lanes->lightPdf[i] / one.pdf, 1, 1e-4) << i;
            expectNear(lanes->lightDirection.get<Vec3>(lane), one.direction, 1e-5f, i);
            expectNear(lights->position.get<Vec3>(lane), one.position, 1e-5f, i);
            expectNear(lanes->lightRadiance.get<Vec3>(lane), one.sky ? Vec3(1) : one.radiance, 1e-4f, i);
            EXPECT_EQ(lanes->lightWeighs[i] > 0, one.hittable) << i;
            EXPECT_EQ(scene.lights.isSky(choices[i].entry), one.sky) << i;
            if (one.sky) {
                EXPECT_NEAR(lights->skyU[i], one.skyPlace.x, 1e-5) << i;
                EXPECT_NEAR(lights->skyV[i], one.skyPlace.y, 1e-5) << i;
            }
            if (std::isinf(one.distance)) {
                ++infinite;
                EXPECT_EQ(lanes->lightDistance[i], kInfinity) << i;
            } else {
                EXPECT_NEAR(lanes->lightDistance[i] / one.distance, 1, 1e-5) << i;
                expectNear(lanes->lightTarget.get<Vec3>(lane), one.target, 1e-5f, i);
            }
        }
    }
    EXPECT_GT(reached, scene.lights.count() / 2);
    EXPECT_GT(infinite, scene.lights.count() / 10);
}

void setReceiver(PlainLanes& lanes, std::vector<LightReceiver>& receivers, int lane, const LightReceiver& receiver) {
    receivers[static_cast<size_t>(lane)] = receiver;
    lanes.position.set(lane, receiver.position), lanes.geometricNormal.set(lane, receiver.normal);
}

/// Every lane of batches of any length chooses what it chooses alone, on every instruction set.
void expectChoicesOfOneByOne(TinyScene tiny, LightSampling sampling) {
    TraceScene scene;
    bindTo(scene, tiny.pose());
    const auto lanes = std::make_unique<PlainLanes>();
    std::vector<LightReceiver> receivers(PlainLanes::kMost);
    std::vector<Lights::Choice> choices(PlainLanes::kMost);
    Numbers numbers(5);
    const Isa best = activeIsa();
    for (const Isa isa : {Isa::Baseline, Isa::V3, Isa::V4})
        for (const int count : {0, 1, 7, 65, 253, PlainLanes::kMost}) {
            if (isa > best) continue;
            setIsa(isa);
            lanes->count = count;
            for (int i = 0; i < count; ++i) {
                const Vec3 place = (Vec3(numbers.one(), numbers.one(), numbers.one()) - Vec3(0.5f)) * 6.0f;
                const Vec3 normal = i % 5 == 0 ? Vec3(0, -1, 0) : sampleSphere(numbers.two());
                setReceiver(*lanes, receivers, i, {place, normal, 0, LightReceiver::Facing::Front, sampling});
                lanes->lightX[i] = numbers.one(), lanes->lightY[i] = numbers.one();
            }
            const auto size = static_cast<size_t>(count);
            scene.lights.choose(*lanes, {receivers.data(), size}, {choices.data(), size});
            for (size_t i = 0; i < size; ++i) {
                LightSample one;
                scene.lights.sample(receivers[i], {lanes->lightX[i], lanes->lightY[i]}, Vec2(0.5f), one);
                const bool some = choices[i].entry != Lights::kNone && choices[i].probability > 0;
                ASSERT_EQ(some ? static_cast<int>(choices[i].entry) : -1, one.light) << i << " of " << count;
                if (!some) continue;
                EXPECT_NEAR(choices[i].probability / scene.lights.pickProbability(receivers[i], choices[i].entry), 1,
                            1e-5)
                    << i << " of " << count << ", " << isaName(isa);
            }
        }
    setIsa(best);
}

TEST(LightLanes, ChooseAsOneByOne) {
    for (const LightSampling sampling : {LightSampling::Power, LightSampling::Tree}) {
        expectChoicesOfOneByOne(manyLights(), sampling);
        expectChoicesOfOneByOne(everyLight(), sampling);
        TinyScene far;
        far.add(floorMesh(), lambert(0.5f));
        addSun(far, 2, Vec3(1, 2, 3));
        addSky(far);
        expectChoicesOfOneByOne(far, sampling);
        TinyScene lamps = far;
        Light lamp;
        for (int i = 0; i < 4; ++i) {
            lamp.intensity = Vec3(static_cast<float>(i));
            lamps.addLight(lamp, translation(Vec3(i - 2, 1, i % 2)));
            expectChoicesOfOneByOne(lamps, sampling);
        }
        // More than have a place in the batch's tables.
        for (int i = 0; i < 5; ++i) addSun(far, static_cast<float>(i), Vec3(i - 2, 1, 2 - i % 3));
        expectChoicesOfOneByOne(far, sampling);
        TinyScene alone;
        alone.add(floorMesh(), lambert(0.5f));
        alone.scene.environment.constant = Vec3(1);
        expectChoicesOfOneByOne(alone, sampling);
    }
}

/// A sun that sets while the shutter is open: each lane has its own time.
TEST(LightLanes, ChooseMovingSunsByTheirTime) {
    TinyScene tiny;
    tiny.add(floorMesh(), lambert(0.5f));
    addSun(tiny, 1, Vec3(2, 2, 1));
    addSun(tiny, 1, Vec3(0, 1, 0));
    const int node = tiny.scene.lights.back().node;
    tiny.scene.nodes[static_cast<size_t>(node)].hasMatrix = false;
    AnimationChannel turn;
    turn.node = node, turn.property = AnimatedProperty::Rotation, turn.components = 4;
    const float half = std::sqrt(0.5f);
    turn.times = {0, 1}, turn.values = {-half, 0, 0, half, 0, 0, 0, 1};  // from straight above to the horizon
    Animation setting;
    setting.duration = 1, setting.loop = false;
    setting.channels.push_back(turn);
    tiny.scene.animations.push_back(setting);
    TraceScene scene;
    bindTo(scene, tiny.pose({.open = 0, .close = 1, .previousOpen = 0}));

    const auto lanes = std::make_unique<PlainLanes>();
    std::vector<LightReceiver> receivers(PlainLanes::kMost);
    std::vector<Lights::Choice> choices(PlainLanes::kMost);
    lanes->count = PlainLanes::kMost;
    Numbers numbers(3);
    for (int i = 0; i < PlainLanes::kMost; ++i) {
        const float time = static_cast<float>(i) / PlainLanes::kMost;
        setReceiver(*lanes, receivers, i,
                    {Vec3(0), Vec3(0, 1, 0), time, LightReceiver::Facing::Front, LightSampling::Tree});
        lanes->lightX[i] = numbers.one(), lanes->lightY[i] = numbers.one();
    }
    scene.lights.choose(*lanes, receivers, choices);
    size_t moving = 0;
    for (size_t i = 0; i < choices.size(); ++i) {
        ASSERT_NE(choices[i].entry, Lights::kNone);
        moving += choices[i].entry == 1;
        EXPECT_NEAR(choices[i].probability / scene.lights.pickProbability(receivers[i], choices[i].entry), 1, 1e-4);
    }
    EXPECT_GT(moving, 50u);
    EXPECT_GT(scene.lights.pickProbability(receivers.front(), 1), 0.5f);
    EXPECT_LT(scene.lights.pickProbability(receivers.back(), 1), 0.1f);
}

}  // namespace
}  // namespace lumi
