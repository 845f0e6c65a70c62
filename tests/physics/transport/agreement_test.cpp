// Ways to make the same image that must agree: sampling strategies, instancing, mirrored transforms, thread counts.
#include <gtest/gtest.h>

#include <cstring>

#include "base/parallel.h"
#include "support/image_tests.h"
#include "support/texel_picture.h"
#include "support/transport_scene.h"

namespace lumi {
namespace {

using namespace test;

constexpr Extent2 kExtent{24, 18};
const SignalSet kMoments{Signal::Noisy, Signal::SampleVariance};

/// Area light, sky with a bright side, metal, gloss and a diffuse floor; the metal of that roughness, the gloss of one
/// at least 0.4.
TinyScene mixedScene(float roughness = 0.25f) {
    TinyScene tiny;
    tiny.add(floorMesh(8), lambert(Vec3(0.7f, 0.6f, 0.5f)));
    tiny.add(sphereMesh(0.7f, 32, 16), metal(0.9f, roughness), translation(Vec3(-0.8f, 0.7f, 0)));
    Material gloss;
    gloss.baseColor = Vec3(0.2f, 0.5f, 0.3f);
    gloss.roughness = std::max(0.4f, roughness);
    tiny.add(boxMesh(Vec3(0.8f)), gloss, translation(Vec3(0.8f, 0.4f, 0.3f)));
    Material glow = lambert(0);
    glow.emission = Vec3(3, 2, 1);
    glow.doubleSided = false;
    tiny.add(facetedSphere(0.15f, 8), glow, translation(Vec3(0.1f, 0.6f, 1)));
    Material veil = glow;
    veil.alphaMode = AlphaMode::Blend;
    veil.alpha = 0.4f;
    veil.emission = Vec3(1, 1.5f, 2);
    tiny.add(facetedSphere(0.4f, 6), veil, translation(Vec3(0.2f, 2.2f, -1)));
    Light lamp;
    lamp.type = LightType::Rectangle;
    lamp.size = Vec2(1, 0.5f);
    lamp.radiance = Vec3(4);
    tiny.addLight(lamp, lookAt(Vec3(1, 3, 1), Vec3(0), Vec3(0, 0, 1)));
    Light ball;
    ball.type = LightType::Sphere;
    ball.radius = 0.2f;
    ball.radiance = Vec3(5, 1, 1);
    tiny.addLight(ball, translation(Vec3(-1.6f, 1.5f, 0.8f)));
    auto sky = std::make_shared<Image>(Extent2{16, 8}, 3);
    for (int y = 0; y < 8; ++y)
        for (int x = 0; x < 16; ++x)
            for (int c = 0; c < 3; ++c) sky->at(c, x, y) = y < 4 ? 0.3f + (x == 5 && y == 2 ? 6.0f : 0.0f) : 0.1f;
    tiny.scene.environment.image = sky;
    tiny.scene.environment.rotateDeg = 40;
    return tiny;
}

Camera mixedCamera() { return lookFrom(Vec3(0.5f, 1.6f, 4.5f), Vec3(0, 0.5f, 0), 40); }

Signals render(std::shared_ptr<const PosedScene> posed, const Camera& camera, int spp, PathSettings path, uint32_t seed,
               const SignalSet& wanted = kMoments) {
    Tracer tracer;
    tracer.bind(std::move(posed));
    Signals signals;
    EXPECT_TRUE(tracer.sample(frameOf(camera, kExtent, spp, path, wanted, seed), signals));
    EXPECT_EQ(tracer.counts().nonFinite, 0u);
    return signals;
}

TEST(Strategies, MisLightAndBsdfConvergeToOneImage) {
    // Of a thousand light samples eight fall into the lobe of a metal of roughness 0.25: too few for a normal law, and
    // for a variance that is true. At 0.5 it is sixteen times as many.
    for (const auto& [strategy, roughness] :
         {std::pair(DirectStrategy::Light, 0.5f), std::pair(DirectStrategy::Bsdf, 0.25f)}) {
        const auto posed = mixedScene(roughness).pose();
        const Signals mis = render(posed, mixedCamera(), 256, plainPaths(4, DirectStrategy::Mis), 1);
        const Signals other =
            render(posed, mixedCamera(), 1024, plainPaths(4, strategy), 2 + static_cast<uint32_t>(strategy));
        EXPECT_GE(agreeingShare(mis, other), 0.9975) << static_cast<int>(strategy);
        EXPECT_LT(std::abs(biasInSigmas(mis, other)), 4) << static_cast<int>(strategy);
    }
}

TEST(Strategies, ChoiceOfLightsByPowerAndByTreeConvergeToOneImage) {
    const auto posed = mixedScene().pose();
    PathSettings path = plainPaths(4);
    path.lightSampling = LightSampling::Power;
    const Signals power = render(posed, mixedCamera(), 512, path, 11);
    path.lightSampling = LightSampling::Tree;
    const Signals tree = render(posed, mixedCamera(), 256, path, 12);
    EXPECT_GE(agreeingShare(power, tree), 0.9975);
    EXPECT_LT(std::abs(biasInSigmas(power, tree)), 4);
}

/// Two rows of balls, a layer or lobe each, all of them rough: light samples alone have tails at narrow lobes that
/// hundreds of them do not show in their variance.
TinyScene layeredScene() {
    TinyScene tiny;
    tiny.add(floorMesh(8), lambert(Vec3(0.5f)));
    int count = 0;
    const auto ball = [&](const Material& material) {
        const Vec3 place(-1.05f + 0.7f * static_cast<float>(count % 4), 0.3f, count < 4 ? -0.4f : 0.4f);
        tiny.add(sphereMesh(0.3f, 32, 16), material, translation(place));
        ++count;
    };
    Material coated = lambert(Vec3(0.6f, 0.2f, 0.1f));
    coated.clearcoat = 0.8f, coated.clearcoatRoughness = 0.45f;
    coated.clearcoatNormalTexture = texelPicture({2, 1}, {Vec3(0.8f, 0.5f, 0.9f), Vec3(0.3f, 0.3f, 0.9f)});
    ball(coated);
    Material velvet = lambert(Vec3(0.2f, 0.1f, 0.3f));
    velvet.sheenColor = Vec3(0.9f, 0.7f, 0.8f), velvet.sheenRoughness = 0.4f;
    ball(velvet);
    Material brushed = metal(0.9f, 0.5f);
    brushed.anisotropy = 0.6f, brushed.anisotropyRotation = 0.5f;
    ball(brushed);
    Material film = metal(0.7f, 0.5f);
    film.iridescence = 1, film.iridescenceThicknessMin = film.iridescenceThicknessMax = 420;
    ball(film);
    Material glass;
    glass.transmission = 1, glass.thickness = 1, glass.roughness = 0.7f;
    ball(glass);
    Material wall = glass;
    wall.thickness = 0, wall.baseColor = Vec3(0.7f, 0.9f, 0.8f);
    ball(wall);
    ball(metal(0.95f, 0.9f));
    Material all = brushed;
    all.metallic = 0.3f, all.clearcoat = 0.5f, all.clearcoatRoughness = 0.5f, all.sheenColor = Vec3(0.3f);
    all.iridescence = 0.6f, all.iridescenceThicknessMin = all.iridescenceThicknessMax = 300, all.transmission = 0.4f;
    ball(all);
    Light lamp;
    lamp.type = LightType::Rectangle;
    lamp.size = Vec2(2.5f, 2);
    lamp.radiance = Vec3(1.2f, 1, 0.8f);
    tiny.addLight(lamp, lookAt(Vec3(1, 2, 1.5f), Vec3(0), Vec3(0, 0, 1)));
    tiny.scene.environment.constant = Vec3(0.3f, 0.4f, 0.5f);
    return tiny;
}

// Every layer and lobe has a density that is that of its samples, and a value that is that of its density.
TEST(Strategies, LayersConvergeToOneImage) {
    const auto posed = layeredScene().pose();
    const Camera camera = lookFrom(Vec3(0.2f, 1.4f, 3), Vec3(0, 0.25f, 0), 35);
    const Signals mis = render(posed, camera, 256, plainPaths(3, DirectStrategy::Mis), 1);
    for (const auto strategy : {DirectStrategy::Light, DirectStrategy::Bsdf}) {
        const Signals other = render(posed, camera, 1024, plainPaths(3, strategy), 2 + static_cast<uint32_t>(strategy));
        EXPECT_GE(agreeingShare(mis, other), 0.9975) << static_cast<int>(strategy);
        EXPECT_LT(std::abs(biasInSigmas(mis, other)), 4) << static_cast<int>(strategy);
    }
}

TEST(Strategies, RouletteIsUnbiased) {
    const auto posed = mixedScene().pose();
    PathSettings path = plainPaths(6);
    const Signals plain = render(posed, mixedCamera(), 256, path, 1);
    path.roulette = true;
    path.rouletteDepth = 1;
    const Signals cut = render(posed, mixedCamera(), 512, path, 2);
    EXPECT_GE(agreeingShare(plain, cut), 0.9975);
    EXPECT_LT(std::abs(biasInSigmas(plain, cut)), 4);
}

TEST(Strategies, SobolAndHaltonConvergeToTheSameImage) {
    const auto posed = mixedScene().pose();
    const Signals independent = render(posed, mixedCamera(), 512, plainPaths(3), 1);
    PathSettings path = plainPaths(3);
    path.sampler = SamplerKind::Sobol;
    EXPECT_GE(agreeingShare(independent, render(posed, mixedCamera(), 256, path, 2)), 0.9975);
    path.sampler = SamplerKind::Halton;
    path.haltonLoop = 4096;
    // Points of one Halton sequence are correlated, in high dimensions strongly: its own sample variance says nothing
    // of the error. Turned independently by their seeds, means of short runs are independent.
    constexpr uint32_t kRuns = 64;
    const Image& truth = independent[Signal::Noisy];
    std::vector<RunningMoments> runs(truth.size());
    for (uint32_t run = 0; run < kRuns; ++run) {
        const Signals halton = render(posed, mixedCamera(), 16, path, 100 + run);
        for (size_t i = 0; i < runs.size(); ++i) runs[i].add(halton[Signal::Noisy].data()[i]);
    }
    const double level = sidakLevel(0.01, static_cast<int64_t>(runs.size()));
    size_t agreeing = 0;
    double difference = 0, variance = 0;
    for (size_t i = 0; i < runs.size(); ++i) {
        const double d = runs[i].mean() - truth.data()[i];
        const double own = runs[i].meanVariance() + independent[Signal::SampleVariance].data()[i] / 512.0;
        agreeing += 2 * normalTail(std::abs(d) / std::sqrt(std::max(own, 1e-4 / 512))) > level;
        difference += d, variance += own;
    }
    EXPECT_GE(static_cast<double>(agreeing) / static_cast<double>(runs.size()), 0.9975);
    // The three channels of a pixel are one sample.
    EXPECT_LT(std::abs(difference) / std::sqrt(3 * variance), 4);
}

/// The mesh with a transform baked into its vertices.
Mesh baked(const Mesh& mesh, const Mat4& matrix) {
    Mesh result = mesh;
    for (Vec3& p : result.positions) p = transformPoint(matrix, p);
    const Mat3 normals = normalMatrix(matrix);
    for (Vec3& n : result.normals) n = glm::normalize(normals * n);
    if (isMirroring(matrix))
        for (UVec3& t : result.triangles) std::swap(t.y, t.z);
    return result;
}

TEST(Instances, AgreeWithFlattenedMeshes) {
    const auto ball = std::make_shared<const Mesh>(sphereMesh(0.5f, 24, 12));
    // Plain, sheared by rotation after scaling, mirrored, and mirrored with unequal scales.
    const Mat4 turn = glm::mat4_cast(glm::angleAxis(0.7f, glm::normalize(Vec3(1, 2, 0.5f))));
    const Mat4 places[] = {translation(Vec3(-1.2f, 0.5f, 0)) * scaling(Vec3(0.8f, 1, 0.6f)) * turn,
                           translation(Vec3(0, 0.6f, 0)) * turn * scaling(Vec3(0.4f, 1.1f, 0.7f)),
                           translation(Vec3(1.2f, 0.5f, 0)) * scaling(Vec3(-1, 1, 1)),
                           translation(Vec3(0.4f, 0.4f, 1)) * turn * scaling(Vec3(0.5f, -0.8f, 0.3f))};
    TinyScene shared, flat;
    for (TinyScene* tiny : {&shared, &flat}) {
        tiny->add(floorMesh(8), lambert(0.6f));
        tiny->scene.environment.constant = Vec3(0.5f);
        Light sun;
        sun.type = LightType::Directional;
        sun.angleDeg = 5;
        tiny->addLight(sun, lookAt(Vec3(1, 2, 1), Vec3(0)));
    }
    const int a = shared.addMaterial(metal(0.8f, 0.5f)), b = flat.addMaterial(metal(0.8f, 0.5f));
    for (const Mat4& place : places) {
        shared.add(ball, a, place);
        flat.add(std::make_shared<const Mesh>(baked(*ball, place)), b);
    }
    const Camera camera = lookFrom(Vec3(0.3f, 1.8f, 4), Vec3(0, 0.4f, 0), 40);
    SignalSet wanted = kMoments;
    wanted |= SignalSet{Signal::Normal, Signal::GeometricNormal, Signal::Position, Signal::ObjectId};
    PathSettings path = plainPaths(3);
    const Signals one = render(shared.pose(), camera, 128, path, 1, wanted);
    const Signals two = render(flat.pose(), camera, 128, path, 2, wanted);
    EXPECT_GE(agreeingShare(one, two), 0.9975);
    EXPECT_LT(std::abs(biasInSigmas(one, two)), 4);

    // Geometry of one sample, same random numbers.
    const Signals g1 = render(shared.pose(), camera, 1, path, 3, wanted),
                  g2 = render(flat.pose(), camera, 1, path, 3, wanted);
    int same = 0, all = 0;
    for (int y = 0; y < kExtent.height; ++y)
        for (int x = 0; x < kExtent.width; ++x) {
            if (g1.ids(Signal::ObjectId).at(0, x, y) != g2.ids(Signal::ObjectId).at(0, x, y)) continue;
            ++all;
            double worst = 0;
            // Unequal scales bend interpolated normals a little differently before and after interpolation.
            for (const auto& [s, scale] : {std::pair(Signal::Normal, 0.1), std::pair(Signal::GeometricNormal, 1.0),
                                           std::pair(Signal::Position, 1.0)})
                for (int c = 0; c < 3; ++c)
                    worst = std::max(worst, scale * std::abs(double(g1[s].at(c, x, y)) - g2[s].at(c, x, y)));
            same += worst < 2e-3;
        }
    EXPECT_GT(all, kExtent.area() * 98 / 100);
    EXPECT_GE(same, all - 2);  // a ray may take the other triangle at an edge
}

TEST(Threads, AnyNumberGivesTheSameBytes) {
    const auto posed = mixedScene().pose();
    PathSettings path;
    SignalSet wanted = SignalSet::all();
    setThreadCount(1);
    const Signals one = render(posed, mixedCamera(), 3, path, 5, wanted);
    for (const int threads : {2, 8}) {
        setThreadCount(threads);
        const Signals many = render(posed, mixedCamera(), 3, path, 5, wanted);
        for (int s = 0; s < kSignalCount; ++s) {
            const auto signal = static_cast<Signal>(s);
            const Image &a = one[signal], &b = many[signal];
            ASSERT_EQ(a.size(), b.size());
            EXPECT_EQ(std::memcmp(a.data(), b.data(), a.bytes()), 0) << signalInfo(signal).name << ", " << threads;
            EXPECT_TRUE(one.ids(signal) == many.ids(signal)) << signalInfo(signal).name;
        }
        EXPECT_TRUE(one.noisySum() == many.noisySum());
    }
    setThreadCount(0);
}

}  // namespace
}  // namespace lumi
