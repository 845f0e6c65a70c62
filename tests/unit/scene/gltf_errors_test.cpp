#include <gtest/gtest.h>

#include "gltf_support.h"

namespace lumi {
namespace {

using test::expectError;
using test::GltfBuilder;
using test::TemporaryFolder;

void expectFileRefused(const std::string& name, const std::vector<uint8_t>& bytes,
                       const std::initializer_list<std::string>& parts) {
    TemporaryFolder folder;
    writeFileAtomically(folder / name, bytes);
    MessageLog log;
    expectError(
        ErrorKind::BadInput, [&] { loadGltf(folder / name, log); }, parts);
}

std::vector<uint8_t> bytesOf(const std::string& text) { return {text.begin(), text.end()}; }

TEST(GltfErrors, TruncatedGlbAtEveryLength) {
    GltfBuilder file;
    file.triangle();
    const std::vector<uint8_t> whole = file.glb();
    for (size_t length = 0; length < whole.size(); length += 3)
        expectFileRefused("cut.glb", {whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(length)}, {"cut.glb"});
}

TEST(GltfErrors, EveryByteOfTheGlbHeaderMatters) {
    GltfBuilder file;
    file.triangle();
    const std::vector<uint8_t> whole = file.glb();
    for (size_t i = 0; i < 20; ++i) {
        std::vector<uint8_t> broken = whole;
        broken[i] ^= 0x80;
        TemporaryFolder folder;
        writeFileAtomically(folder / "broken.glb", broken);
        MessageLog log;
        EXPECT_THROW(loadGltf(folder / "broken.glb", log), Error) << "byte " << i;
    }
}

TEST(GltfErrors, NotAGlb) {
    expectFileRefused("text.glb", bytesOf("hello, this is not a binary file at all"), {"text.glb", "glTF"});
    expectFileRefused("empty.gltf", {}, {"empty.gltf"});
    expectFileRefused("array.gltf", bytesOf("[1, 2, 3]"), {"array.gltf"});
    expectFileRefused("old.gltf", bytesOf("{}      "), {"old.gltf", "asset"});
}

TEST(GltfErrors, JsonFaultsHaveLineAndColumn) {
    expectFileRefused("bad.gltf", bytesOf("{\n  \"asset\": {\"version\": \"2.0\"},\n  \"nodes\": [}\n}"),
                      {"bad.gltf:3:13"});
}

TEST(GltfErrors, DeepJsonIsRefusedBeforeItIsParsed) {
    const std::string deep =
        "{\"asset\":{\"version\":\"2.0\"},\"extras\":" + std::string(200000, '[') + std::string(200000, ']') + "}";
    expectFileRefused("deep.gltf", bytesOf(deep), {"deep.gltf", "nested too deeply"});
}

TEST(GltfErrors, MissingFileAndFolder) {
    TemporaryFolder folder;
    MessageLog log;
    expectError(ErrorKind::BadInput, [&] { loadGltf(folder / "none.gltf", log); }, {"none.gltf"});
    std::filesystem::create_directory(folder / "folder.gltf");
    expectError(ErrorKind::BadInput, [&] { loadGltf(folder / "folder.gltf", log); }, {"folder.gltf"});
}

TEST(GltfErrors, MissingBufferIsNamed) {
    expectFileRefused("a.gltf",
                      bytesOf(R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":4,"uri":"no%20such.bin"}]})"),
                      {"a.gltf", "no such.bin", "does not exist"});
}

TEST(GltfErrors, BuffersThatAreNoFilesSayWhatTheyAre) {
    TemporaryFolder folder;
    std::filesystem::create_directory(folder / "all");
    std::filesystem::create_symlink("/dev/zero", folder / "zero");
    for (const auto& [name, what] :
         {std::pair("all", "\"all\" is a directory"), {"zero", "\"zero\" is not a regular file"}}) {
        writeFileAtomically(folder / "a.gltf", R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":4,"uri":")" +
                                                   std::string(name) + "\"}]}");
        MessageLog log;
        expectError(ErrorKind::BadInput, [&] { loadGltf(folder / "a.gltf", log); }, {"a.gltf", what});
    }
}

TEST(GltfErrors, NamesThatLeadOutOfTheFolder) {
    for (const std::string uri : {"../secret.bin", "/etc/hostname", "a/../../secret.bin", "%2e%2e/secret.bin",
                                  "file:///etc/hostname", "http://example.org/x.bin"})
        expectFileRefused("a.gltf",
                          bytesOf(R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":4,"uri":")" + uri + "\"}]}"),
                          {"a.gltf", "leads out"});
}

