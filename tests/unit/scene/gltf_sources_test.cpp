// Where the bytes of buffers and images come from: chunks of a GLB, data URIs, files.
#include <gtest/gtest.h>

#include "gltf_support.h"

namespace lumi {
namespace {

using nlohmann::json;
using test::GltfBuilder;

constexpr uint32_t kJson = 0x4E4F534A, kBinary = 0x004E4942, kUnknown = 0x54584554;
const std::string kHead = "data:application/octet-stream;base64,";
/// Of a triangle's positions; 48 characters.
const std::string kPositions = "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA";
/// A red pixel.
const std::string kPng =
    "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR4nGP4z8DwHwAFAAH/iZk9HQAAAABJRU5ErkJggg==";

json triangle() {
    return {{"asset", {{"version", "2.0"}}},
            {"nodes", {{{"mesh", 0}}}},
            {"meshes", {{{"primitives", {{{"attributes", {{"POSITION", 0}}}}}}}}},
            {"accessors", {{{"bufferView", 0}, {"componentType", 5126}, {"count", 3}, {"type", "VEC3"}}}},
            {"bufferViews", {{{"buffer", 0}, {"byteLength", 36}}}},
            {"buffers", {{{"byteLength", 36}, {"uri", kHead + kPositions}}}}};
}

/// The triangle with a texture of this image.
json textured(const json& image) {
    json file = triangle();
    file["images"] = {image};
    file["textures"] = {{{"source", 0}}};
    file["materials"] = {{{"emissiveFactor", {1, 1, 1}}, {"emissiveTexture", {{"index", 0}}}}};
    file["meshes"][0]["primitives"][0]["material"] = 0;
    file["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] = 1;
    file["accessors"].push_back({{"bufferView", 0}, {"componentType", 5126}, {"count", 3}, {"type", "VEC2"}});
    return file;
}

Scene load(const json& file, MessageLog& log) {
    const test::TemporaryFolder folder;
    writeFileAtomically(folder / "a.gltf", file.dump());
    return loadGltf(folder / "a.gltf", log);
}

struct Chunk {
    uint32_t type;
    std::string bytes;
};

/// Of a GLB of these chunks, with `behind` after the length that it gives.
Scene loadChunks(const std::vector<Chunk>& chunks, const std::string& behind = {}) {
    std::string glb = "glTF";
    const auto add = [&](size_t value) {
        for (int i = 0; i < 4; ++i) glb += static_cast<char>(value >> (8 * i));
    };
    size_t size = 12;
    for (const Chunk& chunk : chunks) size += 8 + chunk.bytes.size();
    add(2), add(size);
    for (const Chunk& chunk : chunks) add(chunk.bytes.size()), add(chunk.type), glb += chunk.bytes;
    glb += behind;
    const test::TemporaryFolder folder;
    writeFileAtomically(folder / "a.glb", glb);
    MessageLog log;
    return loadGltf(folder / "a.glb", log);
}

Chunk jsonOf(const json& file) {
    std::string text = file.dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    return {kJson, text};
}

TEST(GltfSources, EmptyAndUnknownChunksArePassedOver) {
    const Chunk embedded = jsonOf(triangle()), empty{kBinary, {}}, unknown{kUnknown, "any text"};
    for (const std::vector<Chunk>& chunks :
         {std::vector{embedded}, {embedded, empty}, {embedded, unknown}, {embedded, unknown, {kBinary, "four"}}})
        EXPECT_EQ(loadChunks(chunks).triangleCount(), 1);

    json file = triangle();
    file["buffers"][0].erase("uri");
    const Chunk inChunk = jsonOf(file), bytes{kBinary, std::string(36, '\0')};
    EXPECT_GE(loadChunks({inChunk, bytes, unknown}).instances.size(), 1u);
    for (const std::vector<Chunk>& chunks : {std::vector{inChunk}, {inChunk, empty}, {inChunk, unknown, bytes}})
        test::expectError(ErrorKind::BadInput, [&] { loadChunks(chunks); },
                          {"a.glb: /buffers/0/uri: is missing, and the file has no binary chunk"});
    file["buffers"][0]["byteLength"] = 40;
    test::expectError(ErrorKind::BadInput, [&] { loadChunks({jsonOf(file), bytes}); }, {"/buffers/0/byteLength"});
}

TEST(GltfSources, BytesBehindTheFileAreNotRead) {
    json file = triangle();
    for (const std::string& behind : {std::string("x"), std::string(3, '\0'), std::string("any\0 text", 9)}) {
        EXPECT_EQ(loadChunks({jsonOf(file)}, behind).triangleCount(), 1);
        file["accessors"][0]["count"] = 3.0;  // the file is written anew
        EXPECT_EQ(loadChunks({jsonOf(file)}, behind).triangleCount(), 1);
        EXPECT_EQ(loadChunks({jsonOf(file), {kBinary, "four"}}, behind).triangleCount(), 1);
    }
}

TEST(GltfSources, DataMayBeEscapedAndBroken) {
    std::string escaped = kPositions, broken = kPositions;
    escaped.replace(escaped.find("CAPw"), 4, "%43AP%77");
    broken.insert(40, "\r\n ").insert(8, " ");
    for (const std::string& data : {kPositions, escaped, broken, escaped + "%3D", kPositions + "==\n"}) {
        json file = triangle();
        file["buffers"][0]["uri"] = kHead + data;
        MessageLog log;
        EXPECT_EQ(load(file, log).restBounds().upper, Vec3(1, 1, 0)) << data;
        EXPECT_TRUE(log.warnings().empty());
    }
    MessageLog log;
    std::string image = kPng;
    image.replace(image.find('/'), 1, "%2F").insert(20, "\n");
    EXPECT_EQ(load(textured({{"uri", "data:image/png;base64," + image}}), log).triangleCount(), 1);
    EXPECT_TRUE(log.warnings().empty()) << log.warnings().front();
}

TEST(GltfSources, OtherCharactersInDataAreNamed) {
    const std::initializer_list<std::pair<const char*, const char*>> kBad = {
        {"-", "\"-\""}, {"_", "\"_\""}, {"*", "\"*\""}, {"%2", "\"%\""}, {"\x01", "\\x01"}};
    for (const auto& [character, shown] : kBad) {
        json file = triangle();
        file["buffers"][0]["uri"] = kHead + " " + std::string(kPositions).insert(20, character);
        MessageLog log;
        test::expectError(
            ErrorKind::BadInput, [&] { load(file, log); },
            {"a.gltf: /buffers/0/uri: the base64", "A to Z", std::string(shown) + " as its character 22"});
        file["buffers"][0]["uri"] = kHead + kPositions + character;
        EXPECT_EQ(load(file, log).triangleCount(), 1) << "behind the buffer's bytes";
    }
    MessageLog log;
    std::string image = "data:image/png;base64," + kPng;
    EXPECT_EQ(load(textured({{"uri", image.replace(image.rfind('/'), 1, "_")}}), log).triangleCount(), 1);
    ASSERT_EQ(log.warnings().size(), 1u);
    EXPECT_NE(log.warnings()[0].find("a.gltf: /images/0: the base64 of the data URI has a character"),
              std::string::npos);
    EXPECT_NE(log.warnings()[0].find("\"_\" as its character"), std::string::npos);
}

TEST(GltfSources, AnEmptyUriIsNone) {
    json file = textured({{"uri", ""}, {"bufferView", 1}, {"mimeType", "image/png"}});
    file["buffers"].push_back({{"uri", "data:image/png;base64," + kPng}, {"byteLength", 70}});
    file["bufferViews"].push_back({{"buffer", 1}, {"byteLength", 70}});
    MessageLog log;
    const Scene scene = load(file, log);
    EXPECT_TRUE(log.warnings().empty()) << log.warnings().front();
    EXPECT_EQ(scene.materials.at(0).emissionTexture.image->levels.at(0).extent.width, 1);
    file["images"][0]["uri"] = "a.png";
    test::expectError(ErrorKind::BadInput, [&] { load(file, log); }, {"/images/0: has both a uri and a bufferView"});
}

TEST(GltfSources, ImagesThatAreNotReadHaveAStandIn) {
    const test::TemporaryFolder folder;
    std::filesystem::create_directory(folder / "model");
    writeFileAtomically(folder / "secret.png", std::string_view("not to be read"));
    for (const auto& [image, reason] :
         {std::pair(json{{"uri", "../secret.png"}}, "\"../secret.png\" leads out of the asset's folder"),
          {{{"uri", "%2e%2e/secret.png"}}, "\"../secret.png\" leads out of the asset's folder"},
          {{{"uri", "https://example.org/a.png"}}, "\"https://example.org/a.png\" leads out"},
          {{{"uri", "/etc/a.png"}}, "\"/etc/a.png\" leads out"},
          {{{"uri", "data:image/png;base64,"}}, "holds no bytes"},
          {{{"uri", ""}}, "has no source, its uri is empty"},
          {{{"name", "it"}}, "has no source"},
          {json::object(), "has no source"}}) {
        writeFileAtomically(folder / "model/a.gltf", textured(image).dump());
        MessageLog log;
        const Scene scene = loadGltf(folder / "model/a.gltf", log);
        ASSERT_EQ(log.warnings().size(), 1u) << image;
        EXPECT_NE(log.warnings()[0].find("a.gltf: /images/0: "), std::string::npos) << log.warnings()[0];
        EXPECT_NE(log.warnings()[0].find(reason), std::string::npos) << log.warnings()[0];
        EXPECT_NE(log.warnings()[0].find("; a stand-in is shown"), std::string::npos) << log.warnings()[0];

        json unused = triangle();
        unused["images"] = {image};
        log.clear();
        EXPECT_EQ(load(unused, log).triangleCount(), 1) << image;
        EXPECT_TRUE(log.warnings().empty());
    }
}

}  // namespace
}  // namespace lumi
