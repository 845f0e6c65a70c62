#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <tuple>

#include "scene/load.h"
#include "scene/posed_scene.h"
#include "scene/procedural/mesh_tools.h"
#include "scene/procedural/procedural.h"

namespace lumi::test {
namespace {

using Point = std::tuple<float, float, float>;

/// Edges that are not shared by exactly two triangles, running in opposite directions, once equal positions are welded.
size_t openEdges(const Mesh& mesh, const std::set<uint32_t>& slots = {}) {
    std::map<std::pair<Point, Point>, std::pair<int, int>> edges;
    const auto pointOf = [](const Vec3& p) { return Point{p.x + 0.0f, p.y + 0.0f, p.z + 0.0f}; };
    for (size_t t = 0; t < mesh.triangles.size(); ++t) {
        if (!slots.empty() && !slots.contains(mesh.materialOf(static_cast<uint32_t>(t)))) continue;
        for (int i = 0; i < 3; ++i) {
            const Point a = pointOf(mesh.positions[mesh.triangles[t][i]]);
            const Point b = pointOf(mesh.positions[mesh.triangles[t][(i + 1) % 3]]);
            if (a < b) ++edges[{a, b}].first;
            else ++edges[{b, a}].second;
        }
    }
    size_t open = 0;
    for (const auto& [edge, uses] : edges) open += uses.first != 1 || uses.second != 1;
    return open;
}

double volumeOf(const Mesh& mesh) {
    double volume = 0;
    for (const UVec3& t : mesh.triangles)
        volume += glm::dot(mesh.positions[t.x], glm::cross(mesh.positions[t.y], mesh.positions[t.z])) / 6.0;
    return volume;
}

ProceduralResult built(const std::string& name, const std::map<std::string, ParameterValue>& values = {}) {
    const auto generator = makeProcedural(name);
    EXPECT_NE(generator, nullptr) << name;
    for (const auto& [id, value] : values)
        setParameter([&](ParameterVisitor& v) { generator->describe(v); }, id, value);
    return generator->build();
}

int64_t triangleCount(const ProceduralResult& result) {
    int64_t count = 0;
    for (const ProceduralPart& part : result.parts) count += static_cast<int64_t>(part.mesh->triangles.size());
    return count;
}

TEST(MeshTools, ShapesCalledClosedAreClosedAndFaceOutwards) {
    const Mesh rounded = roundedBox({0.4f, 0.2f, 0.3f}, 0.03f, 3);
    EXPECT_EQ(openEdges(rounded), 0u);
    EXPECT_GT(volumeOf(rounded), 0.4 * 0.2 * 0.3 * 0.93);
    EXPECT_LT(volumeOf(rounded), 0.4 * 0.2 * 0.3);
    const Mesh rod = tube({Vec3(0), Vec3(0, 1, 0.3f), Vec3(0.4f, 1.5f, 0)}, {0.1f, 0.1f, 0.05f}, 16);
    EXPECT_EQ(openEdges(rod), 0u);
    EXPECT_GT(volumeOf(rod), 0.02);
    const Mesh prism = extrude({{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}, {0, 0}, 0.5f, 0.05f);
    EXPECT_EQ(openEdges(prism), 0u);
    EXPECT_NEAR(volumeOf(prism), 2.0, 0.05);
}

TEST(MeshTools, ATurnedCylinderHasItsVolume) {
    const Mesh mesh = lathe({{0, 0}, {0.5f, 0, true}, {0.5f, 2, true}, {0, 2}}, 256);
    EXPECT_EQ(openEdges(mesh), 0u);
    EXPECT_NEAR(volumeOf(mesh), 0.25 * 3.14159265 * 2, 1e-3);
}

TEST(MeshTools, AppendingThroughAMirrorKeepsFrontsOutside) {
    Mesh mesh;
    append(mesh, roundedBox({1, 1, 1}, 0.1f), 3, placed({2, 0, 0}, {10, 20, 30}, {-1, 2, 1}));
    EXPECT_GT(volumeOf(mesh), 1.8);
    EXPECT_EQ(mesh.triangleMaterial.front(), 3u);
}

TEST(Generators, FewTrianglesAreNearlyFlatAndSlotsExist) {
    for (const ProceduralEntry& entry : proceduralCatalog()) {
        SCOPED_TRACE(entry.name);
        const ProceduralResult result = entry.make()->build();
        size_t thin = 0, total = 0;
        for (const ProceduralPart& part : result.parts) {
            const Mesh& mesh = *part.mesh;
            for (uint32_t t = 0; t < mesh.triangles.size(); ++t) {
                ASSERT_LT(mesh.materialOf(t), result.slots.size());
                const UVec3 v = mesh.triangles[t];
                const Vec3 a = mesh.positions[v.x], b = mesh.positions[v.y], c = mesh.positions[v.z];
                const float longest = glm::max(glm::length(b - a), glm::max(glm::length(c - b), glm::length(a - c)));
                thin += glm::length(glm::cross(b - a, c - a)) < 1e-4f * longest * longest;
                ++total;
            }
        }
        EXPECT_LE(thin * 200, total) << thin << " of " << total;
    }
}

TEST(Generators, GlassAndLiquidsAreClosedSolids) {
    for (const char* kind : {"wine", "tumbler", "flute"})
        for (const ProceduralPart& part : built("drinking-glass", {{"kind", std::string(kind)}}).parts) {
            EXPECT_EQ(openEdges(*part.mesh), 0u) << kind << " " << part.name;
            EXPECT_GT(volumeOf(*part.mesh), 0) << kind << " " << part.name;
        }
    for (const ProceduralPart& part : built("wine-bottle").parts) {
        if (part.name == "label") continue;
        EXPECT_EQ(openEdges(*part.mesh), 0u) << part.name;
        EXPECT_GT(volumeOf(*part.mesh), 0) << part.name;
    }
    for (const char* kind : {"vase", "bottle", "bowl", "urn", "plate", "candlestick", "cup", "pot"})
        EXPECT_EQ(openEdges(*built("vessel", {{"kind", std::string(kind)}}).parts.at(0).mesh), 0u) << kind;
}

TEST(Generators, WineStaysInsideItsGlass) {
    const ProceduralResult result = built("drinking-glass", {{"fill", 0.4f}});
    ASSERT_EQ(result.parts.size(), 2u);
    Bounds3 glass, wine;
    for (const Vec3& p : result.parts[0].mesh->positions) glass.extend(p);
    for (const Vec3& p : result.parts[1].mesh->positions) wine.extend(p);
    EXPECT_LT(wine.upper.x, glass.upper.x);
    EXPECT_LT(wine.upper.y, glass.upper.y);
    EXPECT_GT(wine.lower.y, glass.lower.y);
    EXPECT_GT(volumeOf(*result.parts[1].mesh), 3e-5);  // some 100 ml
    EXPECT_LT(volumeOf(*result.parts[1].mesh), 3e-4);
}

TEST(Generators, SeedsChangeTheArrangementAndNothingElseDoes) {
    for (const char* name : {"bookshelf", "plant", "drape", "grapes", "fruit", "pillow", "tree"}) {
        const auto hash = [&](int seed) {
            const ProceduralResult result = built(name, {{"seed", seed}});
            uint32_t h = 0;
            const auto mix = [&](const Vec3& p) {
                h = hashCombine(h, static_cast<uint32_t>(std::lround(p.x * 1e5f)),
                                static_cast<uint32_t>(std::lround(p.y * 1e5f)));
                h = hashCombine(h, static_cast<uint32_t>(std::lround(p.z * 1e5f)));
            };
            for (const ProceduralPart& part : result.parts)
                for (const Vec3& p : part.mesh->positions) mix(p);
            for (const Node& node : result.nodes) mix(node.local.translation);
            return h;
        };
        EXPECT_EQ(hash(4), hash(4)) << name;
        EXPECT_NE(hash(4), hash(5)) << name;
    }
}

TEST(Generators, TheHallScalesWithItsBays) {
    const int64_t whole = triangleCount(built("hall"));
    EXPECT_GT(whole, 150000);
    EXPECT_LT(whole, 250000);
    EXPECT_LT(triangleCount(built("hall", {{"bays-x", 2}})), whole);
    EXPECT_LT(triangleCount(built("hall", {{"floors", 1}})), whole * 6 / 10);
}

TEST(Generators, TheCreatureIsSkinnedAndItsGaitLoops) {
    const ProceduralResult result = built("creature");
    ASSERT_EQ(result.skins.size(), 1u);
    ASSERT_EQ(result.animations.size(), 1u);
    const Mesh& mesh = *result.parts.at(0).mesh;
    ASSERT_EQ(mesh.skin.first.size(), mesh.positions.size() + 1);
    for (size_t v = 0; v < mesh.positions.size(); ++v) {
        float sum = 0;
        for (uint32_t k = mesh.skin.first[v]; k < mesh.skin.first[v + 1]; ++k) {
            ASSERT_LT(mesh.skin.joint[k], result.skins[0].joints.size());
            sum += mesh.skin.weight[k];
        }
        ASSERT_NEAR(sum, 1, 1e-5f);
    }
    for (const AnimationChannel& channel : result.animations[0].channels) {
        float first[4], last[4];
        channel.evaluate(0, first), channel.evaluate(result.animations[0].duration, last);
        for (int c = 0; c < channel.components; ++c) EXPECT_NEAR(first[c], last[c], 1e-5f);
    }
}

TEST(Generators, TheBlobHasUnitNormalsInEveryForm) {
    const ProceduralResult result = built("blob");
    const Mesh& mesh = *result.parts.at(0).mesh;
    ASSERT_EQ(mesh.morphTargets.size(), 3u);
    for (const MorphTarget& target : mesh.morphTargets)
        for (size_t v = 0; v < mesh.positions.size(); ++v)
            ASSERT_NEAR(glm::length(mesh.normals[v] + target.normals[v]), 1, 1e-3f);
}

TEST(Textures, ColoursRepeatWithoutASeamAndNormalsPointUp) {
    for (const char* name : {"tiles", "masonry", "plaster", "weave", "wood"}) {
        const auto pattern = makeProceduralTexture(name);
        ASSERT_NE(pattern, nullptr);
        const auto describe = [&](ParameterVisitor& v) { pattern->describe(v); };
        setParameter(describe, "texels", 128);
        const TextureImage colour = pattern->build();
        EXPECT_TRUE(colour.srgb);
        // Steps across the seam are no larger than those inside the image.
        const auto& bytes = colour.levels[0].bytes;
        const auto meanStep = [&](int x0, int x1) {
            double sum = 0;
            for (int y = 0; y < 128; ++y)
                for (int c = 0; c < 3; ++c)
                    sum += std::abs(int(bytes[4 * size_t(y * 128 + x0) + size_t(c)]) -
                                    int(bytes[4 * size_t(y * 128 + x1) + size_t(c)]));
            return sum;
        };
        double inside = 0;
        for (int x = 0; x < 127; ++x) inside = std::max(inside, meanStep(x, x + 1));
        EXPECT_LE(meanStep(127, 0), inside * 1.2 + 64) << name;

        setParameter(describe, "map", std::string("normal"));
        const TextureImage normal = pattern->build();
        EXPECT_FALSE(normal.srgb);
        size_t down = 0;
        for (size_t i = 2; i < normal.levels[0].bytes.size(); i += 4) down += normal.levels[0].bytes[i] < 128;
        EXPECT_EQ(down, 0u) << name;
    }
}

TEST(BuiltInScenes, LoadWithoutAWarningAndWithinTheirSize) {
    const std::map<std::string, std::pair<int64_t, int64_t>> sizes = {
        {"cornell", {10, 100}},           {"room", {100000, 450000}},     {"atrium", {150000, 400000}},
        {"still-life", {100000, 450000}}, {"parade", {100000, 450000}},   {"atrium-glossy", {150000, 400000}},
        {"red-room", {50000, 450000}},    {"classroom", {50000, 450000}}, {"courtyard", {1000000, 2500000}},
        {"pillar", {10000, 100000}},      {"grids", {1000, 100000}},      {"hairball", {500000, 1500000}},
        {"text-plane", {100, 10000}},     {"ogre", {50000, 300000}},      {"bump-plane", {2, 100}}};
    for (const auto& [name, range] : sizes) {
        SCOPED_TRACE(name);
        MessageLog log;
        const auto scene = loadScene(std::filesystem::path(LUMISCOPE_SOURCE_DIR) / "scenes" / (name + ".json"), log);
        for (const std::string& text : log.warnings()) ADD_FAILURE() << text;
        EXPECT_GE(scene->triangleCount(), range.first);
        EXPECT_LE(scene->triangleCount(), range.second);
        EXPECT_FALSE(scene->title.empty());
        EXPECT_GE(scene->cameras.size(), 2u);
        EXPECT_EQ(scene->cameras.front().camera.name, "main");
        EXPECT_EQ(scene->render.module, "accumulate");
        EXPECT_EQ(scene->render.size, (Extent2{1280, 720}));
        EXPECT_EQ(scene->isAnimated(),
                  name != "cornell" && name != "still-life" && name != "pillar" && name != "grids");
    }
}

TEST(Generators, TheOgreIsClosedAndBreathes) {
    const ProceduralResult result = built("ogre");
    const Mesh& mesh = *result.parts.at(0).mesh;
    // Where two folds meet four triangles may share an edge; closed it is all the same: its faces' areas cancel.
    EXPECT_LE(openEdges(mesh), 4u);
    glm::dvec3 sum(0);
    for (const UVec3& t : mesh.triangles)
        sum += glm::dvec3(
            glm::cross(mesh.positions[t.y] - mesh.positions[t.x], mesh.positions[t.z] - mesh.positions[t.x]));
    EXPECT_LT(glm::length(sum), 1e-4);
    EXPECT_GT(volumeOf(mesh), 0.2);
    ASSERT_EQ(mesh.morphTargets.size(), 1u);
    float most = 0;
    for (const Vec3& moved : mesh.morphTargets[0].positions) most = std::max(most, glm::length(moved));
    EXPECT_GT(most, 0.02f);
    EXPECT_LT(most, 0.08f);
    EXPECT_EQ(mesh.skin.first.size(), mesh.positions.size() + 1);
    size_t turned = 0;
    for (const UVec3& t : mesh.triangles) {
        const Vec3 face =
            glm::cross(mesh.positions[t.y] - mesh.positions[t.x], mesh.positions[t.z] - mesh.positions[t.x]);
        turned += glm::dot(face, mesh.normals[t.x] + mesh.normals[t.y] + mesh.normals[t.z]) < 0;
    }
    EXPECT_LE(turned * 500, mesh.triangles.size()) << "normals and faces agree";
}

TEST(Generators, PrintIsMostlyPaperAndSharp) {
    const auto print = makeProceduralTexture("print");
    const Describe describe = [&](ParameterVisitor& v) { print->describe(v); };
    setParameter(describe, "texels", 1024);
    const TextureImage sheet = print->build();
    ASSERT_EQ(sheet.levels[0].extent, (Extent2{1024, 1024}));
    size_t dark = 0, red = 0, edges = 0;
    const std::vector<uint8_t>& bytes = sheet.levels[0].bytes;
    for (size_t i = 0; i + 4 < bytes.size(); i += 4) {
        dark += bytes[i] < 80;
        red += bytes[i] > 150 && bytes[i + 1] < 90;
        edges += std::abs(int(bytes[i + 1]) - int(bytes[i + 5])) > 100;
    }
    const double area = 1024.0 * 1024.0;
    EXPECT_GT(dark / area, 0.004);
    EXPECT_LT(dark / area, 0.3);
    EXPECT_GT(red / area, 0.003);
    EXPECT_GT(edges / area, 0.01);
    setParameter(describe, "weight", 3.0f);
    size_t heavy = 0;
    const TextureImage bold = print->build();
    for (size_t i = 0; i < bold.levels[0].bytes.size(); i += 4) heavy += bold.levels[0].bytes[i] < 80;
    EXPECT_GT(heavy, 2 * dark);
}

TEST(BuiltInScenes, TheParadeComesBackToItsStart) {
    MessageLog log;
    const auto scene = loadScene(std::filesystem::path(LUMISCOPE_SOURCE_DIR) / "scenes/parade.json", log);
    const float duration = scene->duration();
    EXPECT_NEAR(duration, 12, 1e-3f);
    const auto start = poseScene(scene, {0, 0, 0});
    const auto end = poseScene(scene, {duration - 1e-4f, duration - 1e-4f, duration - 1e-4f});
    for (size_t i = 0; i < start->instances.size(); ++i)
        for (int c = 0; c < 4; ++c)
            EXPECT_LT(glm::length(start->instances[i].worldFromObject[c] - end->instances[i].worldFromObject[c]), 0.02f)
                << scene->instances[i].name;
    const auto later = poseScene(scene, {1, 1, 0.9f}, start.get());
    EXPECT_TRUE(later->anythingMoves);
}

}  // namespace
}  // namespace lumi::test
