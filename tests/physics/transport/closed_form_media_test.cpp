// Furnaces, glass and transparency, against closed forms.
#include <gtest/gtest.h>

#include "support/transport_scene.h"
#include "trace/bsdf.h"
#include "trace/surface.h"
#include "trace/trace_scene.h"

namespace lumi {
namespace {

using namespace test;

constexpr double kMostSigmas = 4.5;

TEST(Furnace, ConvexBodyUnderConstantSkyShowsItsAlbedo) {
    for (const float albedo : {0.5f, 1.0f}) {
        TinyScene tiny;
        tiny.add(facetedSphere(1), lambert(albedo));
        tiny.scene.environment.constant = Vec3(1);
        Tracer tracer;
        tracer.bind(tiny.pose());
        for (const Vec3 from : {Vec3(0.2f, 0.3f, 4), Vec3(3, 0.1f, -2)}) {
            const Estimate e = radianceAlong(tracer, from, Vec3(0.1f, 0, 0.2f) - from, 20000, plainPaths(4));
            EXPECT_LT(e.z(albedo), kMostSigmas) << e.mean << " against " << albedo;
        }
    }
}

/// Radiance 1 from everywhere, made by one kind of light.
struct Surroundings {
    const char* name;
    void (*add)(TinyScene&);
};

Texture halfBright() {
    auto grey = std::make_shared<TextureImage>();
    grey->levels.push_back({{1, 1}, {}, {0.5f, 0.5f, 0.5f, 1}});
    buildMips(*grey);
    Texture texture;
    texture.image = grey;
    return texture;
}

/// The six sides of a cube around the origin.
void addCube(TinyScene& tiny, bool textured) {
    Light side;
    side.type = LightType::Rectangle;
    side.size = Vec2(8);
    side.radiance = Vec3(textured ? 2 : 1);
    if (textured) side.radianceTexture = halfBright();
    for (const Vec3& axis : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)})
        for (const float sign : {-4.0f, 4.0f})
            tiny.addLight(side, lookAt(sign * axis, Vec3(0), Vec3(axis.z, axis.x, axis.y)));
}

void addBall(TinyScene& tiny, bool textured) {
    Material shell = lambert(0);
    shell.emission = Vec3(textured ? 2 : 1);
    if (textured) shell.emissionTexture = halfBright();
    tiny.add(sphereMesh(4, 24, 12), shell);
}

const Surroundings kSurroundings[] = {
    {"sky", [](TinyScene& tiny) { tiny.scene.environment.constant = Vec3(1); }},
    {"turned sky of an image",
     [](TinyScene& tiny) {
         auto image = std::make_shared<Image>(Extent2{8, 4}, 3);
         image->fill(0.5f);
         tiny.scene.environment.image = image;
         tiny.scene.environment.scale = 2;
         tiny.scene.environment.rotateDeg = 35;
     }},
    {"rectangles", [](TinyScene& tiny) { addCube(tiny, false); }},
    {"textured rectangles", [](TinyScene& tiny) { addCube(tiny, true); }},
    {"mesh", [](TinyScene& tiny) { addBall(tiny, false); }},
    {"textured mesh", [](TinyScene& tiny) { addBall(tiny, true); }},
};

/// Directional albedo of the first instance, a level sheet at the origin, towards `from`: what all its lobes add up to.
double albedoTowards(TinyScene& tiny, const Vec3& from) {
    TraceScene scene;
    scene.posed = tiny.pose();
    scene.embree.bind(*scene.posed);
    scene.tables = makeSceneTables(*scene.posed, scene.embree);
    const Vec3 wo = glm::normalize(from);
    Surface surface = evaluateSurface(scene.tables, {0, 0, Vec2(0.25f), 0}, wo, 0);
    surface.inputs.multipleScattering = PathSettings().multipleScattering;
    const Bsdf bsdf(surface.inputs, Frame(surface.normal).toLocal(wo));
    return bsdf.albedo(Lobe::Diffuse).y + bsdf.specularAlbedo().y;
}

