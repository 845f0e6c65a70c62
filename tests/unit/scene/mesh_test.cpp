#include "scene/mesh.h"

#include <gtest/gtest.h>

#include <cmath>

#include "scene/bounds.h"
#include "scene/mesh_edit.h"
#include "support/expect_error.h"

namespace lumi {
namespace {

using test::expectError;

/// A unit square in the XY plane, facing +Z, uv as in an image (v down).
Mesh square() {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    mesh.uv[0] = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    return mesh;
}

void expectNear(const Vec3& a, const Vec3& b, float tolerance = 1e-6f) {
    EXPECT_LT(glm::length(a - b), tolerance) << a.x << ' ' << a.y << ' ' << a.z;
}

TEST(Mesh, BoundsAreWorkedOutOnceForManyInstances) {
    Mesh mesh = square();
    MeshBounds bounds;
    EXPECT_EQ(bounds.of(mesh).upper, Vec3(1, 1, 0));
    mesh.positions[2] = {5, 5, 5};
    EXPECT_EQ(bounds.of(mesh).upper, Vec3(1, 1, 0)) << "not looked at again";
    EXPECT_EQ(MeshBounds().of(mesh).upper, Vec3(5));
}

TEST(Mesh, NormalsAreWeightedByAngle) {
    // A cube's corner: one face is one triangle, two faces are two triangles; angles make all three count alike.
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 0}, {0, 1, 1}};
    mesh.triangles = {{0, 4, 1}, {0, 2, 4}, {0, 5, 2}, {0, 3, 5}, {0, 1, 3}};
    computeNormals(mesh);
    expectNear(mesh.normals[0], glm::normalize(Vec3(-1)), 1e-5f);
}

TEST(Mesh, DegenerateTrianglesDoNotCount) {
    Mesh mesh = square();
    mesh.positions.push_back({5, 5, 5});
    mesh.triangles.push_back({0, 0, 1});
    mesh.triangles.push_back({4, 4, 4});
    computeNormals(mesh);
    for (int i = 0; i < 4; ++i) expectNear(mesh.normals[static_cast<size_t>(i)], {0, 0, 1});
    EXPECT_NEAR(glm::length(mesh.normals[4]), 1, 1e-6f) << "unused vertices get some unit normal";
}

TEST(Mesh, TangentsFollowU) {
    Mesh mesh = square();
    computeTangents(mesh);
    for (const Vec4& tangent : mesh.tangents) {
        expectNear(Vec3(tangent), {1, 0, 0});
        // The bitangent cross(n, t) * w points up in the image, where v falls.
        EXPECT_EQ(tangent.w, 1);
    }
}

TEST(Mesh, MirroredCoordinatesTurnTheHandedness) {
    Mesh mesh = square();
    for (Vec2& uv : mesh.uv[0]) uv.x = 1 - uv.x;
    computeTangents(mesh);
    for (const Vec4& tangent : mesh.tangents) {
        expectNear(Vec3(tangent), {-1, 0, 0});
        EXPECT_EQ(tangent.w, -1);
    }
}

TEST(Mesh, TangentsWithoutCoordinatesAreStillUnitAndOrthogonal) {
    Mesh mesh = square();
    mesh.uv[0].assign(4, Vec2(0.5f));
    computeTangents(mesh);
    for (size_t i = 0; i < 4; ++i) {
        EXPECT_NEAR(glm::length(Vec3(mesh.tangents[i])), 1, 1e-5f);
        EXPECT_NEAR(glm::dot(Vec3(mesh.tangents[i]), mesh.normals[i]), 0, 1e-5f);
    }
}

TEST(Mesh, CheckNamesTheFault) {
    checkMesh(square(), "here");
    Mesh index = square();
    index.triangles[1].y = 4;
    expectError(ErrorKind::BadInput, [&] { checkMesh(index, "here"); }, {"here", "triangle 1", "below 4"});
    Mesh position = square();
    position.positions[2].y = std::nanf("");
    expectError(ErrorKind::BadInput, [&] { checkMesh(position, "here"); }, {"vertex 2"});
    Mesh normals = square();
    normals.normals.resize(3);
    expectError(ErrorKind::BadInput, [&] { checkMesh(normals, "here"); }, {"normals"});
    Mesh materials = square();
    materials.triangleMaterial = {0};
    expectError(ErrorKind::BadInput, [&] { checkMesh(materials, "here"); }, {"materials"});
    Mesh skin = square();
    skin.skin = {{0, 1, 2, 3}, {0, 0, 0}, {1, 1, 1}};
    expectError(ErrorKind::BadInput, [&] { checkMesh(skin, "here"); }, {"skin"});
}

TEST(Mesh, CompactingDropsUnusedVertices) {
    Mesh mesh = square();
    mesh.triangles = {{0, 2, 3}};
    mesh.skin = {{0, 1, 3, 4, 5}, {7, 1, 2, 8, 9}, {1, 0.5f, 0.5f, 1, 1}};
    mesh.morphTargets = {{{{0, 0, 1}, {0, 0, 2}, {0, 0, 3}, {0, 0, 4}}, {}, {}}};
    compactVertices(mesh);
    ASSERT_EQ(mesh.positions.size(), 3u);
    EXPECT_EQ(mesh.triangles[0], UVec3(0, 1, 2));
    expectNear(mesh.positions[1], {1, 1, 0});
    EXPECT_EQ(mesh.skin.joint, (std::vector<uint32_t>{7, 8, 9}));
    EXPECT_EQ(mesh.morphTargets[0].positions[1].z, 3);
    checkMesh(mesh, "compacted");
}

TEST(Mesh, FlatTrianglesOwnTheirVertices) {
    Mesh mesh = square();
    mesh.positions[3] = {0, 1, 1};
    makeFlat(mesh);
    ASSERT_EQ(mesh.positions.size(), 6u);
    expectNear(mesh.normals[0], {0, 0, 1});
    EXPECT_GT(glm::length(mesh.normals[3] - mesh.normals[0]), 0.1f);
    expectNear(mesh.normals[3], mesh.normals[5]);
}

TEST(Mesh, MergingFillsWhatOnePartLacks) {
    Mesh a = square(), b = square();
    a.material = 3;
    b.material = 5;
    a.normals.assign(4, {0, 0, 1});
    b.normals.assign(4, {0, 0, 1});
    a.colours.assign(4, Vec4(0.5f));
    b.uv[1].assign(4, Vec2(0.25f));
    b.skin = {{0, 1, 2, 3, 4}, {1, 1, 1, 1}, {1, 1, 1, 1}};
    const Mesh merged = mergeMeshes({a, b});
    checkMesh(merged, "merged");
    ASSERT_EQ(merged.triangles.size(), 4u);
    EXPECT_EQ(merged.triangles[2], UVec3(4, 5, 6));
    EXPECT_EQ(merged.triangleMaterial, (std::vector<uint32_t>{3, 3, 5, 5}));
    EXPECT_EQ(merged.colours[7], Vec4(1));
    EXPECT_EQ(merged.uv[1][0], Vec2(0));
    EXPECT_EQ(merged.uv[1][7], Vec2(0.25f));
    EXPECT_EQ(merged.skin.joint, (std::vector<uint32_t>{0, 0, 0, 0, 1, 1, 1, 1}));
    const Mesh uniform = mergeMeshes({a, a});
    EXPECT_TRUE(uniform.triangleMaterial.empty());
    EXPECT_EQ(uniform.material, 3u);
}

}  // namespace
}  // namespace lumi
