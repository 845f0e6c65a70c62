// Generated tangents: closed forms on small meshes, and the tangents that authors' tools stored in real files.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "math/transform.h"
#include "scene/gltf/load_gltf.h"
#include "scene/mesh.h"

namespace lumi {
namespace {

std::filesystem::path assets() {
    const char* folder = std::getenv("LUMISCOPE_ASSETS");
    return std::filesystem::path(folder ? folder : LUMISCOPE_SOURCE_DIR "/../shared/assets") / "gltf";
}

/// A unit normal, a unit tangent orthogonal to it, a handedness of one.
void expectFrames(const Mesh& mesh) {
    ASSERT_EQ(mesh.tangents.size(), mesh.positions.size());
    for (size_t v = 0; v < mesh.positions.size(); ++v) {
        EXPECT_NEAR(glm::length(Vec3(mesh.tangents[v])), 1, 1e-4f);
        EXPECT_NEAR(glm::dot(Vec3(mesh.tangents[v]), mesh.normals[v]), 0, 1e-4f);
        EXPECT_EQ(std::abs(mesh.tangents[v].w), 1);
    }
}

/// A strip of squares along x in the plane z = 0 with the given u at each of its columns; v falls with y.
Mesh strip(const std::vector<float>& u) {
    Mesh mesh;
    for (size_t i = 0; i < u.size(); ++i)
        for (const float y : {0.0f, 1.0f}) {
            mesh.positions.emplace_back(float(i), y, 0);
            mesh.normals.emplace_back(0, 0, 1);
            mesh.uv[0].emplace_back(u[i], 1 - y);
        }
    for (uint32_t i = 0; i + 1 < u.size(); ++i) {
        mesh.triangles.emplace_back(2 * i, 2 * i + 2, 2 * i + 1);
        mesh.triangles.emplace_back(2 * i + 1, 2 * i + 2, 2 * i + 3);
    }
    return mesh;
}

TEST(Tangents, MirroredCoordinatesSplitTheirCommonVertices) {
    // u rises to the middle and falls again: the two vertices in the middle need both tangents.
    Mesh mesh = strip({0, 0.5f, 1, 0.5f, 0});
    computeTangents(mesh);
    expectFrames(mesh);
    EXPECT_EQ(mesh.positions.size(), 12u);
    for (size_t t = 0; t < mesh.triangles.size(); ++t)
        for (int c = 0; c < 3; ++c) {
            const float side = t < 4 ? 1 : -1;
            const Vec4& tangent = mesh.tangents[mesh.triangles[t][c]];
            EXPECT_LT(glm::distance(Vec3(tangent), Vec3(side, 0, 0)), 1e-6f);
            EXPECT_EQ(tangent.w, side);
        }
    // The copies carry the other attributes along.
    EXPECT_EQ(mesh.positions[10].x, 2);
    EXPECT_EQ(mesh.uv[0][10], mesh.uv[0][mesh.positions[10].y == 0 ? 4 : 5]);
}

TEST(Tangents, SeamsOfCoordinatesAreNotAveraged) {
    // Two squares share an edge in space but turn their coordinates by a quarter: a seam, and each side keeps its own.
    Mesh mesh = strip({0, 1, 2});
    const auto copies = static_cast<uint32_t>(mesh.positions.size());
    for (const uint32_t v : {2u, 3u}) {
        mesh.positions.push_back(mesh.positions[v]);
        mesh.normals.push_back(mesh.normals[v]);
        mesh.uv[0].push_back(mesh.uv[0][v]);
    }
    mesh.triangles[2] = {copies, 4, copies + 1};
    mesh.triangles[3] = {copies + 1, 4, 5};
    for (const uint32_t v : {copies, copies + 1, 4u, 5u}) {
        const Vec3 p = mesh.positions[v];
        mesh.uv[0][v] = {p.y, p.x};  // u grows upwards, v to the right
    }
    computeTangents(mesh);
    expectFrames(mesh);
    EXPECT_LT(glm::distance(mesh.tangents[2], Vec4(1, 0, 0, 1)), 1e-6f);
    EXPECT_LT(glm::distance(mesh.tangents[copies], Vec4(0, 1, 0, 1)), 1e-6f);
}

TEST(Tangents, VerticesOfEqualAttributesAreWeldedFirst) {
    // A cylinder whose triangles own their corners: the tangent is the circle's, as if the corners were shared.
    constexpr uint32_t kSides = 24;
    const auto build = [&](bool shared) {
        Mesh mesh;
        const auto vertex = [&](uint32_t side, uint32_t ring) {
            const float angle = 2 * kPi * float(side) / kSides;
            mesh.positions.emplace_back(std::cos(angle), float(ring), -std::sin(angle));
            mesh.normals.emplace_back(std::cos(angle), 0, -std::sin(angle));
            mesh.uv[0].emplace_back(float(side) / kSides, 1 - float(ring));
            return static_cast<uint32_t>(mesh.positions.size() - 1);
        };
        if (shared)
            for (uint32_t side = 0; side <= kSides; ++side) vertex(side, 0), vertex(side, 1);
        for (uint32_t s = 0; s < kSides; ++s) {
            const auto corner = [&](uint32_t side, uint32_t ring) {
                return shared ? 2 * side + ring : vertex(side, ring);
            };
            const UVec3 lower(corner(s, 0), corner(s + 1, 0), corner(s, 1));
            const UVec3 upper(corner(s, 1), corner(s + 1, 0), corner(s + 1, 1));
            mesh.triangles.push_back(lower);
            mesh.triangles.push_back(upper);
        }
        computeTangents(mesh);
        return mesh;
    };
    const Mesh shared = build(true), owned = build(false);
    expectFrames(shared);
    expectFrames(owned);
    EXPECT_EQ(shared.positions.size(), 2u * (kSides + 1));
    for (size_t t = 0; t < shared.triangles.size(); ++t)
        for (int c = 0; c < 3; ++c) {
            const Vec4 a = shared.tangents[shared.triangles[t][c]], b = owned.tangents[owned.triangles[t][c]];
            EXPECT_LT(glm::distance(a, b), 1e-5f);
            const Vec3 n = shared.normals[shared.triangles[t][c]];
            EXPECT_GT(glm::dot(Vec3(a), Vec3(n.z, 0, -n.x)), 0.9999f);
        }
}

TEST(Tangents, TrianglesCountByTheirAngle) {
    // A corner between a wide triangle whose u runs along x and a narrow one whose u is sheared by a known angle.
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-0.5f, 1, 0}};
    mesh.normals.assign(4, Vec3(0, 0, 1));
    mesh.uv[0] = {{0, 1}, {1, 1}, {0, 0}, {-1, 0}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    computeTangents(mesh);
    // First: u = x, angle of 90 degrees. Second: u(0, y) = 0 and u(-0.5, 1) = -1, so u grows along x too. Shear it:
    const Vec3 both(mesh.tangents[0]);
    EXPECT_LT(glm::distance(both, Vec3(1, 0, 0)), 1e-6f);
    mesh.uv[0][3] = {-1, -1};  // v = y' with u's direction now (2, -1)-like
    mesh.tangents.clear();
    computeTangents(mesh);
    const Vec2 e1(0, 1), e2(-0.5f, 1), d1(0, -1), d2(-1, -2);  // edges and their (u, v)
    const float area = d1.x * d2.y - d1.y * d2.x;
    const Vec2 second = glm::normalize((e1 * d2.y - e2 * d1.y) * (area > 0 ? 1.0f : -1.0f));
    const float angle = std::acos(glm::dot(glm::normalize(e1), glm::normalize(e2)));
    const Vec2 expected = glm::normalize(0.5f * kPi * Vec2(1, 0) + angle * second);
    EXPECT_LT(glm::distance(Vec3(mesh.tangents[0]), Vec3(expected, 0)), 1e-5f);
}

TEST(Tangents, DegenerateTrianglesFollowTheirNeighbours) {
    Mesh mesh = strip({0, 1});
    mesh.triangles.push_back({0, 0, 2});  // no area in space
    mesh.positions.emplace_back(0.5f, 1.5f, 0);
    mesh.normals.emplace_back(0, 0, 1);
    mesh.uv[0].push_back(mesh.uv[0][1]);
    mesh.triangles.push_back({1, 3, 4});  // no area in its coordinates
    computeTangents(mesh);
    expectFrames(mesh);
    EXPECT_EQ(mesh.positions.size(), 5u) << "nothing is split";
    for (size_t v = 0; v < 4; ++v) EXPECT_LT(glm::distance(mesh.tangents[v], Vec4(1, 0, 0, 1)), 1e-6f);
}

/// Drops a file's own tangents, makes new ones and returns the share of corners where both agree to `cosine`.
double agreement(const std::string& file, float cosine) {
    MessageLog log;
    const Scene scene = loadGltf(assets() / file, log);
    size_t agreeing = 0, corners = 0;
    for (const Instance& instance : scene.instances) {
        if (instance.mesh->tangents.empty() || instance.mesh->uv[0].empty()) continue;
        Mesh mesh = *instance.mesh;
        const std::vector<Vec4> stored = mesh.tangents;
        const std::vector<UVec3> triangles = mesh.triangles;
        computeTangents(mesh);
        for (size_t t = 0; t < triangles.size(); ++t)
            for (int c = 0; c < 3; ++c) {
                const Vec4 &ours = mesh.tangents[mesh.triangles[t][c]], &theirs = stored[triangles[t][c]];
                agreeing += ours.w == theirs.w && glm::dot(Vec3(ours), Vec3(theirs)) > cosine;
                ++corners;
            }
    }
    EXPECT_GT(corners, 0u) << file;
    return double(agreeing) / double(std::max<size_t>(corners, 1));
}

TEST(Tangents, AgreeWithThoseThatAuthorsStored) {
    if (!std::filesystem::exists(assets())) GTEST_SKIP() << "no shared assets at " << assets();
    // Both were made by implementations of the same thesis (Blender's, and the one in glTF-Transform). Other exporters
    // among the assets have rules of their own.
    for (const char* file :
         {"AlphaBlendModeTest/AlphaBlendModeTest.glb", "AnisotropyStrengthTest/AnisotropyStrengthTest.glb"})
        EXPECT_GT(agreement(file, 0.99999f), 0.9999) << file;
}

TEST(Tangents, NormalTangentTestMeansItsGreenArrows) {
    if (!std::filesystem::exists(assets())) GTEST_SKIP() << "no shared assets at " << assets();
    MessageLog log;
    const Scene scene = loadGltf(assets() / "NormalTangentTest/NormalTangentTest.glb", log);
    size_t triangles = 0, mirrored = 0;
    for (const Instance& instance : scene.instances) {
        const Mesh& mesh = *instance.mesh;
        expectFrames(mesh);
        for (const UVec3& t : mesh.triangles) {
            const Vec3 e1 = mesh.positions[t.y] - mesh.positions[t.x], e2 = mesh.positions[t.z] - mesh.positions[t.x];
            const Vec2 d1 = mesh.uv[0][t.y] - mesh.uv[0][t.x], d2 = mesh.uv[0][t.z] - mesh.uv[0][t.x];
            const float area = d1.x * d2.y - d1.y * d2.x;
            if (std::abs(area) < 1e-9f || glm::length(glm::cross(e1, e2)) < 1e-9f) continue;
            const Vec3 along = glm::normalize((e1 * d2.y - e2 * d1.y) / area);
            ++triangles;
            mirrored += area > 0;
            for (int c = 0; c < 3; ++c) {
                // A vertex averages over a fan: within 60 degrees of its own triangle's direction of growing u.
                EXPECT_EQ(mesh.tangents[t[c]].w, area > 0 ? -1.0f : 1.0f);
                EXPECT_GT(glm::dot(Vec3(mesh.tangents[t[c]]), along), 0.5f);
            }
        }
    }
    EXPECT_GT(triangles, 5000u);
    EXPECT_LT(mirrored, triangles);
}

}  // namespace
}  // namespace lumi
