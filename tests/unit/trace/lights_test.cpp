// Choosing lights and points of lights: what is drawn agrees with the density that is told.
#include <gtest/gtest.h>

#include <numeric>

#include "math/warp.h"
#include "support/light_scene.h"
#include "trace/spherical_rectangle.h"
#include "trace/surface.h"

namespace lumi {
namespace {

using namespace test;

TEST(AliasTable, DrawsInProportionToWeights) {
    const std::vector<float> weights{0, 1, 5, 0.25f, 0, 2, 1e-3f, 3};
    const AliasTable table(weights);
    const double total = std::accumulate(weights.begin(), weights.end(), 0.0);
    Numbers numbers(1);
    std::vector<double> observed(weights.size(), 0), expected(weights.size());
    const int count = 200000;
    for (int i = 0; i < count; ++i) ++observed[table.sample(numbers.two())];
    for (uint32_t i = 0; i < weights.size(); ++i) {
        EXPECT_NEAR(table.probability(i), weights[i] / total, 1e-6);
        expected[i] = count * weights[i] / total;
    }
    EXPECT_GT(chiSquareTest(observed, expected), 1e-3);
}

TEST(AliasTable, WithoutWeightIsEmptyAndSpoiledWeightsCountAsNone) {
    EXPECT_TRUE(AliasTable(std::vector<float>{}).empty());
    EXPECT_TRUE(AliasTable(std::vector<float>{0, 0}).empty());
    const AliasTable table(std::vector<float>{-1, std::nanf(""), kInfinity, 2});
    EXPECT_EQ(table.probability(3), 1);
    Numbers numbers(2);
    for (int i = 0; i < 1000; ++i) EXPECT_EQ(table.sample(numbers.two()), 3u);
}

TEST(SphericalRectangle, SolidAngleAndUniformity) {
    const Vec3 corner(-0.5f, -0.3f, 0.8f), x(1.1f, 0, 0), y(0, 0.9f, 0);
    const SphericalRectangle rectangle(Vec3(0), corner, x, y);
    // Solid angle by brute force over the rectangle's area.
    double expected = 0;
    const int n = 400;
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
            const Vec3 p = corner + x * ((i + 0.5f) / n) + y * ((j + 0.5f) / n);
            const double d2 = glm::dot(p, p);
            expected += 1.1 * 0.9 / (n * n) * 0.8 / (d2 * std::sqrt(d2));
        }
    EXPECT_NEAR(rectangle.solidAngle(), expected, 1e-5);
    // Uniform over solid angle: cells of the rectangle are met in proportion to theirs.
    const int cells = 8;
    std::vector<double> observed(cells * cells, 0), wanted(cells * cells, 0);
    Numbers numbers(3);
    const int count = 100000;
    for (int k = 0; k < count; ++k) {
        const Vec3 p = rectangle.sample(numbers.two()) - corner;
        ASSERT_NEAR(p.z, 0, 1e-5);
        const int i = std::clamp(static_cast<int>(p.x / 1.1f * cells), 0, cells - 1);
        const int j = std::clamp(static_cast<int>(p.y / 0.9f * cells), 0, cells - 1);
        ++observed[static_cast<size_t>(j * cells + i)];
    }
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
            const Vec3 p = corner + x * ((i + 0.5f) / n) + y * ((j + 0.5f) / n);
            const double d2 = glm::dot(p, p);
            wanted[static_cast<size_t>(j * cells / n * cells + i * cells / n)] +=
                count * (1.1 * 0.9 / (n * n) * 0.8 / (d2 * std::sqrt(d2))) / expected;
        }
    EXPECT_GT(chiSquareTest(observed, wanted), 1e-3);
}

/// Every way in which a light is chosen, and every way in which a point may face.
std::vector<LightReceiver> receiversAt(const Vec3& position) {
    using Facing = LightReceiver::Facing;
    std::vector<LightReceiver> receivers;
    for (const LightSampling sampling : {LightSampling::Power, LightSampling::Tree})
        for (const Facing facing : {Facing::Any, Facing::Front, Facing::Both})
            receivers.push_back({position, glm::normalize(Vec3(0.5f, 0.8f, -0.2f)), 0, facing, sampling});
    return receivers;
}

