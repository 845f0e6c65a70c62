// Draco and meshopt: encoded here with the libraries themselves, read back through the loader.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "compressed_gltf.h"

namespace lumi {
namespace {

using test::addDraco;
using test::addMeshopt;
using test::DracoFile;
using test::encodeDraco;
using test::encodeVertices;
using test::GltfBuilder;
using test::meshoptView;
using test::Sheet;

/// Triangles as their sorted corners' texture coordinates on a grid: equal for equal meshes in any order.
std::vector<std::array<int, 6>> fingerprint(const std::vector<UVec3>& triangles, const std::vector<Vec2>& uvs) {
    std::vector<std::array<int, 6>> all;
    for (const UVec3& t : triangles) {
        std::array<std::pair<int, int>, 3> corners;
        for (int c = 0; c < 3; ++c) {
            const Vec2 uv = uvs[t[c]];
            corners[static_cast<size_t>(c)] = {static_cast<int>(std::lround(uv.x * 100)),
                                               static_cast<int>(std::lround(uv.y * 100))};
        }
        std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
        all.push_back({corners[0].first, corners[0].second, corners[1].first, corners[1].second, corners[2].first,
                       corners[2].second});
    }
    std::sort(all.begin(), all.end());
    return all;
}

std::vector<UVec3> trianglesOf(const std::vector<uint32_t>& indices) {
    std::vector<UVec3> triangles;
    for (size_t i = 0; i + 2 < indices.size(); i += 3)
        triangles.emplace_back(indices[i], indices[i + 1], indices[i + 2]);
    return triangles;
}

TEST(GltfCompression, DracoMeshesComeBackByBothMethods) {
    const Sheet sheet(12);
    for (const int method : {draco::MESH_SEQUENTIAL_ENCODING, draco::MESH_EDGEBREAKER_ENCODING}) {
        MessageLog log;
        GltfBuilder file;
        addDraco(file, encodeDraco(sheet, method), sheet.indices.size());
        const Scene scene = file.load(log);
        EXPECT_TRUE(log.warnings().empty());
        const Mesh& mesh = *scene.instances.at(0).mesh;
        EXPECT_EQ(mesh.positions.size(), sheet.positions.size());
        EXPECT_EQ(fingerprint(mesh.triangles, mesh.uv[0]), fingerprint(trianglesOf(sheet.indices), sheet.uvs));
        for (size_t i = 0; i < mesh.positions.size(); ++i) {
            const Vec2 uv = mesh.uv[0][i];
            const auto at = static_cast<size_t>(std::lround(uv.y * 12) * 13 + std::lround(uv.x * 12));
            EXPECT_LT(glm::distance(mesh.positions[i], sheet.positions[at]), 3e-4f);
            EXPECT_LT(glm::distance(mesh.normals[i], sheet.normals[at]), 1e-2f);
        }
    }
}

TEST(GltfCompression, DracoIsCheckedAgainstItsAccessors) {
    const Sheet sheet(4);
    const DracoFile draco = encodeDraco(sheet, draco::MESH_EDGEBREAKER_ENCODING);
    GltfBuilder fewer;
    addDraco(fewer, draco, sheet.indices.size() - 3);
    fewer.expectRefused({"/meshes/0/primitives/0", "KHR_draco", "31 triangles", "32 triangles"});
    GltfBuilder unknown;
    addDraco(unknown, draco, sheet.indices.size());
    unknown.primitive()["extensions"]["KHR_draco_mesh_compression"]["attributes"]["NORMAL"] = 77;
    unknown.expectRefused({"/attributes/NORMAL", "no such attribute"});
    for (size_t length = 0; length < draco.bytes.size(); length += 7) {
        DracoFile cut = draco;
        cut.bytes.resize(length);
        GltfBuilder file;
        addDraco(file, cut, sheet.indices.size());
        file.expectRefused({"test.glb"});
    }
    // A header that announces four thousand million triangles is refused before they are given memory.
    DracoFile absurd = draco;
    for (const size_t i : {12u, 13u, 14u, 15u}) absurd.bytes[i] = char(0xff);
    absurd.bytes[16] = 0x0f;
    GltfBuilder file;
    addDraco(file, absurd, sheet.indices.size());
    file.expectRefused({"holds more than its accessors say"});
}

TEST(GltfCompression, MeshoptViewsAndTheirFilters) {
    const Sheet sheet(9);
    for (const bool sequence : {false, true}) {
        MessageLog log;
        GltfBuilder file;
        addMeshopt(file, sheet, sequence);
        const Scene scene = file.load(log);
        EXPECT_TRUE(log.warnings().empty());
        const Mesh& mesh = *scene.instances.at(0).mesh;
        ASSERT_EQ(mesh.positions.size(), sheet.positions.size());
        EXPECT_EQ(fingerprint(mesh.triangles, mesh.uv[0]), fingerprint(trianglesOf(sheet.indices), sheet.uvs));
        for (size_t i = 0; i < mesh.positions.size(); ++i) {
            EXPECT_LT(glm::distance(mesh.positions[i] / 30000.0f - 1.0f, sheet.positions[i]), 1e-4f);
            EXPECT_LT(glm::distance(mesh.normals[i], sheet.normals[i]), 2e-2f);
            EXPECT_LT(glm::distance(mesh.uv[0][i], sheet.uvs[i]), 1e-3f);
        }
    }
}

TEST(GltfCompression, MeshoptQuaternionsTurnInstances) {
    GltfBuilder file;
    file.triangle();
    const float half = std::sqrt(0.5f);
    const std::vector<Vec4> turns{{0, 0, 0, 1}, {0, 0, half, half}};
    std::vector<std::array<int16_t, 4>> encoded(turns.size());
    meshopt_encodeFilterQuat(encoded.data(), turns.size(), 8, 16, &turns[0].x);
    meshoptView(file, encodeVertices(encoded), turns.size(), 8, "ATTRIBUTES", "QUATERNION");
    file.json["accessors"].push_back(
        {{"bufferView", 2}, {"componentType", 5122}, {"normalized", true}, {"count", 2}, {"type", "VEC4"}});
    file.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {{"ROTATION", 2}};
    file.extraBuffers = {{{"byteLength", 16}, {"extensions", {{"EXT_meshopt_compression", {{"fallback", true}}}}}}};
    const Scene scene = file.load();
    ASSERT_EQ(scene.instances.size(), 2u);
    const Quat turned = scene.nodes[static_cast<size_t>(scene.instances[1].node)].local.rotation;
    EXPECT_LT(glm::distance(turned * Vec3(1, 0, 0), Vec3(0, 1, 0)), 1e-3f);
}

TEST(GltfCompression, MeshoptIsCheckedBeforeItIsGivenMemory) {
    const Sheet sheet(4);
    const auto broken = [&](const char* key, const nlohmann::json& value, const std::string& expected,
                            size_t view = 0) {
        GltfBuilder file;
        addMeshopt(file, sheet, false);
        file.json["bufferViews"][view]["extensions"]["EXT_meshopt_compression"][key] = value;
        file.expectRefused({"/bufferViews/" + std::to_string(view), expected});
    };
    broken("count", 2000000000, "more than the compressed bytes can hold");
    broken("count", 24, "do not fit the buffer view");
    broken("byteStride", 6, "does not fit the mode");
    broken("byteStride", 0, "out of range");
    broken("byteLength", 1 << 30, "past the end");
    broken("byteLength", 9, "damaged");
    broken("mode", "POINTS", "no such mode");
    broken("filter", "CUBIC", "no such filter");
    broken("filter", "QUATERNION", "no such filter", 1);
    broken("buffer", 7, "no such entry");
    broken("count", 31, "not a multiple of 3", 3);
    GltfBuilder damaged;
    addMeshopt(damaged, sheet, false);
    damaged.bin[0] = 0;
    damaged.expectRefused({"/bufferViews/0", "damaged"});
}

TEST(GltfCompression, TexturesInOtherFormatsAreStandInsWithOneWarning) {
    GltfBuilder file;
    test::addForeignTextures(file);
    MessageLog log;
    const Scene scene = file.load(log);
    const std::vector<std::string> warnings = log.warnings();
    ASSERT_EQ(warnings.size(), 2u);
    EXPECT_NE(warnings[0].find("2 textures are in KTX2"), std::string::npos) << warnings[0];
    EXPECT_NE(warnings[1].find("1 texture is in WebP"), std::string::npos) << warnings[1];
    const Material& m = scene.materials[0];
    EXPECT_EQ(m.baseColorTexture.sample({0.25f, 0.25f}).x, 1) << "a magenta checker";
    EXPECT_EQ(m.baseColorTexture.sample({0.25f, 0.25f}).y, 0);
    EXPECT_EQ(m.emissionTexture.sample({0.25f, 0.25f}).y, 0);
    EXPECT_EQ(m.metallicRoughnessTexture.sample({0.25f, 0.25f}), Vec4(1)) << "data is left as the factors say";
}

}  // namespace
}  // namespace lumi