TEST(GltfErrors, CyclesAndSharedChildren) {
    GltfBuilder self;
    self.triangle();
    self.json["nodes"][0]["children"] = {0};
    self.expectRefused({"/nodes/0", "own ancestor"});

    GltfBuilder ring;
    ring.triangle();
    ring.json["nodes"] = {{{"children", {1}}}, {{"children", {2}}}, {{"children", {0}}}};
    ring.expectRefused({"/nodes/0", "own ancestor"});

    GltfBuilder shared;
    shared.triangle();
    shared.json["nodes"] = {{{"children", {1, 2}}}, {{"children", {2}}}, {{"mesh", 0}}};
    shared.expectRefused({"/nodes/2", "two parents"});
}

TEST(GltfErrors, LongChainsOfNodesAreNoStackOverflow) {
    GltfBuilder file;
    file.triangle();
    constexpr int kCount = 50000;
    nlohmann::json nodes = nlohmann::json::array();
    for (int i = 0; i + 1 < kCount; ++i) nodes.push_back({{"children", {i + 1}}});
    nodes.push_back({{"mesh", 0}});
    file.json["nodes"] = nodes;
    EXPECT_EQ(file.load().nodes.size(), size_t(kCount));
}

/// A file with one triangle that `breakIt` has spoilt is refused with a message of these parts.
void expectRefused(const std::function<void(GltfBuilder&)>& breakIt, const std::initializer_list<std::string>& parts) {
    GltfBuilder file;
    file.triangle();
    breakIt(file);
    file.expectRefused(parts);
}

TEST(GltfErrors, BadIndicesInTheTree) {
    expectRefused([](auto& f) { f.json["nodes"][0]["mesh"] = 12; }, {"/nodes/0/mesh", "expected 0 to 0", "found 12"});
    expectRefused([](auto& f) { f.json["nodes"][0]["children"] = {-2}; }, {"/nodes/0/children/0"});
    expectRefused([](auto& f) { f.json["nodes"][0]["camera"] = 0; }, {"/nodes/0/camera", "no cameras"});
    expectRefused([](auto& f) { f.json["scene"] = 5; }, {"/scene"});
    expectRefused([](auto& f) { f.json["scenes"][0]["nodes"] = {0, 7}; }, {"/scenes/0/nodes/1", "7"});
    expectRefused(
        [](auto& f) {
            f.json["nodes"][0]["translation"] = {1, 2};
        },
        {"/nodes/0/translation", "wrong length"});
    expectRefused([](auto& f) { f.json["nodes"][0]["scale"] = {1, 1e300, 1}; }, {"/nodes/0/scale", "finite"});
    expectRefused([](auto& f) { f.json["nodes"][0]["skin"] = 1; }, {"/nodes/0/skin"});
    expectRefused([](auto& f) { f.json["nodes"][0]["extensions"]["KHR_lights_punctual"]["light"] = 4; },
                  {"/nodes/0", "light"});
    expectRefused(
        [](auto& f) {
            f.json["materials"] = {{{"normalTexture", {{"index", 3}}}}};
            f.primitive()["material"] = 0;
        },
        {"/materials/0/normalTexture/index", "3"});
}

TEST(GltfErrors, PositionsThatAreNotFinite) {
    GltfBuilder file;
    file.triangle();
    const float bad = std::numeric_limits<float>::quiet_NaN();
    std::memcpy(file.bin.data() + 16, &bad, 4);
    file.expectRefused({"POSITION", "vertex 1", "nan"});
}

TEST(GltfErrors, RequiredExtensionsAreRefusedByName) {
    GltfBuilder file;
    file.triangle();
    file.json["extensionsUsed"] = {"ACME_future"};
    file.json["extensionsRequired"] = {"ACME_future"};
    file.expectRefused({"/extensionsRequired/0", "ACME_future"});
    file.json.erase("extensionsRequired");
    MessageLog log;
    file.load(log);
    ASSERT_EQ(log.warnings().size(), 1u);
    EXPECT_NE(log.warnings()[0].find("ACME_future"), std::string::npos);
}

