// Each kind of emitter alone: light samples, continued paths and both together make one image.
#include <gtest/gtest.h>

#include <cmath>

#include "support/image_tests.h"
#include "support/texel_picture.h"
#include "support/transport_scene.h"

namespace lumi {
namespace {

using namespace test;

constexpr Extent2 kExtent{24, 18};
const SignalSet kMoments{Signal::Noisy, Signal::SampleVariance};

/// A picture of bright and dark squares in several colours.
Texture picture() {
    std::vector<Vec3> squares;
    for (int i = 0; i < 32; ++i) {
        const float value = i % 3 == 0 ? 1.5f : 0.4f;
        squares.emplace_back(value, 0.5f * value, i % 2 ? value : 0.0f);
    }
    return texelPicture({8, 4}, squares);
}

struct Emitter {
    const char* name;
    void (*add)(TinyScene&);
};

Light flatLight(LightType type, bool textured) {
    Light light;
    light.type = type;
    light.size = Vec2(2.4f, 1.6f);
    light.radius = 1.1f;
    light.radiance = Vec3(4, 3, 2);
    if (textured) light.radianceTexture = picture();
    return light;
}

const Mat4 kAbove = lookAt(Vec3(0.5f, 2, 0.6f), Vec3(0, 0, 0), Vec3(0, 0, 1));

Material shining(bool textured, bool bothSides) {
    Material glow = lambert(0.3f);
    glow.emission = Vec3(3);
    glow.doubleSided = bothSides;
    if (textured) glow.emissionTexture = picture();
    return glow;
}

/// A ball that shines unlit, in colours of its vertices of so much `green`.
void addColouredBall(TinyScene& tiny, float green, bool textured) {
    Mesh ball = sphereMesh(0.6f, 16, 8);
    for (const Vec3& n : ball.normals) ball.colours.emplace_back(0.5f + 0.5f * n.x, green, 0.5f - 0.5f * n.x, 1.0f);
    Material unlit = shining(textured, true);
    unlit.unlit = true;
    tiny.add(std::move(ball), unlit, translation(Vec3(0.4f, 1.5f, 0)));
}

const Emitter kEmitters[] = {
    {"Disk", [](TinyScene& tiny) { tiny.addLight(flatLight(LightType::Disk, false), kAbove); }},
    {"TexturedDisk", [](TinyScene& tiny) { tiny.addLight(flatLight(LightType::Disk, true), kAbove); }},
    {"TexturedRectangle", [](TinyScene& tiny) { tiny.addLight(flatLight(LightType::Rectangle, true), kAbove); }},
    {"TexturedSlantedRectangle",
     [](TinyScene& tiny) {
         Mat4 shear(1);
         shear[1].x = 0.4f;
         tiny.addLight(flatLight(LightType::Rectangle, true), kAbove * shear);
     }},
    {"TexturedMesh",
     [](TinyScene& tiny) {
         tiny.add(sphereMesh(0.6f, 16, 8), shining(true, false), translation(Vec3(0.4f, 1.5f, 0)));
     }},
    {"MeshOfBothSides",
     [](TinyScene& tiny) {
         Mesh sheet = rectangleMesh(1.4f, 1.4f, Facing::Y, 5, 5);
         tiny.add(std::move(sheet), shining(true, true), translation(Vec3(0.2f, 1.1f, 0.2f)) * scaling(Vec3(1, 1, -1)));
     }},
    {"UnlitMeshInItsVerticesColours", [](TinyScene& tiny) { addColouredBall(tiny, 0.6f, true); }},
    {"UnlitMeshWithoutATexture", [](TinyScene& tiny) { addColouredBall(tiny, 0.3f, false); }},
    {"MeshUnderAVarnish",
     [](TinyScene& tiny) {
         Material glow = shining(true, false);
         glow.clearcoat = 1, glow.clearcoatRoughness = 0.5f;
         glow.clearcoatNormalTexture = texelPicture({2, 1}, {Vec3(0.8f, 0.5f, 0.9f), Vec3(0.3f, 0.4f, 0.9f)});
         tiny.add(sphereMesh(0.6f, 16, 8), glow, translation(Vec3(0.4f, 1.5f, 0)));
     }},
    {"ManyBalls",
     [](TinyScene& tiny) {
         const auto ball = std::make_shared<const Mesh>(facetedSphere(0.15f, 8));
         const int glow = tiny.addMaterial(shining(false, false));
         for (int i = 0; i < 40; ++i)
             tiny.add(ball, glow,
                      translation(Vec3(-2 + 0.5f * static_cast<float>(i % 9), 1 + 0.25f * static_cast<float>(i % 5),
                                       -1 + 0.4f * static_cast<float>(i / 8))));
     }},
};

class Emitters : public testing::TestWithParam<Emitter> {};
INSTANTIATE_TEST_SUITE_P(Kinds, Emitters, testing::ValuesIn(kEmitters),
                         [](const auto& kind) { return std::string(kind.param.name); });

TEST_P(Emitters, EveryStrategyAndChoiceConvergesToOneImage) {
    // A floor no wider than where the emitter fills a few hundredths of the sky: paths that go on without light samples
    // find it dozens of times, as a normal law wants.
    TinyScene tiny;
    tiny.add(floorMesh(3.2f), lambert(Vec3(0.7f, 0.6f, 0.5f)));
    tiny.add(boxMesh(Vec3(0.7f)), metal(0.8f, 0.5f), translation(Vec3(-0.9f, 0.35f, 0.4f)));
    GetParam().add(tiny);
    Tracer tracer;
    tracer.bind(tiny.pose());
    const Camera camera = lookFrom(Vec3(0.4f, 1.8f, 4.2f), Vec3(0, 0.6f, 0), 42);
    Signals mis, other;
    ASSERT_TRUE(tracer.sample(frameOf(camera, kExtent, 256, plainPaths(2), kMoments, 1), mis));
    struct Way {
        DirectStrategy strategy;
        LightSampling choice;
        int spp;
    };
    for (const Way way :
         {Way{DirectStrategy::Light, LightSampling::Tree, 512}, Way{DirectStrategy::Bsdf, LightSampling::Tree, 1024},
          Way{DirectStrategy::Mis, LightSampling::Power, 256}}) {
        PathSettings path = plainPaths(2, way.strategy);
        path.lightSampling = way.choice;
        ASSERT_TRUE(tracer.sample(frameOf(camera, kExtent, way.spp, path, kMoments, 2), other));
        EXPECT_GE(agreeingShare(mis, other), 0.9975) << static_cast<int>(way.strategy);
        EXPECT_LT(std::abs(biasInSigmas(mis, other)), 4) << static_cast<int>(way.strategy);
    }
    EXPECT_EQ(tracer.counts().nonFinite, 0u);
}

TEST(TexturedLights, ShowTheirPictureUpright) {
    // Red, green above; blue, white below: seen from the front with +Y up.
    auto image = std::make_shared<TextureImage>();
    TextureImage::Level level;
    level.extent = {2, 2};
    level.floats = {1, 0, 0, 1, 0, 1, 0, 1, 0, 0, 1, 1, 1, 1, 1, 1};
    image->levels.push_back(level);
    buildMips(*image);
    for (const LightType type : {LightType::Rectangle, LightType::Disk}) {
        TinyScene tiny;
        Light light = flatLight(type, false);
        light.radiance = Vec3(2);
        light.radianceTexture.image = image;
        light.radianceTexture.filter = TextureFilter::Nearest;
        tiny.addLight(light, Mat4(1));  // shines along -Z
        Tracer tracer;
        tracer.bind(tiny.pose());
        // From -Z, looking along +Z with +Y up, right is -X.
        const Vec3 expected[] = {Vec3(2, 0, 0), Vec3(0, 2, 0), Vec3(0, 0, 2), Vec3(2)};
        for (int i = 0; i < 4; ++i) {
            const Vec3 at(i % 2 ? -0.3f : 0.3f, i / 2 ? -0.2f : 0.2f, 0);
            PathStart start;
            start.ray.origin = at + Vec3(0, 0, -3);
            start.ray.direction = Vec3(0, 0, 1);
            Vec3 radiance;
            tracer.tracePaths({&start, 1}, plainPaths(1), 0, {&radiance, 1}, {});
            EXPECT_LT(glm::distance(radiance, expected[i]), 1e-5f) << i;
        }
    }
}

TEST(TexturedLights, AConstantPictureIsAFactor) {
    const auto irradiance = [](bool textured) {
        TinyScene tiny;
        tiny.add(floorMesh(4), lambert(1));
        Light light = flatLight(LightType::Rectangle, false);
        if (textured) {
            auto grey = std::make_shared<TextureImage>();
            grey->levels.push_back({{1, 1}, {}, {0.5f, 0.5f, 0.5f, 1}});
            buildMips(*grey);
            light.radianceTexture.image = grey;
        }
        tiny.addLight(light, kAbove);
        Tracer tracer;
        tracer.bind(tiny.pose());
        return radianceAlong(tracer, Vec3(2, 1, 2), Vec3(-2, -1, -2), 200, plainPaths(1));
    };
    const Estimate plain = irradiance(false), half = irradiance(true);
    EXPECT_NEAR(half.mean, 0.5 * plain.mean, 1e-5 * plain.mean);
}

}  // namespace
}  // namespace lumi