TEST(Furnace, OfEveryKindOfLightShowsASheetsAlbedo) {
    Material coated = lambert(1);
    coated.specular = 1, coated.roughness = 0.4f;
    coated.clearcoat = 0.7f, coated.clearcoatRoughness = 0.3f;
    coated.sheenColor = Vec3(0.6f), coated.sheenRoughness = 0.5f;
    Material wall = coated;
    wall.clearcoat = 0, wall.sheenColor = Vec3(0), wall.specular = 0, wall.transmission = 0.6f;
    const Vec3 from(0.8f, 0.9f, 0.3f);
    for (const Surroundings& kind : kSurroundings)
        for (const Material& material : {lambert(0.8f), coated, wall})
            for (const auto strategy : {DirectStrategy::Mis, DirectStrategy::Light, DirectStrategy::Bsdf}) {
                TinyScene tiny;
                tiny.add(rectangleMesh(1, 1, Facing::Y), material);
                kind.add(tiny);
                Tracer tracer;
                tracer.bind(tiny.pose());
                const double albedo = albedoTowards(tiny, from);
                const Estimate e = radianceAlong(tracer, from, -from, 8000, plainPaths(1, strategy));
                // Tables of albedos are off by up to a thousandth.
                EXPECT_NEAR(e.mean, albedo, kMostSigmas * e.standardError + 1e-3)
                    << kind.name << ", strategy " << static_cast<int>(strategy);
                EXPECT_LT(e.standardError, 0.03) << kind.name << ", strategy " << static_cast<int>(strategy);
            }
}

TEST(Furnace, ClosedSphereIsTheGeometricSeries) {
    // Emission E and albedo a everywhere: E (1 + a + a^2 + ...) = E / (1 - a).
    for (const auto strategy : {DirectStrategy::Mis, DirectStrategy::Light, DirectStrategy::Bsdf}) {
        TinyScene tiny;
        Material wall = lambert(0.5f);
        wall.emission = Vec3(0.7f);
        tiny.add(facetedSphere(2, 24), wall);
        Tracer tracer;
        tracer.bind(tiny.pose());
        PathSettings path = plainPaths(24, strategy);
        path.roulette = true;
        const Estimate e = radianceAlong(tracer, Vec3(0.1f, 0.2f, 0.3f), Vec3(1, 0.4f, -0.3f), 40000, path);
        EXPECT_LT(e.z(1.4), kMostSigmas) << e.mean << " with strategy " << static_cast<int>(strategy);
        EXPECT_LT(e.standardError, 0.02);
    }
}

TEST(Furnace, DepthCutsTheSeries) {
    TinyScene tiny;
    Material wall = lambert(0.5f);
    wall.emission = Vec3(1);
    tiny.add(facetedSphere(2, 24), wall);
    Tracer tracer;
    tracer.bind(tiny.pose());
    double expected = 1;
    for (int depth = 1; depth <= 3; ++depth) {
        expected += std::pow(0.5, depth);
        const Estimate e =
            radianceAlong(tracer, Vec3(0.1f, 0.2f, 0.3f), Vec3(1, 0.4f, -0.3f), 20000, plainPaths(depth));
        EXPECT_LT(e.z(expected), kMostSigmas) << e.mean << " at depth " << depth;
    }
}

TEST(Furnace, GlassSphereIsInvisible) {
    // What facets scatter more than once is given back but for the tables' margin of 0.0015 a meeting inside; at a mean
    // internal reflectance of 0.6 a path has two and a half of these.
    for (const auto& [roughness, tolerance] :
         {std::pair(0.0f, 0.003), std::pair(0.3f, 0.005), std::pair(0.8f, 0.005)}) {
        TinyScene tiny;
        tiny.add(facetedSphere(1, 48), glass(roughness));
        tiny.scene.environment.constant = Vec3(1);
        Tracer tracer;
        tracer.bind(tiny.pose());
        const Estimate e = radianceAlong(tracer, Vec3(0.3f, 0.2f, 4), Vec3(-0.02f, 0.03f, -1), 20000, plainPaths(64));
        EXPECT_NEAR(e.mean, 1, tolerance + 3 * e.standardError) << "roughness " << roughness;
    }
}

TEST(Transmission, ThinWallIsSeenStraightThrough) {
    // A pane without volume at 45 degrees before a small card of radiance 5, sky 1: F + (1 - F) colour 5.
    TinyScene tiny;
    Material pane = glass(0);
    pane.thickness = 0;
    pane.baseColor = Vec3(0.8f);
    tiny.add(rectangleMesh(4, 4, Facing::Z), pane);
    Material card = lambert(0);
    card.emission = Vec3(5);
    tiny.add(rectangleMesh(0.02f, 0.02f, Facing::Z), card, translation(Vec3(-1, 0, -1)));
    tiny.scene.environment.constant = Vec3(1);
    Tracer tracer;
    tracer.bind(tiny.pose());
    const double cosI = std::sqrt(0.5), cosT = std::sqrt(1 - 0.5 / 2.25);
    const double perpendicular = (cosI - 1.5 * cosT) / (cosI + 1.5 * cosT),
                 parallel = (1.5 * cosI - cosT) / (1.5 * cosI + cosT);
    const double f = 0.5 * (perpendicular * perpendicular + parallel * parallel);
    const Estimate e = radianceAlong(tracer, Vec3(1, 0, 1), Vec3(-1, 0, -1), 20000, plainPaths(4));
    EXPECT_LT(e.z(f + (1 - f) * 0.8 * 5), kMostSigmas) << e.mean;
}

