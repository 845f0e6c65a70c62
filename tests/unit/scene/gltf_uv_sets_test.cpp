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

Vec2 firstUv(const Scene& scene, const Texture& texture) {
    return scene.instances.at(0).mesh->uv[texture.uvSet].at(0);
}

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

}  // namespace
}  // namespace lumi
