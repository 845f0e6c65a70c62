// Each light over a Lambertian plane, against the irradiance that a textbook gives.
#include <gtest/gtest.h>

#include "support/transport_scene.h"

namespace lumi {
namespace {

using namespace test;

constexpr float kAlbedo = 0.8f;
constexpr double kMostSigmas = 4.5;

/// Looks down at the origin of a floor that is lit by the scene's lights.
Estimate seenOnFloor(TinyScene tiny, int count, DirectStrategy strategy) {
    tiny.add(floorMesh(), lambert(kAlbedo));
    Tracer tracer;
    tracer.bind(tiny.pose());
    // From the side and below every light.
    return radianceAlong(tracer, Vec3(0.6f, 0.3f, 0.2f), Vec3(-0.6f, -0.3f, -0.2f), count, plainPaths(1, strategy));
}

Estimate seenOnFloor(const Light& light, const Mat4& worldFromLight, int count, DirectStrategy strategy) {
    TinyScene tiny;
    tiny.addLight(light, worldFromLight);
    return seenOnFloor(tiny, count, strategy);
}

Mat4 lightAt(const Vec3& position, const Vec3& target) { return lookAt(position, target, Vec3(0, 0, 1)); }

class ClosedForms : public testing::TestWithParam<DirectStrategy> {};

TEST_P(ClosedForms, SphereLight) {
    Light light;
    light.type = LightType::Sphere;
    light.radius = 0.5f;
    light.radiance = Vec3(3);
    const Vec3 centre(0.7f, 1.5f, 0);
    // pi L sin^2(half angle) cos(to the centre): the cosine integral over a cone above the horizon.
    const double d2 = glm::dot(centre, centre);
    const double expected = kAlbedo * 3 * (0.25 / d2) * (1.5 / std::sqrt(d2));
    const Estimate e = seenOnFloor(light, lightAt(centre, Vec3(0)), 60000, GetParam());
    EXPECT_LT(e.z(expected), kMostSigmas) << e.mean << " against " << expected;
    if (GetParam() != DirectStrategy::Bsdf) {
        EXPECT_LT(e.standardError, 2e-3 * expected);
    }
}

TEST_P(ClosedForms, RectangleLight) {
    Light light;
    light.type = LightType::Rectangle;
    light.size = Vec2(1.2f, 0.8f);
    light.radiance = Vec3(2);
    // Four corners of form factor from an element to a parallel rectangle above one of its corners.
    const double x = 0.6 / 1.0, y = 0.4 / 1.0;
    const double corner = (x / std::sqrt(1 + x * x) * std::atan(y / std::sqrt(1 + x * x)) +
                           y / std::sqrt(1 + y * y) * std::atan(x / std::sqrt(1 + y * y))) /
                          (2 * kPi);
    const double expected = kAlbedo * 2 * 4 * corner;
    const Estimate e = seenOnFloor(light, lightAt(Vec3(0, 1, 0), Vec3(0)), 60000, GetParam());
    EXPECT_LT(e.z(expected), kMostSigmas) << e.mean << " against " << expected;
}

TEST(SmallFarRectangleLight, IsAPointToTheFloor) {
    Light light;
    light.type = LightType::Rectangle;
    light.size = Vec2(0.02f, 0.02f);
    light.radiance = Vec3(1e4f);
    const double expected = kAlbedo * 1e4 * 0.0004 / (kPi * 4);
    for (const auto strategy : {DirectStrategy::Mis, DirectStrategy::Light}) {
        const Estimate e = seenOnFloor(light, lightAt(Vec3(0, 2, 0), Vec3(0)), 40000, strategy);
        EXPECT_LT(std::abs(e.mean - expected), kMostSigmas * e.standardError + 1e-4 * expected);
    }
}

TEST_P(ClosedForms, DiskLight) {
    Light light;
    light.type = LightType::Disk;
    light.radius = 0.5f;
    light.radiance = Vec3(2);
    const double expected = kAlbedo * 2 * 0.25 / (0.25 + 1);
    const Estimate e = seenOnFloor(light, lightAt(Vec3(0, 1, 0), Vec3(0)), 60000, GetParam());
    EXPECT_LT(e.z(expected), kMostSigmas) << e.mean << " against " << expected;
}

/// An ellipse of radii a, b above the origin at height h, facing it: its form factor is a b / sqrt((a^2 + h^2)(b^2 +
/// h^2)), that of its cone's quadric. By scale and by shear.
TEST_P(ClosedForms, EllipticDiskLight) {
    Light light;
    light.type = LightType::Disk;
    light.radius = 0.5f;
    light.radiance = Vec3(2);
    const Mat4 frame = lightAt(Vec3(0, 1, 0), Vec3(0));
    const auto expected = [](double a, double b) { return kAlbedo * 2 * a * b / std::sqrt((a * a + 1) * (b * b + 1)); };
    const Estimate wide = seenOnFloor(light, frame * scaling(Vec3(3, 1, 1)), 60000, GetParam());
    EXPECT_LT(wide.z(expected(1.5, 0.5)), kMostSigmas) << wide.mean << " against " << expected(1.5, 0.5);
    // A shear by 1 has the singular values (sqrt(5) +- 1) / 2.
    Mat4 shear(1);
    shear[1].x = 1;
    const double golden = (std::sqrt(5.0) + 1) / 2;
    const Estimate sheared = seenOnFloor(light, frame * shear, 60000, GetParam());
    EXPECT_LT(sheared.z(expected(0.5 * golden, 0.5 / golden)), kMostSigmas) << sheared.mean;
}

TEST_P(ClosedForms, DirectionalLightOfTenDegrees) {
    Light light;
    light.type = LightType::Directional;
    light.angleDeg = 10;
    light.irradiance = Vec3(5);
    const Vec3 from(0.5f, 1, 0.2f);
    const double expected = kAlbedo / kPi * 5 * glm::normalize(from).y;
    const Estimate e = seenOnFloor(light, lightAt(from, Vec3(0)), 60000, GetParam());
    EXPECT_LT(e.z(expected), kMostSigmas) << e.mean << " against " << expected;
}

TEST_P(ClosedForms, EmissiveTriangles) {
    // A mesh rectangle must do what the rectangle light does.
    TinyScene tiny;
    tiny.add(floorMesh(), lambert(kAlbedo));
    Material glowing = lambert(0);
    glowing.emission = Vec3(2);
    glowing.doubleSided = false;
    tiny.add(rectangleMesh(1.2f, 0.8f, Facing::MinusY), glowing, translation(Vec3(0, 1, 0)));
    Tracer tracer;
    tracer.bind(tiny.pose());
    const double x = 0.6, y = 0.4;
    const double corner = (x / std::sqrt(1 + x * x) * std::atan(y / std::sqrt(1 + x * x)) +
                           y / std::sqrt(1 + y * y) * std::atan(x / std::sqrt(1 + y * y))) /
                          (2 * kPi);
    const double expected = kAlbedo * 2 * 4 * corner;
    const Estimate e =
        radianceAlong(tracer, Vec3(0.6f, 0.3f, 0.2f), Vec3(-0.6f, -0.3f, -0.2f), 60000, plainPaths(1, GetParam()));
    EXPECT_LT(e.z(expected), kMostSigmas) << e.mean << " against " << expected;
}

TEST_P(ClosedForms, ConstantEnvironment) {
    TinyScene tiny;
    tiny.add(floorMesh(), lambert(kAlbedo));
    tiny.scene.environment.constant = Vec3(1.5f);
    Tracer tracer;
    tracer.bind(tiny.pose());
    const Estimate e =
        radianceAlong(tracer, Vec3(0.6f, 0.3f, 0.2f), Vec3(-0.6f, -0.3f, -0.2f), 40000, plainPaths(1, GetParam()));
    EXPECT_LT(e.z(kAlbedo * 1.5), kMostSigmas) << e.mean;
}

std::string strategyName(const testing::TestParamInfo<DirectStrategy>& instance) {
    if (instance.param == DirectStrategy::Mis) return "mis";
    return instance.param == DirectStrategy::Light ? "light" : "bsdf";
}

INSTANTIATE_TEST_SUITE_P(, ClosedForms,
                         testing::Values(DirectStrategy::Mis, DirectStrategy::Light, DirectStrategy::Bsdf),
                         strategyName);

TEST(PointLight, InverseSquareAndCosine) {
    Light light;
    light.type = LightType::Point;
    light.intensity = Vec3(6);
    for (const Vec3 position : {Vec3(0, 1, 0), Vec3(0, 2, 0), Vec3(1, 1, 0.5f), Vec3(-3, 0.5f, 2)}) {
        const double d2 = glm::dot(position, position);
        const double expected = kAlbedo / kPi * 6 / d2 * position.y / std::sqrt(d2);
        const Estimate e = seenOnFloor(light, translation(position), 4, DirectStrategy::Mis);
        EXPECT_NEAR(e.mean, expected, 2e-5 * expected);
        EXPECT_NEAR(seenOnFloor(light, translation(position), 4, DirectStrategy::Bsdf).mean, expected, 2e-5 * expected);
    }
}

TEST(PointLight, RangeWindowEndsTheLight) {
    Light light;
    light.type = LightType::Point;
    light.intensity = Vec3(6);
    light.range = 2;
    const double at1 = kAlbedo / kPi * 6 * (1 - 1.0 / 16);
    EXPECT_NEAR(seenOnFloor(light, translation(Vec3(0, 1, 0)), 4, DirectStrategy::Mis).mean, at1, 1e-4 * at1);
    EXPECT_EQ(seenOnFloor(light, translation(Vec3(0, 2.5f, 0)), 4, DirectStrategy::Mis).mean, 0);
}

TEST(SpotLight, ConesAndTheirEdge) {
    Light light;
    light.type = LightType::Spot;
    light.intensity = Vec3(4);
    light.innerConeDeg = 20, light.outerConeDeg = 40;
    const double full = kAlbedo / kPi * 4;
    const auto seen = [&](float offAxisDeg) {
        // One metre above the origin, turned away from it about z.
        const Mat4 turn = glm::mat4_cast(glm::angleAxis(radians(offAxisDeg), Vec3(0, 0, 1)));
        const Mat4 frame = translation(Vec3(0, 1, 0)) * turn * lookAt(Vec3(0), Vec3(0, -1, 0), Vec3(0, 0, 1));
        return seenOnFloor(light, frame, 4, DirectStrategy::Mis).mean;
    };
    EXPECT_NEAR(seen(0), full, 1e-4 * full);
    EXPECT_NEAR(seen(19), full, 1e-4 * full);
    EXPECT_EQ(seen(41), 0);
    const double share = (std::cos(kPi / 6) - std::cos(kPi * 2 / 9)) / (std::cos(kPi / 9) - std::cos(kPi * 2 / 9));
    EXPECT_NEAR(seen(30), full * share * share, 1e-3 * full);
}

/// A sun without extent, where it stands in these tests, and what the floor shows of it.
constexpr float kSunIrradiance = 3;
Light deltaSun(float irradiance = kSunIrradiance) {
    Light light;
    light.type = LightType::Directional;
    light.irradiance = Vec3(irradiance);
    return light;
}
const Vec3 kSunFrom(0.5f, 1, 0.2f);
double seenOfSunFrom(const Vec3& from) { return kAlbedo / kPi * kSunIrradiance * glm::normalize(from).y; }

TEST(DirectionalLight, DeltaGivesItsIrradiance) {
    const double expected = seenOfSunFrom(kSunFrom);
    EXPECT_NEAR(seenOnFloor(deltaSun(), lightAt(kSunFrom, Vec3(0)), 4, DirectStrategy::Mis).mean, expected,
                1e-5 * expected);
}

/// A node at `position` that turns the light to the origin, scaled by `scale`.
void addScaledLight(TinyScene& tiny, Light light, const Vec3& position, const Vec3& scale) {
    Node node;
    node.local.translation = position;
    node.local.rotation = glm::normalize(glm::quat_cast(Mat3(lightAt(position, Vec3(0)))));
    node.local.scale = scale;
    light.node = static_cast<int>(tiny.scene.nodes.size());
    tiny.scene.nodes.push_back(node);
    tiny.scene.lights.push_back(light);
}

const Vec3 kVanishingScales[] = {Vec3(0),       Vec3(1e-20f),  Vec3(1e-30f), Vec3(1e-42f),
                                 Vec3(1, 1, 0), Vec3(0, 1, 1), Vec3(0, 0, 1)};

TEST(DirectionalLight, ScaleChangesNeitherItNorTheOthers) {
    const Vec3 scaledFrom(-0.3f, 0.8f, 0.4f);
    const double both = seenOfSunFrom(kSunFrom) + seenOfSunFrom(scaledFrom);
    for (const Vec3& scale : kVanishingScales) {
        TinyScene tiny;
        tiny.addLight(deltaSun(), lightAt(kSunFrom, Vec3(0)));
        addScaledLight(tiny, deltaSun(), scaledFrom, scale);
        const Estimate e = seenOnFloor(tiny, 60000, DirectStrategy::Mis);
        EXPECT_LT(e.z(both), kMostSigmas) << e.mean << " against " << both << " by " << scale.x << ' ' << scale.z;
    }
}

TEST(DirectionalLight, UnderAParentOfScaleZeroTurnsAsItsNodes) {
    TinyScene tiny;
    addScaledLight(tiny, deltaSun(), kSunFrom, Vec3(1));
    Node parent;
    parent.local.scale = Vec3(0);
    tiny.scene.nodes = {parent, tiny.scene.nodes[0]};
    tiny.scene.nodes[1].parent = 0;
    tiny.scene.lights[0].node = 1;
    const double expected = seenOfSunFrom(kSunFrom);
    EXPECT_NEAR(seenOnFloor(tiny, 4, DirectStrategy::Mis).mean, expected, 1e-5 * expected);
}

/// Of a matrix of zeros nothing is known of where the light looks; the other one must not care.
TEST(DirectionalLight, WithoutAFrameLeavesTheOthersAlone) {
    TinyScene tiny;
    tiny.addLight(deltaSun(), lightAt(kSunFrom, Vec3(0)));
    tiny.addLight(deltaSun(), scaling(Vec3(0)));  // seen from the floor, on its horizon
    const double expected = seenOfSunFrom(kSunFrom);
    const Estimate e = seenOnFloor(tiny, 4000, DirectStrategy::Mis);
    EXPECT_LT(e.z(expected), kMostSigmas) << e.mean << " against " << expected;
}

TEST(DirectionalLight, OfNoFiniteStrengthLeavesTheOthersAlone) {
    TinyScene tiny;
    tiny.addLight(deltaSun(), lightAt(kSunFrom, Vec3(0)));
    for (const float strength : {kInfinity, std::nanf("")})
        tiny.addLight(deltaSun(strength), lightAt(Vec3(0, 1, 0), Vec3(0)));
    const double expected = seenOfSunFrom(kSunFrom);
    EXPECT_NEAR(seenOnFloor(tiny, 4, DirectStrategy::Mis).mean, expected, 1e-5 * expected);
}

TEST(SpotLight, TakesNoScale) {
    Light light;
    light.type = LightType::Spot;
    light.intensity = Vec3(4);
    light.innerConeDeg = 20, light.outerConeDeg = 40;
    for (const Vec3& scale : kVanishingScales) {
        TinyScene tiny;
        addScaledLight(tiny, light, Vec3(0, 1, 0), scale);
        EXPECT_NEAR(seenOnFloor(tiny, 4, DirectStrategy::Mis).mean, kAlbedo / kPi * 4, 1e-4)
            << scale.x << ' ' << scale.z;
    }
}

TEST(LightsWithABody, OfScaleZeroAreDarkAndLeaveTheOthersAlone) {
    Light light;
    light.radiance = Vec3(2), light.intensity = Vec3(6);
    TinyScene tiny;
    for (const LightType type : {LightType::Rectangle, LightType::Disk, LightType::Sphere}) {
        light.type = type;
        for (const Vec3& scale : {Vec3(0), Vec3(1e-30f), Vec3(0, 0, 1)})
            addScaledLight(tiny, light, Vec3(0.2f, 1, 0.3f), scale);
    }
    light.type = LightType::Point;
    tiny.addLight(light, translation(Vec3(0, 1, 0)));
    const Estimate e = seenOnFloor(tiny, 20000, DirectStrategy::Mis);
    EXPECT_LT(e.z(kAlbedo / kPi * 6), kMostSigmas) << e.mean;
}

TEST(FlatLights, AreBlackFromBehindAndBlock) {
    TinyScene tiny;
    tiny.add(floorMesh(), lambert(kAlbedo));
    Light light;
    light.type = LightType::Rectangle;
    tiny.addLight(light, lookAt(Vec3(0, 1, 0), Vec3(0, 2, 0), Vec3(0, 0, 1)));  // shines upwards
    Tracer tracer;
    tracer.bind(tiny.pose());
    EXPECT_EQ(radianceAlong(tracer, Vec3(0, 0.5f, 0), Vec3(0, 1, 0), 4, plainPaths(1)).mean, 0);
    EXPECT_EQ(radianceAlong(tracer, Vec3(0, 2, 0), Vec3(0, -1, 0), 4, plainPaths(1)).mean, 1);
}

}  // namespace
}  // namespace lumi