// A light without extent is found by light samples alone, so they go through panes as continued paths do.
TEST(Transmission, LightsWithoutExtentShineThroughPanes) {
    Material pane = glass(0);
    pane.thickness = 0;
    pane.baseColor = Vec3(0.8f);
    const double f = 0.04, through = (1 - f) * 0.8;  // at normal incidence
    for (const bool sun : {true, false})
        for (const int panes : {0, 1, 2}) {
            TinyScene tiny;
            tiny.add(floorMesh(), lambert(1));
            for (int i = 0; i < panes; ++i)
                tiny.add(rectangleMesh(2, 2, Facing::Y), pane,
                         translation(Vec3(0, 1 + 0.5f * static_cast<float>(i), 0)));
            Light light;
            light.type = sun ? LightType::Directional : LightType::Point;
            light.irradiance = Vec3(kPi);
            light.intensity = Vec3(4 * kPi);
            tiny.addLight(light, lookAt(Vec3(0, 2, 0), Vec3(0), Vec3(0, 0, 1)));
            Tracer tracer;
            tracer.bind(tiny.pose());
            const Estimate e = radianceAlong(tracer, Vec3(0.5f, 0.5f, 0), Vec3(-0.5f, -0.5f, 0), 64, plainPaths(1));
            EXPECT_NEAR(e.mean, std::pow(through, panes), 2e-3) << panes << (sun ? " under a sun" : " under a lamp");
            // Behind something that stands beyond the pane it is dark all the same.
            tiny.add(rectangleMesh(0.2f, 0.2f, Facing::Y), lambert(0.5f), translation(Vec3(0, 1.9f, 0)));
            tracer.bind(tiny.pose());
            EXPECT_EQ(radianceAlong(tracer, Vec3(0.5f, 0.5f, 0), Vec3(-0.5f, -0.5f, 0), 64, plainPaths(1)).mean, 0);
        }
}

TEST(Alpha, BlendedCoverageIsAlpha) {
    TinyScene tiny;
    Material veil = lambert(0);
    veil.alphaMode = AlphaMode::Blend;
    veil.alpha = 0.3f;
    veil.emission = Vec3(1);
    tiny.add(rectangleMesh(2, 2, Facing::Z), veil);
    Tracer tracer;
    tracer.bind(tiny.pose());
    const Estimate e = radianceAlong(tracer, Vec3(0.1f, 0.2f, 3), Vec3(0, 0, -1), 20000, plainPaths(1));
    EXPECT_LT(e.z(0.3), kMostSigmas) << e.mean;
}

TEST(Alpha, BlendedShadowLetsTheRestThrough) {
    TinyScene tiny;
    tiny.add(floorMesh(), lambert(1));
    Material veil = lambert(0);
    veil.alphaMode = AlphaMode::Blend;
    veil.alpha = 0.3f;
    // Twice the same mesh: through Embree instances.
    const auto sheet = std::make_shared<const Mesh>(rectangleMesh(2, 2, Facing::Y));
    const int material = tiny.addMaterial(veil);
    tiny.add(sheet, material, translation(Vec3(0, 1, 0)));
    tiny.add(sheet, material, translation(Vec3(0, 1.5f, 0)));
    Light sun;
    sun.type = LightType::Directional;
    sun.irradiance = Vec3(kPi);
    tiny.addLight(sun, lookAt(Vec3(0, 1, 0), Vec3(0), Vec3(0, 0, 1)));
    Tracer tracer;
    tracer.bind(tiny.pose());
    const Estimate e = radianceAlong(tracer, Vec3(0, 0.5f, 0), Vec3(0.1f, -1, 0), 20000, plainPaths(1));
    EXPECT_LT(e.z(0.49), kMostSigmas) << e.mean;
}

TEST(Alpha, MaskIsAllOrNothing) {
    for (const float alpha : {0.4f, 0.6f}) {
        TinyScene tiny;
        Material leaf = lambert(0);
        leaf.alphaMode = AlphaMode::Mask;
        leaf.alphaCutoff = 0.5f;
        leaf.alpha = alpha;
        leaf.emission = Vec3(1);
        tiny.add(rectangleMesh(2, 2, Facing::Z), leaf);
        Tracer tracer;
        tracer.bind(tiny.pose());
        EXPECT_EQ(radianceAlong(tracer, Vec3(0, 0, 3), Vec3(0.01f, 0, -1), 64, plainPaths(1)).mean,
                  alpha > 0.5f ? 1 : 0);
    }
}

