// Choosing lights and points of lights: what is drawn agrees with the density that is told.
#include <gtest/gtest.h>

#include <cstring>
#include <numeric>

#include "base/isa.h"
#include "math/hash.h"
#include "math/warp.h"
#include "support/transport_scene.h"
#include "trace/light_lanes.h"
#include "trace/spherical_rectangle.h"
#include "trace/surface.h"
#include "trace/trace_scene.h"

namespace lumi {
namespace {

using namespace test;

/// Plain random numbers by counting.
class Numbers {
public:
    explicit Numbers(uint32_t seed) : seed_(seed) {}
    float one() { return unitFloat(hashCombine(seed_, count_++)); }
    Vec2 two() {
        const float a = one();
        return {a, one()};
    }

private:
    uint32_t seed_, count_ = 0;
};

void bindTo(TraceScene& scene, std::shared_ptr<const PosedScene> posed) {
    scene.posed = std::move(posed);
    scene.embree.bind(*scene.posed);
    scene.tables = makeSceneTables(*scene.posed, scene.embree);
    scene.lights.build(*scene.posed, scene.tables);
}

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

/// Emissive triangles of three instances, one mirrored, one shared; a lamp of each kind.
TinyScene manyLights() {
    TinyScene tiny;
    Material glow = lambert(0);
    glow.emission = Vec3(2);
    const int material = tiny.addMaterial(glow);
    const auto ball = std::make_shared<const Mesh>(facetedSphere(0.4f, 12));
    tiny.add(ball, material, translation(Vec3(-2, 0, 0)));
    tiny.add(ball, material, translation(Vec3(0, 0, -2)) * scaling(Vec3(-1, 0.5f, 1.5f)));
    glow.clearcoat = 0.9f;
    tiny.add(facetedSphere(0.2f, 6), glow, translation(Vec3(1.2f, -1.2f, 0.8f)));
    Light light;
    light.type = LightType::Rectangle;
    tiny.addLight(light, lookAt(Vec3(2, 0.5f, 0), Vec3(0)));
    light.type = LightType::Sphere;
    light.radius = 0.4f;
    tiny.addLight(light, translation(Vec3(0, 2, 0)));
    light.type = LightType::Disk;
    tiny.addLight(light, lookAt(Vec3(0, 0, 2), Vec3(0)));
    light.type = LightType::Point;
    tiny.addLight(light, translation(Vec3(0.3f, -0.5f, 0.2f)));
    tiny.scene.environment.constant = Vec3(0.2f);
    return tiny;
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

void expectNear(const Vec3& a, const Vec3& b, float tolerance, size_t lane) {
    EXPECT_LT(maxComponent(glm::abs(a - b)), tolerance * (1 + maxComponent(glm::abs(b)))) << lane;
}

/// Batches are sampled by kernels, lane by lane what samplePoint() gives: every kind of light, each side of triangles.
/// And the same bytes on every instruction set.
TEST(Lights, LanesSampleAsOneByOne) {
    TinyScene tiny = manyLights();
    Material glow = lambert(0);
    glow.emission = Vec3(1, 2, 3);
    glow.doubleSided = false;
    tiny.add(facetedSphere(0.5f, 8), glow, translation(Vec3(2, 2, 2)));
    Light spot;
    spot.type = LightType::Spot;
    spot.range = 6;
    tiny.addLight(spot, lookAt(Vec3(1, 2, 1), Vec3(0)));
    auto sky = std::make_shared<Image>(Extent2{16, 8}, 3);
    for (size_t i = 0; i < sky->size(); ++i) sky->data()[i] = 0.1f + static_cast<float>(i * 7 % 13);
    tiny.scene.environment.image = sky;
    tiny.scene.environment.rotateDeg = 40;
    TraceScene scene;
    bindTo(scene, tiny.pose());

    const auto lanes = std::make_unique<PlainLanes>(), plain = std::make_unique<PlainLanes>();
    const auto lights = std::make_unique<LightLanes>();
    std::vector<LightReceiver> receivers(PlainLanes::kMost);
    std::vector<Lights::Choice> choices(PlainLanes::kMost);
    Numbers numbers(11);
    size_t reached = 0;
    for (uint32_t first = 0; first < scene.lights.count(); first += PlainLanes::kMost) {
        lanes->count = PlainLanes::kMost;
        for (uint32_t i = 0; i < PlainLanes::kMost; ++i) {
            const Vec3 place = (Vec3(numbers.one(), numbers.one(), numbers.one()) - Vec3(0.5f)) * 6.0f;
            receivers[i] = {place, sampleSphere(numbers.two()), 0, LightReceiver::Facing::Front, LightSampling::Tree};
            // The last entries are those without a triangle.
            const uint32_t entry =
                i % 2 == 0 ? first + i : static_cast<uint32_t>(scene.lights.count()) - 1 - i % 15 / 2;
            choices[i] = {entry % static_cast<uint32_t>(scene.lights.count()), 0.3f};
            lanes->position.set(static_cast<int>(i), place);
            lanes->lightPointX[i] = numbers.one(), lanes->lightPointY[i] = numbers.one();
        }
        const Isa best = activeIsa();
        for (const Isa isa : {Isa::Baseline, Isa::V3, Isa::V4}) {
            if (isa > best) continue;
            setIsa(isa);
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
                EXPECT_EQ(lanes->lightDistance[i], kInfinity) << i;
            } else {
                EXPECT_NEAR(lanes->lightDistance[i] / one.distance, 1, 1e-5) << i;
                expectNear(lanes->lightTarget.get<Vec3>(lane), one.target, 1e-5f, i);
            }
        }
    }
    EXPECT_GT(reached, scene.lights.count() / 2);
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
