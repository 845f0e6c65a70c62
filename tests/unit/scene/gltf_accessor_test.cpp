#include <gtest/gtest.h>

#include "gltf_support.h"

namespace lumi {
namespace {

using test::GltfBuilder;

const Mesh& meshOf(const Scene& scene) { return *scene.instances.at(0).mesh; }

TEST(GltfAccessor, InterleavedAttributes) {
    GltfBuilder file;
    // Position and normal, 24 bytes a vertex.
    const std::vector<float> vertices{0, 0, 0, 0, 0, 1, 1, 0, 0, 0, 0, 2, 0, 1, 0, 0, 3, 0};
    const int view = file.view(vertices.data(), vertices.size() * 4, 24);
    for (const int offset : {0, 12})
        file.json["accessors"].push_back(
            {{"bufferView", view}, {"byteOffset", offset}, {"componentType", 5126}, {"count", 3}, {"type", "VEC3"}});
    file.json["meshes"].push_back({{"primitives", {{{"attributes", {{"POSITION", 0}, {"NORMAL", 1}}}}}}});
    const Scene scene = file.load();
    const Mesh& mesh = meshOf(scene);
    EXPECT_EQ(mesh.positions[1], Vec3(1, 0, 0));
    EXPECT_EQ(mesh.normals[1], Vec3(0, 0, 1)) << "normals come out unit";
    EXPECT_EQ(mesh.normals[2], Vec3(0, 1, 0));
    EXPECT_EQ(mesh.triangles.size(), 1u) << "no indices: the vertices in their order";
}

TEST(GltfAccessor, NormalisedIntegers) {
    GltfBuilder file;
    file.triangle();
    const int uv = file.accessor<uint16_t>({0, 65535, 32768, 0, 0, 0}, "VEC2", 2, 5123);
    const int colour = file.accessor<uint8_t>({255, 0, 51, 255, 0, 0, 0, 0, 255, 255, 255, 128}, "VEC4", 4, 5121);
    for (const int i : {uv, colour}) file.json["accessors"][static_cast<size_t>(i)]["normalized"] = true;
    file.primitive()["attributes"]["TEXCOORD_0"] = uv;
    file.primitive()["attributes"]["COLOR_0"] = colour;
    const Scene scene = file.load();
    EXPECT_EQ(meshOf(scene).uv[0][0], Vec2(0, 1));
    EXPECT_NEAR(meshOf(scene).uv[0][1].x, 32768.0f / 65535, 1e-7f);
    EXPECT_NEAR(meshOf(scene).colours[0].z, 0.2f, 1e-6f);
    EXPECT_NEAR(meshOf(scene).colours[2].w, 128.0f / 255, 1e-6f);
}

TEST(GltfAccessor, ColoursOfPlainIntegersAreReadAsNormalised) {
    for (const int components : {3, 4}) {
        GltfBuilder file;
        file.triangle();
        const std::vector<uint16_t> values(3 * static_cast<size_t>(components), 13107);
        file.primitive()["attributes"]["COLOR_0"] =
            file.accessor(values, components == 3 ? "VEC3" : "VEC4", components, 5123);
        MessageLog log;
        const Scene scene = file.load(log);
        EXPECT_NEAR(meshOf(scene).colours[0].x, 0.2f, 1e-6f);
        EXPECT_NEAR(meshOf(scene).colours[2].w, components == 3 ? 1 : 0.2f, 1e-6f);
        ASSERT_EQ(log.warnings().size(), 1u);
        EXPECT_NE(log.warnings()[0].find("/attributes/COLOR_0: integers"), std::string::npos) << log.warnings()[0];
    }
}

TEST(GltfAccessor, QuantizedPositionsAndSignedNormals) {
    GltfBuilder file;
    const int p = file.accessor<int16_t>({0, 0, 0, 0, 100, 0, 0, 0, 0, 50, 0, 0}, "VEC3", 4, 5122);
    file.json["accessors"][0]["count"] = 3;
    file.json["bufferViews"][0]["byteStride"] = 8;
    const int n = file.accessor<int8_t>({0, 0, 127, 0, 0, 0, -128, 0, 0, 0, -127, 0}, "VEC3", 4, 5120);
    file.json["accessors"][1]["count"] = 3;
    file.json["accessors"][1]["normalized"] = true;
    file.json["bufferViews"][1]["byteStride"] = 4;
    file.json["meshes"].push_back({{"primitives", {{{"attributes", {{"POSITION", p}, {"NORMAL", n}}}}}}});
    const Scene scene = file.load();
    EXPECT_EQ(meshOf(scene).positions[1], Vec3(100, 0, 0));
    EXPECT_EQ(meshOf(scene).normals[1], Vec3(0, 0, -1));
    EXPECT_EQ(meshOf(scene).normals[2], Vec3(0, 0, -1));
}

TEST(GltfAccessor, SparseElementsReplaceOthers) {
    GltfBuilder file;
    file.triangle();
    const std::vector<uint8_t> places{2};
    const std::vector<float> values{5, 6, 7};
    const int indices = file.view(places.data(), 1), replacements = file.view(values.data(), 12);
    file.json["accessors"][0]["sparse"] = {{"count", 1},
                                           {"indices", {{"bufferView", indices}, {"componentType", 5121}}},
                                           {"values", {{"bufferView", replacements}}}};
    const Scene scene = file.load();
    EXPECT_EQ(meshOf(scene).positions[2], Vec3(5, 6, 7));
    EXPECT_EQ(meshOf(scene).positions[1], Vec3(1, 0, 0));
}

TEST(GltfAccessor, NoSparseElementReplacesNone) {
    GltfBuilder file;
    file.triangle();
    const std::vector<float> values{5, 6, 7};
    const int view = file.view(values.data(), 12);
    file.json["accessors"][0]["sparse"] = {
        {"count", 0}, {"indices", {{"bufferView", view}, {"componentType", 5121}}}, {"values", {{"bufferView", view}}}};
    EXPECT_EQ(meshOf(file.load()).positions[1], Vec3(1, 0, 0));
}

TEST(GltfAccessor, SparseOverNothingIsZero) {
    GltfBuilder file;
    file.triangle();
    const std::vector<uint16_t> places{1};
    const std::vector<float> values{0, 0, 9};
    const int indices = file.view(places.data(), 2), replacements = file.view(values.data(), 12);
    file.json["accessors"].push_back({{"componentType", 5126},
                                      {"count", 3},
                                      {"type", "VEC3"},
                                      {"sparse",
                                       {{"count", 1},
                                        {"indices", {{"bufferView", indices}, {"componentType", 5123}}},
                                        {"values", {{"bufferView", replacements}}}}}});
    file.primitive()["targets"] = {{{"POSITION", 2}}};
    const Scene scene = file.load();
    ASSERT_EQ(meshOf(scene).morphTargets.size(), 1u);
    EXPECT_EQ(meshOf(scene).morphTargets[0].positions[0], Vec3(0));
    EXPECT_EQ(meshOf(scene).morphTargets[0].positions[1], Vec3(0, 0, 9));
}

TEST(GltfAccessor, IndicesOfEveryWidth) {
    const auto check = [](auto type, int componentType) {
        GltfBuilder file;
        file.triangle();
        file.primitive()["indices"] = file.accessor<decltype(type)>({2, 1, 0}, "SCALAR", 1, componentType);
        const Scene scene = file.load();
        EXPECT_EQ(meshOf(scene).triangles[0], UVec3(2, 1, 0)) << componentType;
    };
    check(uint8_t(0), 5121);
    check(uint16_t(0), 5123);
    check(uint32_t(0), 5125);
}

TEST(GltfAccessor, RangesAreChecked) {
    const auto refused = [](const std::function<void(GltfBuilder&)>& breakIt,
                            const std::initializer_list<std::string>& parts) {
        GltfBuilder file;
        file.triangle();
        breakIt(file);
        file.expectRefused(parts);
    };
    refused([](auto& f) { f.json["accessors"][0]["count"] = 4; }, {"test.glb: /accessors/0", "past the end"});
    refused([](auto& f) { f.json["accessors"][0]["count"] = 4000000000u; }, {"/accessors/0", "past the end"});
    refused([](auto& f) { f.json["accessors"][0]["count"] = 1000000000000000ull; }, {"/accessors/0/count", "absurd"});
    refused([](auto& f) { f.json["accessors"][0]["byteOffset"] = 1; }, {"/accessors/0"});
    refused([](auto& f) { f.json["accessors"][0]["byteOffset"] = 18446744073709551615ull; }, {"/accessors/0"});
    refused([](auto& f) { f.json["accessors"][0]["type"] = "VEC2"; }, {"POSITION", "wrong type", "3 components"});
    refused([](auto& f) { f.json["accessors"][0]["componentType"] = 5130; }, {"componentType", "found 5130"});
    refused([](auto& f) { f.json["accessors"][0]["bufferView"] = 7; }, {"/accessors/0/bufferView", "0 to 1", "7"});
    refused([](auto& f) { f.json["bufferViews"][0]["buffer"] = 3; }, {"/bufferViews/0/buffer"});
    refused([](auto& f) { f.json["bufferViews"][0]["byteLength"] = 100000; }, {"/bufferViews/0", "past the end"});
    refused([](auto& f) { f.json["bufferViews"][0]["byteOffset"] = 18446744073709551612ull; }, {"/bufferViews/0"});
    refused([](auto& f) { f.primitive()["attributes"]["POSITION"] = 99; },
            {"/meshes/0/primitives/0/attributes/POSITION", "99"});
    refused([](auto& f) { f.primitive()["indices"] = 0; }, {"/indices"});
    refused([](auto& f) { f.primitive()["indices"] = f.indices({0, 1, 3}); }, {"/indices", "below 3", "found 3"});
    refused(
        [](auto& f) {
            f.primitive()["attributes"]["NORMAL"] = f.floats({0, 0, 1}, "VEC3", 3);
        },
        {"NORMAL", "count"});
    refused([](auto& f) { f.primitive()["mode"] = 9; }, {"/mode", "9"});
    refused([](auto& f) { f.primitive()["material"] = 2; }, {"/material"});
    refused(
        [](auto& f) {
            f.json["accessors"][0].erase("bufferView");
            f.json["accessors"][0]["count"] = 4000000000u;
        },
        {"/attributes/POSITION", "absurd count", "4000000000"});
}

TEST(GltfAccessor, IndicesMayBeSparseAlone) {
    GltfBuilder file;
    file.triangle();
    const std::vector<uint16_t> places{1, 2}, values{1, 2};
    const int placesView = file.view(places.data(), 4), valuesView = file.view(values.data(), 4);
    file.json["accessors"].push_back({{"componentType", 5123},
                                      {"count", 3},
                                      {"type", "SCALAR"},
                                      {"sparse",
                                       {{"count", 2},
                                        {"indices", {{"bufferView", placesView}, {"componentType", 5123}}},
                                        {"values", {{"bufferView", valuesView}}}}}});
    file.primitive()["indices"] = file.json["accessors"].size() - 1;
    const Scene scene = file.load();
    EXPECT_EQ(scene.instances.at(0).mesh->triangles, (std::vector<UVec3>{{0, 1, 2}}));
}

TEST(GltfAccessor, SparseRangesAreChecked) {
    const auto refused = [](const std::function<void(nlohmann::json&)>& breakIt, const std::string& part) {
        GltfBuilder file;
        file.triangle();
        const std::vector<uint8_t> places{2};
        const std::vector<float> values{5, 6, 7};
        const int indices = file.view(places.data(), 1), replacements = file.view(values.data(), 12);
        nlohmann::json& sparse = file.json["accessors"][0]["sparse"];
        sparse = {{"count", 1},
                  {"indices", {{"bufferView", indices}, {"componentType", 5121}}},
                  {"values", {{"bufferView", replacements}}}};
        breakIt(sparse);
        file.expectRefused({part});
    };
    refused([](auto& s) { s["count"] = 2; }, "sparse");
    refused([](auto& s) { s["count"] = -1; }, "/accessors/0/sparse/count");
    refused([](auto& s) { s["indices"]["byteOffset"] = -4; }, "/accessors/0/sparse/indices/byteOffset");
    refused([](auto& s) { s["indices"]["bufferView"] = 66; }, "66");
    refused([](auto& s) { s["values"]["byteOffset"] = 4; }, "past the end");
    refused([](auto& s) { s["indices"]["bufferView"] = 0, s["indices"]["byteOffset"] = 14; },
            "elements of the accessor");
}

}  // namespace
}  // namespace lumi