TEST(Regularize, WidensLobesOnlyAfterDiffuseOnes) {
    TinyScene tiny;
    tiny.add(floorMesh(), metal(0.9f, 0.1f));
    tiny.scene.environment.constant = Vec3(1);
    Tracer tracer;
    tracer.bind(tiny.pose());
    PathSettings path = plainPaths(2);
    const double before = radianceAlong(tracer, Vec3(0, 1, 0), Vec3(1, -1, 0), 256, path).mean;
    path.regularize = true;
    EXPECT_EQ(radianceAlong(tracer, Vec3(0, 1, 0), Vec3(1, -1, 0), 256, path).mean, before);
}

// Of panes, too: what does not meet a pane as a widened one has no other way to a light without extent behind it.
TEST(Regularize, LeavesNoLightBehindPanes) {
    Material pane = glass(0);
    pane.thickness = 0;
    for (const bool sun : {true, false}) {
        TinyScene tiny;
        tiny.add(floorMesh(), metal(0.9f, 0.5f));
        tiny.add(rectangleMesh(2, 2, Facing::Y), pane, translation(Vec3(0, 1, 0)));
        Light light;
        light.type = sun ? LightType::Directional : LightType::Point;
        light.irradiance = light.intensity = Vec3(4);
        tiny.addLight(light, lookAt(Vec3(-0.4f, 2, 0), Vec3(0), Vec3(0, 0, 1)));
        Tracer tracer;
        tracer.bind(tiny.pose());
        PathSettings path = plainPaths(3);
        const auto seen = [&] {
            return radianceAlong(tracer, Vec3(0.5f, 0.5f, 0), Vec3(-0.5f, -0.5f, 0), 20000, path).mean;
        };
        const double plain = seen();
        EXPECT_GT(plain, 0.1);
        path.regularize = true;
        EXPECT_NEAR(seen(), plain, 1e-5 * plain) << "behind a rough mirror nothing is widened";
        path.regularizeAfter = RegularizeAfter::Any;
        path.regularizeRoughness = 0.02f;
        EXPECT_NEAR(seen(), plain, 1e-3 * plain) << "all but the first sample meet a mirror";
        path.regularizeRoughness = 0.3f, path.regularizeDecay = 0;
        EXPECT_NEAR(seen(), plain, 0.25 * plain) << "widened";
        // As diffuse as it shines: the widened pane brings one half, light samples the other.
        tiny.scene.materials[0] = lambert(0.5f);
        tracer.bind(tiny.pose());
        path.regularizeAfter = RegularizeAfter::Diffuse;
        const double widened = seen();
        path.regularize = false;
        EXPECT_NEAR(widened, seen(), 0.2 * seen());
        // After the last scattering nothing meets a pane, whatever it were.
        path.regularize = true;
        path.maxDepth = 1;
        const double direct = seen();
        tiny.add(rectangleMesh(2, 2, Facing::Y), pane, translation(Vec3(0, 1.5f, 0)));
        tracer.bind(tiny.pose());
        path.maxDepth = 2;
        const double throughTwo = seen();
        path.regularize = false;
        EXPECT_NEAR(throughTwo, seen(), 0.2 * seen());
        path.maxDepth = 1;
        EXPECT_NEAR(direct, seen() / 0.96, 0.01 * direct) << "but for the second pane";
    }
}

// A mirror throws a point light onto the floor by paths that nothing samples; widened it does. With a decay the
// widening ends at the sample whose least roughness is that of a mirror, here near the 8300th, and what it added falls
// as 1/n.
TEST(Regularize, OpensClosedPathsAndVanishes) {
    TinyScene tiny;
    tiny.add(floorMesh(), lambert(0.5f));
    tiny.add(rectangleMesh(4, 4, Facing::Z), metal(1, 0), translation(Vec3(0, 1, -1)));
    Light lamp;
    lamp.type = LightType::Point;
    lamp.intensity = Vec3(1);
    tiny.addLight(lamp, translation(Vec3(0, 1, 0.5f)));
    Tracer tracer;
    tracer.bind(tiny.pose());
    PathSettings path = plainPaths(2);
    const auto mean = [&](int count) {
        return radianceAlong(tracer, Vec3(0, 2, 1), Vec3(0, -2, -1), count, path).mean;
    };
    // On the floor at the origin: 1/pi 0.5 cos / r^2.
    const double direct = 0.5 / M_PI * (1 / std::sqrt(1.25)) / 1.25;
    EXPECT_NEAR(mean(64), direct, 1e-5);
    path.regularize = true;
    path.regularizeDecay = 0;
    const double kept = mean(4000) - direct;
    EXPECT_GT(kept, 0.02 * direct);
    path.regularizeDecay = 0.3f;
    const double early = mean(10000) - direct, late = mean(40000) - direct;
    EXPECT_GT(early, 1e-4 * direct);
    EXPECT_NEAR(late / early, 0.25, 0.005);
}

}  // namespace
}  // namespace lumi