double totalProbability(const Lights& lights, const LightReceiver& receiver) {
    double sum = 0;
    for (uint32_t i = 0; i < lights.count(); ++i) sum += lights.pickProbability(receiver, i);
    return sum;
}

TEST(Lights, PickProbabilitiesAreOneTogetherAndCoverEveryEmitter) {
    TraceScene scene;
    bindTo(scene, manyLights().pose());
    const Vec3 eye(0.1f, 0.05f, 0.1f);
    for (const LightReceiver& receiver : receiversAt(eye)) {
        const double total = totalProbability(scene.lights, receiver);
        EXPECT_LT(total, 1 + 1e-4);
        EXPECT_GT(total, receiver.sampling == LightSampling::Power ? 1 - 1e-4 : 0.5);
    }
    for (uint32_t instance = 0; instance < 2; ++instance)
        for (uint32_t t = 0; t < scene.posed->mesh(instance).triangles.size(); ++t)
            EXPECT_GE(scene.lights.entryOf(instance, t), 0);
    EXPECT_TRUE(scene.lights.hasDelta());
    EXPECT_TRUE(scene.lights.hittable());
}

TEST(Lights, AreDrawnAsOftenAsTheySay) {
    TraceScene scene;
    bindTo(scene, manyLights().pose());
    for (const LightReceiver& receiver : receiversAt(Vec3(0.1f, 0.05f, 0.1f))) {
        Numbers numbers(9);
        const int count = 100000;
        std::vector<double> observed(scene.lights.count() + 1, 0), expected(observed.size());
        LightSample light;
        for (int i = 0; i < count; ++i) {
            light.light = -1;
            const Vec2 pick = numbers.two();
            scene.lights.sample(receiver, pick, numbers.two(), light);
            ++observed[light.light >= 0 ? static_cast<size_t>(light.light) : scene.lights.count()];
        }
        for (uint32_t i = 0; i < scene.lights.count(); ++i)
            expected[i] = count * double(scene.lights.pickProbability(receiver, i));
        expected.back() = count * std::max(0.0, 1 - totalProbability(scene.lights, receiver));
        EXPECT_GT(chiSquareTest(observed, expected), 1e-3)
            << static_cast<int>(receiver.facing) << static_cast<int>(receiver.sampling);
    }
}

class LightDensity : public testing::TestWithParam<size_t> {};
INSTANTIATE_TEST_SUITE_P(Receivers, LightDensity, testing::Range<size_t>(0, 6));

TEST_P(LightDensity, OfHitsIntegratesToTheChanceOfExtendedLights) {
    // Over all directions from a point that sees every emitter whole: each direction's densities of all lights along
    // it, blocked or not, add up to 1 less the point light's and the sky's share; nothing blocks anything here but a
    // closed body's far side.
    TraceScene scene;
    bindTo(scene, manyLights().pose());
    const Vec3 eye(0.1f, 0.05f, 0.1f);
    const LightReceiver receiver = receiversAt(eye)[GetParam()];
    Numbers numbers(5);
    RunningMoments moments;
    for (int i = 0; i < 100000; ++i) {
        Vec3 direction = sampleSphere(numbers.two());
        double density = 0;
        BatchRay ray;
        ray.origin = eye, ray.direction = direction;
        for (int pass = 0; pass < 8; ++pass) {
            RawHit hit;
            intersectRays(scene.embree, {&ray, 1}, {&hit, 1}, Coherence::Incoherent);
            if (!hit.valid()) break;
            const Vec3 position = ray.origin + ray.direction * hit.distance;
            const SurfacePoint point = surfacePoint(scene.tables, hit, position, 0);
            const Surface surface = evaluateSurface(scene.tables, point, -direction, 0);
            if (surface.body >= 0) {
                if (surface.frontFace)
                    density += scene.lights.pdfBody(surface.body, receiver, direction, surface.position);
            } else {
                density += scene.lights.pdfTriangle(point.instance, point.primitive, receiver, direction,
                                                    surface.position, surface.outwardNormal);
            }
            ray.origin = offsetOrigin(surface.position, -surface.geometricNormal, surface.offset + 1e-3f);
        }
        moments.add(density / pdfSphere());
    }
    // The sky is the last entry, and the point light before it has no density.
    const auto count = static_cast<uint32_t>(scene.lights.count());
    const double expected = totalProbability(scene.lights, receiver) -
                            scene.lights.pickProbability(receiver, count - 1) -
                            scene.lights.pickProbability(receiver, count - 2);
    EXPECT_NEAR(moments.mean(), expected, 4.5 * std::sqrt(moments.meanVariance()));
    EXPECT_LT(std::sqrt(moments.meanVariance()), 0.03);
}

