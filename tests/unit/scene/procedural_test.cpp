#include "scene/procedural/procedural.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <tuple>

#include "base/error.h"
#include "base/parallel.h"
#include "scene/light_body.h"
#include "scene/procedural/mesh_builder.h"
#include "scene/procedural/primitives.h"

namespace lumi::test {
namespace {

Vec3 faceVector(const Mesh& mesh, const UVec3& t) {
    return glm::cross(mesh.positions[t.y] - mesh.positions[t.x], mesh.positions[t.z] - mesh.positions[t.x]);
}

double areaOf(const Mesh& mesh) {
    double area = 0;
    for (const UVec3& t : mesh.triangles) area += 0.5 * glm::length(faceVector(mesh, t));
    return area;
}

/// Volume inside a closed mesh; positive when its fronts are outside.
double volumeOf(const Mesh& mesh) {
    double volume = 0;
    for (const UVec3& t : mesh.triangles)
        volume += glm::dot(mesh.positions[t.x], glm::cross(mesh.positions[t.y], mesh.positions[t.z])) / 6.0;
    return volume;
}

using Point = std::tuple<float, float, float>;
Point pointOf(const Vec3& p) { return {p.x + 0.0f, p.y + 0.0f, p.z + 0.0f}; }

/// Edges, by the bits of their ends, that no neighbour runs along in the other direction.
size_t openEdges(const Mesh& mesh) {
    std::map<std::pair<Point, Point>, int> edges;
    for (const UVec3& t : mesh.triangles)
        for (int i = 0; i < 3; ++i) {
            const Point a = pointOf(mesh.positions[t[i]]), b = pointOf(mesh.positions[t[(i + 1) % 3]]);
            a < b ? ++edges[{a, b}] : --edges[{b, a}];
        }
    size_t open = 0;
    for (const auto& [edge, balance] : edges) open += balance != 0;
    return open;
}

/// Attributes complete, normals unit and on the front's side, no triangle without area.
void expectWellFormed(const Mesh& mesh, const std::string& name) {
    SCOPED_TRACE(name);
    EXPECT_NO_THROW(checkMesh(mesh, name));
    ASSERT_FALSE(mesh.triangles.empty());
    ASSERT_EQ(mesh.normals.size(), mesh.positions.size());
    ASSERT_EQ(mesh.uv[0].size(), mesh.positions.size());
    size_t notUnit = 0, flipped = 0, flat = 0, badUv = 0;
    for (const Vec3& n : mesh.normals) notUnit += !(std::abs(glm::length(n) - 1) < 1e-4f);
    for (const Vec2& uv : mesh.uv[0]) badUv += !(std::isfinite(uv.x) && std::isfinite(uv.y));
    for (const UVec3& t : mesh.triangles) {
        const Vec3 face = faceVector(mesh, t);
        flat += glm::length(face) == 0;
        flipped += glm::dot(face, mesh.normals[t.x] + mesh.normals[t.y] + mesh.normals[t.z]) < 0;
    }
    EXPECT_EQ(notUnit, 0u);
    EXPECT_EQ(badUv, 0u);
    EXPECT_EQ(flat, 0u);
    EXPECT_EQ(flipped, 0u);
}

ProceduralResult built(const std::string& name, const std::map<std::string, ParameterValue>& values = {}) {
    const auto generator = makeProcedural(name);
    for (const auto& [id, value] : values)
        setParameter([&](ParameterVisitor& v) { generator->describe(v); }, id, value);
    return generator->build();
}

Mesh builtMesh(const std::string& name, const std::map<std::string, ParameterValue>& values = {}) {
    return *built(name, values).parts.at(0).mesh;
}

TEST(Procedural, TheCatalogHasUniqueNamesAndHelp) {
    std::set<std::string> names;
    for (const ProceduralEntry& entry : proceduralCatalog()) {
        EXPECT_TRUE(names.insert(entry.name).second) << entry.name;
        EXPECT_GT(std::string(entry.help).size(), 10u);
        EXPECT_NE(makeProcedural(entry.name), nullptr);
    }
    EXPECT_EQ(makeProcedural("spheer"), nullptr);
    EXPECT_EQ(makeProceduralTexture("chequer"), nullptr);
}

TEST(Procedural, EveryGeneratorIsWellFormedAtItsDefaults) {
    for (const ProceduralEntry& entry : proceduralCatalog()) {
        const ProceduralResult result = entry.make()->build();
        ASSERT_FALSE(result.slots.empty()) << entry.name;
        ASSERT_FALSE(result.parts.empty()) << entry.name;
        for (size_t i = 0; i < result.nodes.size(); ++i) EXPECT_LT(result.nodes[i].parent, static_cast<int>(i));
        for (const ProceduralPart& part : result.parts) {
            expectWellFormed(*part.mesh, std::string(entry.name) + '/' + part.name);
            EXPECT_LT(part.node, static_cast<int>(result.nodes.size())) << entry.name;
            EXPECT_LT(part.skin, static_cast<int>(result.skins.size())) << entry.name;
            for (size_t t = 0; t < part.mesh->triangles.size(); ++t)
                ASSERT_LT(part.mesh->materialOf(static_cast<uint32_t>(t)), result.slots.size()) << entry.name;
        }
    }
}

TEST(Procedural, EveryGeneratorGivesTheSameBytesAgain) {
    for (const ProceduralEntry& entry : proceduralCatalog()) {
        const ProceduralResult a = entry.make()->build(), b = entry.make()->build();
        ASSERT_EQ(a.parts.size(), b.parts.size()) << entry.name;
        for (size_t i = 0; i < a.parts.size(); ++i) {
            EXPECT_TRUE(a.parts[i].mesh->positions == b.parts[i].mesh->positions) << entry.name;
            EXPECT_TRUE(a.parts[i].mesh->triangles == b.parts[i].mesh->triangles) << entry.name;
        }
    }
}

TEST(Procedural, ClosedShapesAreClosed) {
    EXPECT_EQ(openEdges(builtMesh("sphere")), 0u);
    EXPECT_EQ(openEdges(builtMesh("sphere", {{"segments", 3}, {"rings", 2}})), 0u);
    EXPECT_EQ(openEdges(builtMesh("box")), 0u);
    EXPECT_EQ(openEdges(builtMesh("box", {{"width", 0.7f}, {"depth", 3.1f}, {"bevel", 0.1f}})), 0u);
    EXPECT_EQ(openEdges(builtMesh("box", {{"bevel", 0.5f}})), 0u);
    EXPECT_EQ(openEdges(builtMesh("cylinder", {{"segments", 7}})), 0u);
    EXPECT_EQ(openEdges(builtMesh("cone")), 0u);
    EXPECT_EQ(openEdges(builtMesh("cone", {{"top-radius", 0.3f}})), 0u);
    EXPECT_EQ(openEdges(builtMesh("torus", {{"segments", 5}, {"tube-segments", 4}})), 0u);
    EXPECT_EQ(openEdges(builtMesh("hairball", {{"strands", 50}})), 0u);
    EXPECT_EQ(openEdges(builtMesh("cylinder", {{"caps", false}, {"segments", 12}})), 24u);
}

TEST(Procedural, AreasAndVolumesMeetTheirClosedForms) {
    const double r = 0.5, pi = 3.14159265358979;
    EXPECT_NEAR(areaOf(builtMesh("sphere")), 4 * pi * r * r, 2e-3);
    EXPECT_NEAR(volumeOf(builtMesh("sphere")), 4.0 / 3 * pi * r * r * r, 1e-3);
    EXPECT_NEAR(areaOf(builtMesh("box", {{"width", 2.f}, {"height", 3.f}, {"depth", 4.f}})), 52, 1e-4);
    EXPECT_NEAR(volumeOf(builtMesh("box", {{"width", 2.f}, {"height", 3.f}, {"depth", 4.f}})), 24, 1e-4);
    EXPECT_NEAR(volumeOf(builtMesh("cylinder")), pi * r * r, 1e-3);
    EXPECT_NEAR(volumeOf(builtMesh("cone")), pi * r * r / 3, 1e-3);
    EXPECT_NEAR(volumeOf(builtMesh("torus")), 2 * pi * pi * r * 0.04, 2e-3);
    EXPECT_NEAR(areaOf(builtMesh("disk", {{"inner-radius", 0.25f}})), pi * (r * r - 0.0625), 1e-3);
    EXPECT_NEAR(areaOf(builtMesh("rectangle", {{"width", 3.f}, {"height", 2.f}})), 6, 1e-5);
    EXPECT_NEAR(areaOf(builtMesh("plane-grid", {{"columns", 7}, {"rows", 3}})), 100, 1e-3);
    EXPECT_EQ(builtMesh("plane-grid", {{"columns", 7}, {"rows", 3}}).triangles.size(), 42u);
    // Rounded edges take from a cube of side 1 what their radius says: area by the parallel-body formula.
    const double b = 0.25, inner = 1 - 2 * b;
    const double rounded = 6 * inner * inner + 6 * pi * b * inner + 4 * pi * b * b;
    EXPECT_NEAR(areaOf(builtMesh("box", {{"bevel", 0.25f}, {"bevel-segments", 24}})), rounded, 2e-3);
}

TEST(Procedural, SmoothNormalsAreTheSurfaces) {
    const Mesh sphere = builtMesh("sphere");
    for (size_t i = 0; i < sphere.positions.size(); ++i)
        ASSERT_LT(glm::distance(sphere.normals[i], sphere.positions[i] * 2.0f), 1e-5f);
    const Mesh cone = builtMesh("cone");
    // The slope of a cone of radius 0.5 and height 1 gives its side's normals the y component 1/sqrt(5).
    EXPECT_NEAR(cone.normals[0].y, 1 / std::sqrt(5.0f), 1e-5f);
}

TEST(Procedural, FlatShapesFaceWhereTheySay) {
    const std::array<std::pair<const char*, Vec3>, 6> facings{{{"x", {1, 0, 0}},
                                                               {"-x", {-1, 0, 0}},
                                                               {"y", {0, 1, 0}},
                                                               {"-y", {0, -1, 0}},
                                                               {"z", {0, 0, 1}},
                                                               {"-z", {0, 0, -1}}}};
    for (const auto& [name, normal] : facings)
        for (const char* shape : {"rectangle", "disk", "plane-grid"}) {
            const Mesh mesh = builtMesh(shape, {{"facing", std::string(name)}});
            expectWellFormed(mesh, shape);
            EXPECT_EQ(mesh.normals[0], normal) << shape << ' ' << name;
        }
    EXPECT_EQ(builtMesh("rectangle").uv[0][0], Vec2(0, 1));
    EXPECT_EQ(builtMesh("rectangle", {{"width", 3.f}, {"height", 2.f}, {"uv-in-metres", true}}).uv[0][0], Vec2(0, 2));
}

TEST(Procedural, ImpossibleShapesAreRefused) {
    EXPECT_THROW(built("torus", {{"tube-radius", 0.6f}}), Error);
    EXPECT_THROW(built("disk", {{"inner-radius", 0.5f}}), Error);
    EXPECT_THROW(built("box", {{"bevel", 0.6f}}), Error);
}

TEST(Procedural, HairballDependsOnItsSeedAlone) {
    const Mesh one = builtMesh("hairball", {{"strands", 300}});
    EXPECT_EQ(one.positions, builtMesh("hairball", {{"strands", 300}}).positions);
    EXPECT_NE(one.positions, builtMesh("hairball", {{"strands", 300}, {"seed", 2}}).positions);
    for (const Vec3& p : one.positions) ASSERT_LT(glm::length(p), 0.51f);
}

TEST(Procedural, CheckerAlternates) {
    const TextureImage image = makeProceduralTexture("checker")->build();
    const int side = image.levels[0].extent.width;
    const auto red = [&](int x, int y) { return image.levels[0].bytes[static_cast<size_t>(4 * (y * side + x))]; };
    EXPECT_EQ(side, 128);
    EXPECT_NE(red(0, 0), red(16, 0));
    EXPECT_EQ(red(0, 0), red(16, 16));
    EXPECT_EQ(red(15, 15), red(0, 0));
}

TEST(MeshBuilder, MirroredCopiesKeepTheirFrontsOutside) {
    MeshBuilder builder;
    builder.append(boxMesh(Vec3(1)), glm::scale(Mat4(1), Vec3(-2, 1, 3)));
    const Mesh mesh = builder.take();
    EXPECT_NEAR(volumeOf(mesh), 6, 1e-5);
    expectWellFormed(mesh, "mirrored box");
}

TEST(MeshBuilder, SlotsFollowTheTriangles) {
    MeshBuilder builder;
    builder.useSlot(2);
    builder.addPatch({Vec3(0), Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(0, 1, 0)});
    EXPECT_EQ(builder.triangleCount(), 2u);
    Mesh one = builder.take("one");
    EXPECT_TRUE(one.triangleMaterial.empty());
    EXPECT_EQ(one.material, 2u);
    builder.useSlot(0);
    builder.append(one);
    builder.useSlot(1);
    builder.append(one);
    EXPECT_EQ(builder.take().triangleMaterial, (std::vector<uint32_t>{0, 0, 1, 1}));
}

TEST(LightBody, ShapesHaveTheirLightsArea) {
    Light light;
    light.type = LightType::Sphere;
    light.radius = 0.3f;
    EXPECT_NEAR(areaOf(*lightBody(light)), 4 * 3.14159265358979 * 0.09, 1e-6);
    EXPECT_EQ(openEdges(*lightBody(light)), 0u);
    light.type = LightType::Rectangle;
    light.size = {2, 3};
    const auto rectangle = lightBody(light);
    EXPECT_NEAR(areaOf(*rectangle), 6, 1e-6);
    EXPECT_EQ(rectangle->normals[0], Vec3(0, 0, -1)) << "flat lights shine along -Z";
    light.type = LightType::Point;
    EXPECT_EQ(lightBody(light), nullptr);
}

TEST(LightBody, BodiesAreAddedOnceAndFollowTheirLight) {
    Scene scene;
    scene.nodes.emplace_back();
    scene.lights.emplace_back();
    scene.lights[0].type = LightType::Disk;
    scene.lights[0].node = 0;
    addLightBodies(scene);
    addLightBodies(scene);
    ASSERT_EQ(scene.instances.size(), 1u);
    const auto before = scene.instances[0].mesh;
    scene.lights[0].radius = 2;
    addLightBodies(scene);
    ASSERT_EQ(scene.instances.size(), 1u);
    EXPECT_NE(scene.instances[0].mesh, before);
    EXPECT_EQ(scene.materials.size(), 1u);
}

TEST(LightBody, StretchedSpheresKeepTheAreaOfTheirEllipsoid) {
    const auto scaled = [](const Vec3& s) { return sphereScale(glm::scale(Mat4(1), s)); };
    EXPECT_EQ(scaled(Vec3(2)), 2);
    EXPECT_EQ(scaled(Vec3(0)), 0);
    EXPECT_EQ(scaled(Vec3(0, 0, 5)), 0) << "a needle has no area";
    // A prolate and an oblate spheroid of axes 3 and 1, and both sides of a disk.
    const double e = std::sqrt(8.0) / 3;
    const double prolate = 0.5 * (1 + 3 / e * std::asin(e)), oblate = 0.5 * (9 + std::atanh(e) / e);
    EXPECT_NEAR(scaled({3, 1, 1}), std::sqrt(prolate), 0.006 * std::sqrt(prolate));
    EXPECT_NEAR(scaled({3, 1, 3}), std::sqrt(oblate), 0.006 * std::sqrt(oblate));
    EXPECT_NEAR(scaled({1, 1, 0}), std::sqrt(0.5), 0.006);
}

TEST(LightBody, LightsOfOneSizeShareTheirs) {
    Scene scene;
    scene.nodes.emplace_back();
    Light ball;
    ball.type = LightType::Sphere;
    ball.node = 0;
    scene.lights.assign(3, ball);
    scene.lights[1].radius = 2 * ball.radius;
    for (int time = 0; time < 2; ++time) {
        addLightBodies(scene);
        ASSERT_EQ(scene.instances.size(), 3u);
        EXPECT_EQ(scene.instances[0].mesh, scene.instances[2].mesh);
        EXPECT_NE(scene.instances[0].mesh, scene.instances[1].mesh);
    }
}

}  // namespace
}  // namespace lumi::test