TEST(GltfErrors, MissingAndDamagedTexturesAreWarnings) {
    for (const char* image : {"no%20such.png", "damaged.png", "data:image/png;base64,AAAA"}) {
        TemporaryFolder folder;
        GltfBuilder file;
        file.triangle();
        file.json["images"] = {{{"uri", image}}};
        file.json["textures"] = {{{"source", 0}}};
        file.json["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
        file.primitive()["material"] = 0;
        file.primitive()["attributes"]["TEXCOORD_0"] = file.floats({0, 0, 1, 0, 0, 1}, "VEC2", 2);
        writeFileAtomically(folder / "damaged.png", std::string_view("not an image"));
        writeFileAtomically(folder / "a.glb", file.glb());
        MessageLog log;
        const Scene scene = loadGltf(folder / "a.glb", log);
        ASSERT_EQ(log.warnings().size(), 1u) << image;
        EXPECT_NE(log.warnings()[0].find("stand-in"), std::string::npos) << log.warnings()[0];
        EXPECT_NE(log.warnings()[0].find("/images/0"), std::string::npos) << log.warnings()[0];
        ASSERT_TRUE(scene.materials[0].baseColorTexture);
        EXPECT_GT(scene.materials[0].baseColorTexture.sample({0.1f, 0.1f}).x, 0);
    }
}

/// Index of a new accessor that stands for `count` zeros, which cost the file nothing.
int zeros(GltfBuilder& file, size_t count, const char* type = "VEC3") {
    file.json["accessors"].push_back({{"componentType", 5126}, {"count", count}, {"type", type}});
    return static_cast<int>(file.json["accessors"].size()) - 1;
}

TEST(GltfCounts, VerticesWithoutDataAreFew) {
    GltfBuilder one;
    one.triangle();
    one.primitive()["attributes"]["POSITION"] = zeros(one, 1000000);
    one.expectRefused({"/meshes/0/primitives/0/attributes/POSITION", "absurd count", "at most", "1000000"});

    // As many as one may, and again and again.
    GltfBuilder many;
    many.triangle();
    const nlohmann::json primitive = many.primitive();
    for (int i = 0; i < 4; ++i) {
        nlohmann::json other = primitive;
        other["attributes"]["POSITION"] = zeros(many, 30000);
        many.json["meshes"][0]["primitives"].push_back(other);
    }
    many.expectRefused({"/meshes/0/primitives/3/attributes/POSITION", "60000 before and 30000 here"});
}

TEST(GltfCounts, KeysWithoutDataAreFew) {
    GltfBuilder file;
    file.triangle();
    const int times = zeros(file, 2000000, "SCALAR"), values = zeros(file, 2000000);
    file.json["animations"] = {{{"samplers", {{{"input", times}, {"output", values}}}},
                                {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "scale"}}}}}}}};
    file.expectRefused({"/animations/0/samplers/0/input", "absurd count", "2000000"});
}

TEST(GltfCounts, AFaceOfManyExpressionsIsSane) {
    GltfBuilder file;
    constexpr size_t kVertices = 20000, kTargets = 60;
    const int positions = file.floats(std::vector<float>(3 * kVertices, 1), "VEC3", 3);
    file.json["meshes"] = {{{"primitives", {{{"attributes", {{"POSITION", positions}}}}}}}};
    for (size_t t = 0; t < kTargets; ++t) file.primitive()["targets"].push_back({{"POSITION", zeros(file, kVertices)}});
    EXPECT_EQ(file.load().instances.at(0).mesh->morphTargets.size(), kTargets);
}

GltfBuilder& instanced(GltfBuilder& file, int translations, int nodes = 1) {
    file.triangle();
    nlohmann::json node = {{"mesh", 0}};
    node["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["TRANSLATION"] = translations;
    for (int n = 0; n < nodes; ++n) file.json["nodes"][static_cast<size_t>(n)] = node;
    for (int n = 1; n < nodes; ++n) file.json["scenes"][0]["nodes"].push_back(n);
    return file;
}

TEST(GltfCounts, InstancesAreFewForASmallFile) {
    GltfBuilder bare;
    instanced(bare, zeros(bare, 1000000))
        .expectRefused({"/nodes/0/extensions/EXT_mesh_gpu_instancing", "absurd count of instances", "1000000"});
    GltfBuilder shared;
    const int translations = shared.floats(std::vector<float>(3 * 2000, 0), "VEC3", 3);
    instanced(shared, translations, 100).expectRefused({"EXT_mesh_gpu_instancing", "absurd count of instances"});
    GltfBuilder sane;
    const int few = sane.floats(std::vector<float>(3 * 2000, 0), "VEC3", 3);
    EXPECT_EQ(instanced(sane, few, 20).load().instances.size(), 40000u);
}

TEST(GltfCounts, InstancesTakeNoMoreRoomThanTheyNeed) {
    GltfBuilder file;
    const Scene scene = instanced(file, zeros(file, 40000)).load();
    ASSERT_EQ(scene.instances.size(), 40000u);
    EXPECT_EQ(scene.instances.capacity(), 40000u);
    EXPECT_LE(scene.nodes.capacity(), 40001u);
}

TEST(GltfErrors, VersionsThatAreNotRead) {
    expectRefused([](auto& f) { f.json["asset"]["version"] = "3.0"; }, {"/asset/version", "\"3.0\""});
    expectRefused([](auto& f) { f.json["asset"]["minVersion"] = "2.1"; }, {"/asset/minVersion", "newer", "\"2.1\""});
    GltfBuilder newer;
    newer.triangle();
    newer.json["asset"] = {{"version", "2.1"}, {"minVersion", "2.0"}};
    EXPECT_EQ(newer.load().instances.size(), 1u);
}

TEST(GltfErrors, WordsThatTheSpecificationDoesNotKnow) {
    expectRefused(
        [](auto& f) {
            f.json["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}}, {{"type", "weird"}}};
            f.json["nodes"][0]["extensions"]["KHR_lights_punctual"]["light"] = 1;
        },
        {"/extensions/KHR_lights_punctual/lights/1/type", "weird"});
    expectRefused(
        [](auto& f) {
            const int times = f.floats({0, 1}, "SCALAR", 1), values = f.floats({1, 1, 1, 2, 2, 2}, "VEC3", 3);
            f.json["animations"] = {{{"samplers", {{{"input", times}, {"output", values}, {"interpolation", "BOGUS"}}}},
                                     {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "scale"}}}}}}}};
        },
        {"/animations/0/samplers/0/interpolation", "BOGUS"});
}