TEST_P(LightDensity, IsCarriedBySamples) {
    TraceScene scene;
    bindTo(scene, manyLights().pose());
    const Vec3 eye(0.1f, 0.05f, 0.1f);
    const LightReceiver receiver = receiversAt(eye)[GetParam()];
    Numbers numbers(6);
    int compared = 0;
    for (int i = 0; i < 4000; ++i) {
        LightSample light;
        const Vec2 pick = numbers.two(), u = numbers.two();
        if (!scene.lights.sample(receiver, pick, u, light) || !light.hittable || std::isinf(light.distance)) continue;
        BatchRay ray;
        ray.origin = eye, ray.direction = light.direction;
        RawHit hit;
        intersectRays(scene.embree, {&ray, 1}, {&hit, 1}, Coherence::Incoherent);
        if (!hit.valid() || hit.distance < light.distance * 0.999f) continue;  // the far side of a ball
        EXPECT_NEAR(hit.distance, light.distance, 1e-3f * light.distance);
        const SurfacePoint point = surfacePoint(scene.tables, hit, eye + light.direction * hit.distance, 0);
        const Surface s = evaluateSurface(scene.tables, point, -light.direction, 0);
        // On an edge the ray may meet the neighbour.
        if (s.body < 0 && scene.lights.entryOf(point.instance, point.primitive) != light.light) continue;
        const float density = s.body >= 0 ? scene.lights.pdfBody(s.body, receiver, light.direction, s.position)
                                          : scene.lights.pdfTriangle(point.instance, point.primitive, receiver,
                                                                     light.direction, s.position, s.outwardNormal);
        EXPECT_NEAR(density, light.pdf, 0.02f * light.pdf);
        EXPECT_LT(glm::distance(s.emitted, light.radiance), 1e-5f);
        ++compared;
    }
    EXPECT_GT(compared, 500);
}

// A varnish darkens what shines below it by its Fresnel reflectance [KHR_materials_clearcoat, "Emission"].
TEST(Lights, EmissionPassesTheVarnishOverIt) {
    TinyScene tiny;
    Material glow = lambert(0);
    glow.emission = Vec3(2, 1, 0.5f), glow.clearcoat = 0.8f, glow.clearcoatRoughness = 0.4f;
    tiny.add(rectangleMesh(2, 2, Facing::Y), glow, Mat4(1));
    TraceScene scene;
    bindTo(scene, tiny.pose());
    for (const float cosine : {1.0f, 0.5f, 0.17f}) {
        const Vec3 wo(std::sqrt(1 - cosine * cosine), cosine, 0);
        const float expected = 1 - 0.8f * (0.04f + 0.96f * std::pow(1 - cosine, 5.0f));
        const SurfacePoint point{0, 0, {0.3f, 0.3f}, 0};
        for (const Vec3& found :
             {evaluateSurface(scene.tables, point, wo, 0.1f).emitted, triangleEmission(scene.tables, point, wo)})
            EXPECT_LT(glm::distance(found, glow.emission * expected), 1e-5f) << cosine;
    }
}

TEST(Lights, NoneIsEmpty) {
    TraceScene scene;
    TinyScene tiny;
    tiny.add(floorMesh(), lambert(1));
    bindTo(scene, tiny.pose());
    LightSample light;
    EXPECT_TRUE(scene.lights.empty());
    EXPECT_FALSE(scene.lights.sample(LightReceiver(), Vec2(0.5f), Vec2(0.5f), light));
    EXPECT_FALSE(scene.lights.hittable());
}

}  // namespace
}  // namespace lumi
