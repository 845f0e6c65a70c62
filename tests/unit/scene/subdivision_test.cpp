// Subdivision: OpenSubdiv's refined baselines tie our cages to its topology, closed forms tie the limit surface.
#include "scene/subdivision.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>

#include "base/error.h"
#include "scene/obj/cage.h"
#include "support/expect_error.h"
#include "support/memory_limit.h"
#include "support/refined_cage.h"

namespace lumi::test {
namespace {
namespace fs = std::filesystem;

fs::path assets() {
    const char* folder = std::getenv("LUMISCOPE_ASSETS");
    return fs::path(folder ? folder : LUMISCOPE_SOURCE_DIR "/../shared/assets") / "subdiv" / "opensubdiv";
}

const char* kCube =
    "v -1 -1 1\nv 1 -1 1\nv -1 1 1\nv 1 1 1\nv -1 1 -1\nv 1 1 -1\nv -1 -1 -1\nv 1 -1 -1\n"
    "f 1 2 4 3\nf 3 4 6 5\nf 5 6 8 7\nf 7 8 2 1\nf 2 8 6 4\nf 7 1 3 5\n";

float distanceToNearest(const Vec3& p, const std::vector<Vec3>& cloud) {
    float best = kInfinity;
    for (const Vec3& q : cloud) best = std::min(best, glm::distance(p, q));
    return best;
}

std::vector<Vec3> readPositions(const fs::path& path) {
    std::vector<Vec3> positions;
    std::ifstream file(path);
    for (std::string word; file >> word;) {
        if (word != "v") continue;
        Vec3 p;
        file >> p.x >> p.y >> p.z;
        positions.push_back(p);
    }
    return positions;
}

TEST(Subdivision, CagesRefineToPublishedBaselines) {
    if (!fs::exists(assets())) GTEST_SKIP() << "the test assets " << assets() << " are not here";
    int compared = 0;
    MessageLog log;
    for (const auto& entry : fs::directory_iterator(assets() / "baseline")) {
        const std::string name = entry.path().stem().string();
        const size_t mark = name.rfind("_level");
        const int level = name.back() - '0';
        const std::string shape = name.substr(0, mark);
        // Hierarchical edits are not part of our cages. OpenSubdiv 3's own refinement parts from this older baseline
        // where Chaikin creases of unequal sharpness meet (chaikin1).
        if (level > 1 || shape == "catmark_chaikin1" || shape.find("hedit") != std::string::npos) continue;
        const SubdivisionCage cage = loadCage(assets() / (shape + ".obj"), log);
        const std::vector<Vec3> baseline = readPositions(entry.path());
        const std::vector<CagePoint> ours = refined(cage, level + 1);
        float worst = 0;
        for (const CagePoint& point : ours) worst = std::max(worst, distanceToNearest(point.p, baseline));
        EXPECT_LT(worst, 2e-6f) << name;
        EXPECT_EQ(ours.size(), baseline.size()) << name;
        ++compared;
    }
    EXPECT_GE(compared, 30);
}

TEST(Subdivision, TessellationLiesOnTheLimitOfRefinement) {
    // Vertices of a tessellation at rate 4 are among the limit points of refinement, once it has used up the creases'
    // sharpness.
    const std::string creased = std::string(kCube) + "#t crease 2/1/0 2 3 4.0\n#t corner 1/1/0 4 2.5\n";
    for (const std::string& text : {std::string(kCube), creased}) {
        const SubdivisionCage cage = cageOf(text, "cube");
        std::vector<CagePoint> limit;
        refined(cage, 6, &limit);
        std::vector<Vec3> cloud;
        for (const CagePoint& point : limit) cloud.push_back(point.p);
        const SubdivisionSurface surface = tessellate(cage, 4, "cube");
        for (const Vec3& p : surface.mesh.positions) EXPECT_LT(distanceToNearest(p, cloud), 2e-5f);
    }
}

TEST(Subdivision, SharedEdgesHaveEqualBitsAndTheSurfaceIsClosed) {
    const SubdivisionSurface surface = tessellate(cageOf(kCube, "cube"), 7, "cube");
    using Key = std::array<float, 3>;
    const auto key = [&](uint32_t v) {
        const Vec3& p = surface.mesh.positions[v];
        return Key{p.x, p.y, p.z};
    };
    std::map<std::pair<Key, Key>, int> edges;
    for (const UVec3& t : surface.mesh.triangles)
        for (int c = 0; c < 3; ++c) ++edges[{key(t[c]), key(t[(c + 1) % 3])}];
    for (const auto& [edge, count] : edges) {
        EXPECT_EQ(count, 1);
        EXPECT_EQ((edges.count({edge.second, edge.first})), 1u) << "an edge without its opposite is a crack";
    }
}

TEST(Subdivision, NormalsPointOutwards) {
    const SubdivisionSurface surface = tessellate(cageOf(kCube, "cube"), 5, "cube");
    for (size_t v = 0; v < surface.mesh.positions.size(); ++v) {
        EXPECT_NEAR(glm::length(surface.mesh.normals[v]), 1, 1e-5);
        EXPECT_GT(glm::dot(surface.mesh.normals[v], surface.mesh.positions[v]), 0);
    }
}

TEST(Subdivision, ADeformingCageMovesItsSurfaceAlong) {
    const SubdivisionCage cage = cageOf(kCube, "cube");
    const SubdivisionSurface surface = tessellate(cage, 6, "cube");
    std::vector<Vec3> moved, positions, normals;
    const auto affine = [](const Vec3& p) { return Vec3(2 * p.x + p.y + 1, p.y - 3, 0.5f * p.z + p.x); };
    for (const Vec3& p : cage.positions) moved.push_back(affine(p));
    surface.evaluate(moved, positions, normals);
    for (size_t v = 0; v < positions.size(); ++v)
        EXPECT_LT(glm::distance(positions[v], affine(surface.mesh.positions[v])), 1e-5f);
}

TEST(Subdivision, EveryAssetCageTessellates) {
    if (!fs::exists(assets())) GTEST_SKIP() << "the test assets " << assets() << " are not here";
    for (const auto& entry : fs::recursive_directory_iterator(assets().parent_path())) {
        if (entry.path().extension() != ".obj" || entry.path().string().find("baseline") != std::string::npos) continue;
        MessageLog log;
        const SubdivisionSurface surface = tessellate(loadCage(entry.path(), log), 3, entry.path().string());
        EXPECT_GT(surface.mesh.triangles.size(), 0u) << entry.path();
        checkMesh(surface.mesh, entry.path().string());
        EXPECT_EQ(log.warnings().empty(), entry.path().string().find("hedit") == std::string::npos) << entry.path();
    }
}

/// Where many faces meet, each of them depends on all the others.
TEST(Subdivision, TheWeightsOfACrowdedVertexCountAgainstTheMemoryLimit) {
    const auto fan = [](int quads) {
        std::string text = "v 0 0 0\n";
        for (int i = 0; i < 2 * quads; ++i) {
            const float angle = kPi * static_cast<float>(i) / static_cast<float>(quads);
            text += "v " + std::to_string(std::cos(angle)) + " " + std::to_string(std::sin(angle)) + " 0\n";
        }
        for (int i = 0; i < quads; ++i)
            text += "f 1 " + std::to_string(2 + 2 * i) + " " + std::to_string(3 + 2 * i) + " " +
                    std::to_string(2 + (2 * i + 2) % (2 * quads)) + "\n";
        return cageOf(text, "fan.obj");
    };
    const MemoryLimit limit(uint64_t(64) << 20);
    EXPECT_EQ(tessellate(fan(16), 8, "fan").mesh.triangles.size(), 16u * 8 * 8 * 2);
    expectError(ErrorKind::Resources, [&] { tessellate(fan(400), 8, "fan"); }, {"tessellating fan", "memory limit"});
}

TEST(Subdivision, RefusesBrokenCages) {
    SubdivisionCage cage = cageOf(kCube, "cube");
    EXPECT_THROW(tessellate(cage, 0, "cube"), Error);
    cage.faceVertices[0] = 99;
    EXPECT_THROW(tessellate(cage, 2, "cube"), Error);
    EXPECT_THROW(cageOf("v 0 0 0\n", "points.obj"), Error);
    std::string wide = "f", points;
    for (int i = 1; i <= 256; ++i) points += "v 0 0 " + std::to_string(i) + "\n", wide += " " + std::to_string(i);
    try {
        cageOf(points + wide + "\n", "wide.obj");
        ADD_FAILURE() << "a face of 256 corners is accepted";
    } catch (const Error& error) {
        EXPECT_EQ(std::string(error.what()), "wide.obj: a face has too many corners; expected at most 255");
    }
}

}  // namespace
}  // namespace lumi::test