TEST(GltfErrors, ElementsThatOverlapOrCountInFloats) {
    expectRefused([](auto& f) { f.json["bufferViews"][0]["byteStride"] = 4; },
                  {"/bufferViews/0/byteStride", "found 4"});
    expectRefused(
        [](auto& f) {
            const float zero = 0, value[3] = {1, 2, 3};
            const int indices = f.view(&zero, 4), values = f.view(value, 12);
            f.json["accessors"][0]["sparse"] = {{"count", 1},
                                                {"indices", {{"bufferView", indices}, {"componentType", 5126}}},
                                                {"values", {{"bufferView", values}}}};
        },
        {"/accessors/0/sparse/indices/componentType", "5126"});
}

TEST(GltfErrors, WeightsForTargetsThatAreNotThere) {
    expectRefused(
        [](auto& f) {
            const int times = f.floats({0, 1}, "SCALAR", 1),
                      weights = f.floats(std::vector<float>(200, 0), "SCALAR", 1);
            f.primitive()["targets"] = {{{"POSITION", f.primitive()["attributes"]["POSITION"]}}};
            f.json["animations"] = {{{"samplers", {{{"input", times}, {"output", weights}}}},
                                     {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "weights"}}}}}}}};
        },
        {"/animations/0/samplers/0/output", "expected 1", "found 100"});
}

TEST(GltfErrors, MorphedCoordinatesAreReported) {
    GltfBuilder file;
    file.triangle();
    const int uv = file.floats({0, 0, 1, 0, 0, 1}, "VEC2", 2);
    file.primitive()["attributes"]["TEXCOORD_0"] = uv;
    file.primitive()["targets"] = {{{"TEXCOORD_0", uv}}, {{"TEXCOORD_0", uv}}};
    MessageLog log;
    file.load(log);
    ASSERT_EQ(log.warnings().size(), 1u);
    EXPECT_NE(log.warnings()[0].find("morph targets of TEXCOORD are left out"), std::string::npos);
}

TEST(GltfErrors, VariantsAreCheckedWhetherChosenOrNot) {
    expectRefused(
        [](auto& f) {
            f.json["materials"] = {{{"name", "red"}}};
            f.json["extensions"]["KHR_materials_variants"]["variants"] = {{{"name", "a"}}};
            f.primitive()["extensions"]["KHR_materials_variants"]["mappings"] = {{{"material", 77}, {"variants", {0}}}};
        },
        {"/meshes/0/primitives/0/extensions/KHR_materials_variants/mappings/0/material", "77"});
}

TEST(GltfErrors, OfManyFaultsTheFirstAreListed) {
    GltfBuilder file;
    file.triangle();
    for (int i = 0; i < 1000; ++i)
        file.json["meshes"][0]["primitives"].push_back({{"attributes", {{"_OWN" + std::to_string(i), 0}}}});
    MessageLog log;
    EXPECT_EQ(file.load(log).triangleCount(), 1);
    ASSERT_EQ(log.warnings().size(), 201u);
    EXPECT_EQ(log.warnings().back(), "test.glb: and 800 more faults");
}

TEST(GltfErrors, StoppedLoadsAreInterrupted) {
    GltfBuilder file;
    file.triangle();
    std::stop_source source;
    LoadOptions options;
    options.stop = source.get_token();
    options.progress = [&](float, const std::string&) { source.request_stop(); };
    MessageLog log;
    expectError(ErrorKind::Interrupted, [&] { file.load(log, options); });
}

}  // namespace
}  // namespace lumi
