// Directions that light samples take, a kind of light at a time: they fall as the densities of hits say (chi-square).
#include <gtest/gtest.h>

#include "math/hash.h"
#include "support/texel_picture.h"
#include "support/transport_scene.h"
#include "trace/surface.h"
#include "trace/trace_scene.h"

namespace lumi {
namespace {

using namespace test;

Vec2 numbers(uint32_t sequence, uint32_t i) {
    return {unitFloat(hashCombine(sequence, 2 * i)), unitFloat(hashCombine(sequence, 2 * i + 1))};
}

/// Bright, dark and black squares.
Texture picture() {
    std::vector<Vec3> squares;
    for (const float value : {1.0f, 0.3f, 0.0f, 2.0f, 0.5f, 1.5f, 0.2f, 1.0f}) squares.emplace_back(value);
    return texelPicture({4, 2}, squares);
}

void addFlat(TinyScene& tiny, LightType type, bool textured, float slant = 0) {
    Light light;
    light.type = type;
    light.size = Vec2(1.6f, 1.1f), light.radius = 0.8f;
    if (textured) light.radianceTexture = picture();
    Mat4 shear(1);
    shear[1].x = slant;
    tiny.addLight(light, lookAt(Vec3(0.6f, 0.9f, 0.3f), Vec3(0), Vec3(0, 0, 1)) * shear);
}

Material glow(bool textured, bool bothSides) {
    Material material = lambert(0);
    material.emission = Vec3(2);
    material.doubleSided = bothSides;
    if (textured) material.emissionTexture = picture();
    return material;
}

struct Kind {
    const char* name;
    void (*add)(TinyScene&);
};

const Kind kKinds[] = {
    {"Rectangle", [](TinyScene& tiny) { addFlat(tiny, LightType::Rectangle, false); }},
    {"TexturedRectangle", [](TinyScene& tiny) { addFlat(tiny, LightType::Rectangle, true); }},
    {"TexturedSlantedRectangle", [](TinyScene& tiny) { addFlat(tiny, LightType::Rectangle, true, 0.5f); }},
    {"Disk", [](TinyScene& tiny) { addFlat(tiny, LightType::Disk, false); }},
    {"TexturedDisk", [](TinyScene& tiny) { addFlat(tiny, LightType::Disk, true); }},
    {"Sphere",
     [](TinyScene& tiny) {
         Light light;
         light.type = LightType::Sphere;
         light.radius = 0.7f;
         tiny.addLight(light, translation(Vec3(0.4f, 1, -0.3f)));
     }},
    {"Mesh",
     [](TinyScene& tiny) { tiny.add(facetedSphere(0.6f, 12), glow(false, false), translation(Vec3(0.3f, 1, 0.4f))); }},
    {"MirroredTexturedMesh",
     [](TinyScene& tiny) {
         tiny.add(sphereMesh(0.6f, 16, 8), glow(true, false),
                  translation(Vec3(0.3f, 1, 0.4f)) * scaling(Vec3(-1, 1.2f, 0.8f)));
     }},
    {"SheetOfBothSides",
     [](TinyScene& tiny) {
         tiny.add(rectangleMesh(1.5f, 1.5f, Facing::Y, 3, 3), glow(false, true), translation(Vec3(0.2f, 0.8f, 0)));
     }},
    {"TurnedSky",
     [](TinyScene& tiny) {
         auto sky = std::make_shared<Image>(Extent2{16, 8}, 3);
         for (int y = 0; y < 8; ++y)
             for (int x = 0; x < 16; ++x)
                 for (int c = 0; c < 3; ++c) sky->at(c, x, y) = 0.2f + 0.1f * static_cast<float>((3 * x + 5 * y) % 11);
         tiny.scene.environment.image = sky;
         tiny.scene.environment.rotateDeg = 55;
     }},
    {"SunBesideSky",
     [](TinyScene& tiny) {
         Light sun;
         sun.type = LightType::Directional;
         sun.angleDeg = 50;
         tiny.addLight(sun, lookAt(Vec3(1, 2, 1), Vec3(0)));
         tiny.scene.environment.constant = Vec3(0.2f);
     }},
};

/// Cells of equal solid angle.
constexpr int kRings = 12, kSectors = 24, kCells = kRings * kSectors;

Vec3 directionIn(float ring, float sector) {
    const float z = 1 - 2 * ring / kRings, phi = 2 * kPi * sector / kSectors, r = std::sqrt(std::max(0.0f, 1 - z * z));
    return {r * std::cos(phi), r * std::sin(phi), z};
}

size_t cellOf(const Vec3& direction) {
    const float turn = std::atan2(direction.y, direction.x) / (2 * kPi);
    const int ring = std::clamp(static_cast<int>((1 - direction.z) / 2 * kRings), 0, kRings - 1);
    const int sector = std::clamp(static_cast<int>((turn < 0 ? turn + 1 : turn) * kSectors), 0, kSectors - 1);
    return static_cast<size_t>(ring * kSectors + sector);
}

/// Density of light samples along `direction`: of every surface there that shines towards the receiver, and of the sky.
double densityAlong(const TraceScene& scene, const LightReceiver& receiver, const Vec3& direction) {
    double density = 0;
    BatchRay ray;
    ray.origin = receiver.position, ray.direction = direction;
    for (int pass = 0; pass < 4; ++pass) {
        RawHit hit;
        intersectRays(scene.embree, {&ray, 1}, {&hit, 1}, Coherence::Incoherent);
        if (!hit.valid()) break;
        const SurfacePoint point = surfacePoint(scene.tables, hit, ray.origin + direction * hit.distance, 0);
        const Surface s = evaluateSurface(scene.tables, point, -direction, 0);
        if (!isBlack(s.emitted))
            density += s.body >= 0 ? scene.lights.pdfBody(s.body, receiver, direction, s.position)
                                   : scene.lights.pdfTriangle(point.instance, point.primitive, receiver, direction,
                                                              s.position, s.outwardNormal);
        ray.origin = offsetOrigin(s.position, -s.geometricNormal, s.offset + 1e-3f);
    }
    scene.lights.escaped(direction, 0, false, &receiver, [&](float pdf) {
        density += pdf;
        return 1.0f;
    });
    return density;
}

class LightDirections : public testing::TestWithParam<Kind> {};
INSTANTIATE_TEST_SUITE_P(Kinds, LightDirections, testing::ValuesIn(kKinds),
                         [](const auto& kind) { return std::string(kind.param.name); });

TEST_P(LightDirections, FallAsTheirDensitySays) {
    constexpr uint32_t kSamples = 30000;
    constexpr int kInner = 48;  // points of quadrature along each side of a cell
    TinyScene tiny;
    GetParam().add(tiny);
    TraceScene scene;
    scene.posed = tiny.pose();
    scene.embree.bind(*scene.posed);
    scene.tables = makeSceneTables(*scene.posed, scene.embree);
    scene.lights.build(*scene.posed, scene.tables);
    const LightReceiver receiver{Vec3(0), glm::normalize(Vec3(0.1f, 1, 0.2f)), 0, LightReceiver::Facing::Front,
                                 LightSampling::Tree};

    std::vector<double> observed(kCells + 1, 0), expected(kCells + 1, 0);
    for (uint32_t i = 0; i < kSamples; ++i) {
        LightSample light;
        const bool good = scene.lights.sample(receiver, numbers(1, i), numbers(2, i), light);
        ++observed[good ? cellOf(light.direction) : size_t(kCells)];
    }
    double whole = 0;
    for (int ring = 0; ring < kRings * kInner; ++ring)
        for (int sector = 0; sector < kSectors * kInner; ++sector) {
            const Vec3 direction =
                directionIn((static_cast<float>(ring) + 0.5f) / kInner, (static_cast<float>(sector) + 0.5f) / kInner);
            const double share = densityAlong(scene, receiver, direction) * 4 * kPi / (kCells * kInner * kInner);
            expected[static_cast<size_t>(ring / kInner * kSectors + sector / kInner)] += share * kSamples;
            whole += share;
        }
    EXPECT_LT(whole, 1.005);
    EXPECT_GT(whole, 0.4);
    expected.back() = std::max(1 - whole, 1e-4) * kSamples;
    // Quadrature may miss the corner of a cell that the edge of a light cuts.
    for (double& count : expected) count = std::max(count, 0.05);
    EXPECT_GT(chiSquareTest(observed, expected), sidakLevel(0.01, std::size(kKinds)));
}

}  // namespace
}  // namespace lumi
