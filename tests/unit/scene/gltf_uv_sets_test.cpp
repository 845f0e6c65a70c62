// Texture coordinate sets: a mesh carries the two that its material uses, whatever their numbers in the file.
#include <gtest/gtest.h>

#include "gltf_support.h"

namespace lumi {
namespace {

using test::GltfBuilder;

const char* const kPixel =
    "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mP8z8BQDwAEhQGAhKmMIQAAAABJRU5Erk"
    "Jggg==";

/// A triangle with four sets, set n beginning at (n, n), and a material that uses those named.
void build(GltfBuilder& file, const std::vector<int>& sets) {
    file.triangle();
    for (int set = 0; set < 4; ++set) {
        const float n = static_cast<float>(set);
        file.primitive()["attributes"]["TEXCOORD_" + std::to_string(set)] = file.floats({n, n, 1, 0, 0, 1}, "VEC2", 2);
    }
    file.primitive()["material"] = 0;
    file.json["images"] = {{{"uri", kPixel}}};
    file.json["textures"] = {{{"source", 0}}};
    nlohmann::json material;
    const auto texture = [&](size_t i) { return nlohmann::json{{"index", 0}, {"texCoord", sets[i]}}; };
    material["pbrMetallicRoughness"]["baseColorTexture"] = texture(0);
    if (sets.size() > 1) material["emissiveTexture"] = texture(1);
    if (sets.size() > 2) material["pbrMetallicRoughness"]["metallicRoughnessTexture"] = texture(2);
    file.json["materials"] = {material};
}

Vec2 firstUv(const Scene& scene, const Texture& texture) { return scene.instances.at(0).mesh->uv[texture.uvSet].at(0); }

TEST(GltfUvSets, AnyTwoOfManyAreCarried) {
    for (const std::vector<int>& sets : {std::vector<int>{0, 1}, {1, 0}, {3, 2}, {0, 3}, {2, 2}}) {
        GltfBuilder file;
        build(file, sets);
        MessageLog log;
        const Scene scene = file.load(log);
        EXPECT_TRUE(log.warnings().empty());
        const Material& m = scene.materials[0];
        EXPECT_EQ(firstUv(scene, m.baseColorTexture), Vec2(static_cast<float>(sets[0])));
        EXPECT_EQ(firstUv(scene, m.emissionTexture), Vec2(static_cast<float>(sets[1])));
    }
}

TEST(GltfUvSets, AThirdIsReported) {
    GltfBuilder file;
    build(file, {3, 1, 2});
    MessageLog log;
    const Scene scene = file.load(log);
    ASSERT_EQ(log.warnings().size(), 1u);
    EXPECT_NE(log.warnings()[0].find("more than two sets"), std::string::npos);
    EXPECT_EQ(firstUv(scene, scene.materials[0].baseColorTexture), Vec2(1)) << "the first in use stands in";
}

TEST(GltfUvSets, OneThatIsMissingIsReported) {
    GltfBuilder file;
    build(file, {0, 1});
    file.primitive()["attributes"].erase("TEXCOORD_1");
    file.json["materials"][0]["name"] = "shown";
    MessageLog log;
    file.load(log);
    ASSERT_EQ(log.warnings().size(), 1u);
    for (const char* part : {"/meshes/0/primitives/0", "\"shown\"", "TEXCOORD_1", "missing"})
        EXPECT_NE(log.warnings()[0].find(part), std::string::npos) << log.warnings()[0];
}

TEST(GltfUvSets, PrimitivesOverTheSameVerticesMayUseDifferentSets) {
    GltfBuilder file;
    build(file, {2});
    nlohmann::json other = file.primitive();
    other["material"] = 1;
    file.json["meshes"][0]["primitives"].push_back(other);
    nlohmann::json second = file.json["materials"][0];
    second["pbrMetallicRoughness"]["baseColorTexture"]["texCoord"] = 3;
    file.json["materials"].push_back(second);
    const Scene scene = file.load();
    const Mesh& mesh = *scene.instances.at(0).mesh;
    EXPECT_EQ(mesh.positions.size(), 6u);
    for (uint32_t t = 0; t < 2; ++t) EXPECT_EQ(mesh.uv[0][mesh.triangles[t].x], Vec2(t == 0 ? 2.0f : 3.0f));
}

/// A square in the plane z = 0 in two triangles, with u along +y in set 0 and along -x in set 1.
nlohmann::json square(GltfBuilder& file, float z) {
    nlohmann::json primitive;
    primitive["attributes"]["POSITION"] = file.floats({0, 0, z, 1, 0, z, 1, 1, z, 0, 1, z}, "VEC3", 3);
    primitive["attributes"]["NORMAL"] = file.floats({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3", 3);
    primitive["attributes"]["TEXCOORD_0"] = file.floats({0, 0, 0, 1, 1, 1, 1, 0}, "VEC2", 2);
    primitive["attributes"]["TEXCOORD_1"] = file.floats({1, 0, 0, 0, 0, 1, 1, 1}, "VEC2", 2);
    primitive["indices"] = file.indices({0, 1, 2, 0, 2, 3});
    return primitive;
}

/// One mesh of squares, each with a material of its own.
Mesh squares(const std::vector<nlohmann::json>& materials, bool sameVertices = false) {
    GltfBuilder file;
    file.json["images"] = {{{"uri", kPixel}}};
    file.json["textures"] = {{{"source", 0}}};
    file.json["materials"] = materials;
    file.json["meshes"] = {{{"primitives", nlohmann::json::array()}}};
    for (size_t i = 0; i < materials.size(); ++i) {
        nlohmann::json next =
            sameVertices && i > 0 ? file.json["meshes"][0]["primitives"][0] : square(file, static_cast<float>(i));
        next["material"] = i;
        file.json["meshes"][0]["primitives"].push_back(next);
    }
    return *file.load().instances.at(0).mesh;
}

void expectTangent(const Mesh& mesh, uint32_t material, const Vec3& along) {
    ASSERT_FALSE(mesh.tangents.empty());
    int corners = 0;
    for (uint32_t t = 0; t < mesh.triangles.size(); ++t)
        for (int c = 0; c < 3 && mesh.materialOf(t) == material; ++c, ++corners)
            EXPECT_LT(glm::distance(Vec3(mesh.tangents[mesh.triangles[t][c]]), along), 1e-5f)
                << "material " << material;
    EXPECT_EQ(corners, 6);
}

const nlohmann::json kNormalMap = {{"normalTexture", {{"index", 0}}}};
const nlohmann::json kOtherNormalMap = {{"normalTexture", {{"index", 0}, {"texCoord", 1}}}};
nlohmann::json extended(const char* name, const nlohmann::json& values) { return {{"extensions", {{name, values}}}}; }

TEST(GltfTangents, AnisotropyAndClearcoatFollowTheirCoordinates) {
    const nlohmann::json anisotropic = extended("KHR_materials_anisotropy", {{"anisotropyStrength", 1}});
    const nlohmann::json coated =
        extended("KHR_materials_clearcoat",
                 {{"clearcoatFactor", 1}, {"clearcoatNormalTexture", {{"index", 0}, {"texCoord", 1}}}});
    // Alone, and beside a part with a normal map, which must not turn them.
    expectTangent(squares({anisotropic}), 0, {0, 1, 0});
    expectTangent(squares({coated}), 0, {-1, 0, 0});
    const Mesh both = squares({anisotropic, kNormalMap, coated, {{"name", "plain"}}});
    expectTangent(both, 0, {0, 1, 0});
    expectTangent(both, 1, {0, 1, 0});
    expectTangent(both, 2, {-1, 0, 0});
    expectTangent(both, 3, {0, 1, 0});
}

TEST(GltfTangents, NormalMapsOfDifferentSetsOverTheSameVertices) {
    const Mesh mesh = squares({kNormalMap, kOtherNormalMap}, true);
    expectTangent(mesh, 0, {0, 1, 0});
    expectTangent(mesh, 1, {-1, 0, 0});
    EXPECT_EQ(mesh.positions.size(), 8u);
    // What needs no tangents of its own shares with either.
    EXPECT_EQ(squares({kNormalMap, {{"name", "plain"}}}, true).positions.size(), 4u);
    EXPECT_EQ(squares({{{"name", "plain"}}, kOtherNormalMap}, true).positions.size(), 4u);
}

TEST(GltfTangents, PartsWithoutNormalsAreFlatBesideOthers) {
    GltfBuilder file;
    file.json["images"] = {{{"uri", kPixel}}};
    file.json["textures"] = {{{"source", 0}}};
    file.json["materials"] = {kNormalMap, {{"name", "plain"}}};
    nlohmann::json mapped = square(file, 0), plain = square(file, 1);
    mapped["material"] = 0, plain["material"] = 1;
    mapped["attributes"].erase("NORMAL"), plain["attributes"].erase("NORMAL");
    file.json["meshes"] = {{{"primitives", {mapped, plain}}}};
    const Scene scene = file.load();
    EXPECT_EQ(scene.instances.at(0).mesh->normals, std::vector<Vec3>(12, Vec3(0, 0, 1)));
}

}  // namespace
}  // namespace lumi
