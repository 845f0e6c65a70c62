// Files whose JSON has another form than glTF's: each is refused in one line with the path of the fault.
#include <gtest/gtest.h>

#include "gltf_support.h"

namespace lumi {
namespace {

using nlohmann::json;
using test::GltfBuilder;

/// A file with something in every section.
GltfBuilder& fill(GltfBuilder& file) {
    file.triangle().primitive()["material"] = 0;
    file.primitive()["attributes"]["TEXCOORD_0"] = file.floats({0, 0, 1, 0, 0, 1}, "VEC2", 2);
    file.primitive()["targets"] = {{{"POSITION", file.primitive()["attributes"]["POSITION"]}}};
    file.json["images"] = {{{"uri", "data:image/png;base64,AAAA"}}};
    file.json["samplers"] = {{{"wrapS", 33071}}};
    file.json["textures"] = {{{"source", 0}, {"sampler", 0}}};
    file.json["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}},
                               {"normalTexture", {{"index", 0}}},
                               {"extensions", {{"KHR_materials_sheen", {{"sheenColorTexture", {{"index", 0}}}}}}}}};
    file.json["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 0.1}}}}};
    file.json["skins"] = {{{"joints", {0}}}};
    file.json["nodes"] = {{{"mesh", 0}, {"skin", 0}, {"children", {1}}}, {{"camera", 0}}};
    const int times = file.floats({0, 1}, "SCALAR", 1), moves = file.floats({0, 0, 0, 0, 0, 0}, "VEC3", 3);
    file.json["animations"] = {{{"samplers", {{{"input", times}, {"output", moves}}}},
                                {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "scale"}}}}}}}};
    return file;
}

/// The file with `value` at a path is refused with the path and these parts.
void expectRefused(const std::string& path, const json& value, const std::initializer_list<std::string>& parts) {
    SCOPED_TRACE(path + " = " + value.dump());
    GltfBuilder file;
    fill(file).json[json::json_pointer(path)] = value;
    file.expectRefused({"test.glb: " + path + ": "});
    file.expectRefused(parts);
}

TEST(GltfStructure, IndicesCountInWhatTheyReferTo) {
    MessageLog log;
    GltfBuilder good;
    EXPECT_EQ(fill(good).load(log).triangleCount(), 1);
    for (const char* path : {"/bufferViews/0/buffer",
                             "/accessors/0/bufferView",
                             "/images/0/bufferView",
                             "/textures/0/source",
                             "/textures/0/sampler",
                             "/materials/0/pbrMetallicRoughness/baseColorTexture/index",
                             "/materials/0/normalTexture/index",
                             "/materials/0/extensions/KHR_materials_sheen/sheenColorTexture/index",
                             "/meshes/0/primitives/0/indices",
                             "/meshes/0/primitives/0/material",
                             "/meshes/0/primitives/0/attributes/POSITION",
                             "/meshes/0/primitives/0/attributes/NORMAL",
                             "/meshes/0/primitives/0/targets/0/POSITION",
                             "/skins/0/inverseBindMatrices",
                             "/skins/0/skeleton",
                             "/skins/0/joints/0",
                             "/nodes/0/mesh",
                             "/nodes/0/skin",
                             "/nodes/0/camera",
                             "/nodes/0/children/0",
                             "/scenes/0/nodes/0",
                             "/scene",
                             "/animations/0/samplers/0/input",
                             "/animations/0/samplers/0/output",
                             "/animations/0/channels/0/target/node"}) {
        expectRefused(path, 99, {"no such entry in /", "expected 0 to ", "found 99"});
        expectRefused(path, -5, {"no such entry in /", "found -5"});
        expectRefused(path, ~uint64_t(0), {"no such entry in /", "found 18446744073709551615"});
        expectRefused(path, 0.5, {"no such entry in /", "found 0.5"});
        expectRefused(path, "4", {"has the wrong type", "found \"4\""});
        expectRefused(path, json::object(), {"has the wrong type", "found an object"});
    }
    expectRefused("/nodes/0/extensions/EXT_mesh_gpu_instancing/attributes/SCALE", 99, {"/accessors", "found 99"});
    expectRefused("/bufferViews/0/extensions/EXT_meshopt_compression/buffer", 7, {"/buffers", "found 7"});
    expectRefused("/meshes/0/primitives/0/extensions/KHR_draco_mesh_compression/bufferView", "0", {"wrong type"});
}

TEST(GltfStructure, NumbersOfAccessorsAndViews) {
    expectRefused("/accessors/0/componentType", 5124, {"expected 5120, 5121, 5122, 5123, 5125, 5126, found 5124"});
    expectRefused("/accessors/0/componentType", "5126", {"wrong type", "found \"5126\""});
    expectRefused("/accessors/0/type", "VEC9", {"expected SCALAR, VEC2, VEC3, VEC4", "found \"VEC9\""});
    expectRefused("/accessors/0/count", -3, {"expected a whole number, at least 0, found -3"});
    expectRefused("/accessors/0/count", 1.5, {"found 1.5"});
    expectRefused("/accessors/0/byteOffset", "x", {"wrong type", "found \"x\""});
    expectRefused("/bufferViews/0/byteStride", 5, {"expected a multiple of 4 from 0 to 252, found 5"});
    expectRefused("/bufferViews/0/byteStride", 256, {"found 256"});
    expectRefused("/bufferViews/0/byteLength", -1, {"found -1"});
    expectRefused("/bufferViews/0/byteOffset", -1, {"found -1"});
    expectRefused("/bufferViews/0/byteLength", nullptr, {"found null"});
    expectRefused("/meshes/0/primitives/0/mode", "4", {"wrong type"});
    expectRefused("/cameras/0/type", "fish-eye", {"expected perspective, orthographic"});
    expectRefused("/accessors/0/type", std::string(500, 'x'), {"\"" + std::string(39, 'x') + "..."});
}

TEST(GltfStructure, WhatMustBeThereIs) {
    for (const char* path :
         {"/accessors/0/count", "/accessors/0/componentType", "/accessors/0/type", "/bufferViews/0/buffer",
          "/bufferViews/0/byteLength", "/asset/version", "/meshes/0/primitives/0/attributes",
          "/materials/0/normalTexture/index", "/animations/0/samplers/0/input", "/animations/0/channels/0/sampler",
          "/skins/0/joints", "/cameras/0/type", "/cameras/0/perspective", "/cameras/0/perspective/yfov",
          "/cameras/0/perspective/znear", "/asset"}) {
        SCOPED_TRACE(path);
        GltfBuilder file;
        const json::json_pointer pointer(path);
        fill(file).json[pointer.parent_pointer()].erase(pointer.back());
        file.expectRefused({std::string("test.glb: ") + path + ": is missing; expected "});
    }
}

TEST(GltfStructure, SectionsHoldObjects) {
    for (const char* section : {"accessors", "animations", "bufferViews", "cameras", "images", "materials", "meshes",
                                "nodes", "samplers", "scenes", "skins", "textures"}) {
        const std::string path = std::string("/") + section;
        expectRefused(path, 3, {"has the wrong type; expected an array, found 3"});
        expectRefused(path + "/0", nullptr, {"has the wrong type; expected an object, found null"});
    }
    const test::TemporaryFolder folder;
    MessageLog log;
    for (const char* text : {"[]", "3", "[{\"asset\":{}}]"}) {
        writeFileAtomically(folder / "a.gltf", std::string_view(text));
        test::expectError(ErrorKind::BadInput, [&] { loadGltf(folder / "a.gltf", log); },
                          {"a.gltf: /: has the wrong type; expected an object"});
    }
}

TEST(GltfStructure, WholeNumbersMayBeWrittenWithAFraction) {
    GltfBuilder file;
    fill(file);
    file.primitive()["indices"] = file.primitive()["indices"].get<double>();
    file.json["scene"] = 0.0;
    file.json["nodes"][0]["mesh"] = 0.0;
    file.json["accessors"][0]["count"] = 3.0;
    file.json["accessors"][0]["componentType"] = 5126.0;
    EXPECT_EQ(file.load().triangleCount(), 1);
}

TEST(GltfStructure, MinusZeroIsZero) {
    GltfBuilder file;
    fill(file).json["scene"] = -0.0;
    file.json["nodes"][0]["mesh"] = -0.0;
    file.json["bufferViews"][0]["byteOffset"] = -0.0;
    // Written without a point, the parser takes it for a signed integer.
    std::vector<uint8_t> glb = file.glb();
    std::string text(glb.begin(), glb.end());
    size_t count = 0;
    for (size_t at = 0; (at = text.find("-0.0", at)) != text.npos; ++count) text.replace(at, 4, "  -0");
    EXPECT_EQ(count, 3);
    writeFileAtomically(file.folder() / "a.glb", text);
    MessageLog log;
    EXPECT_EQ(loadGltf(file.folder() / "a.glb", log).triangleCount(), 1);
}

TEST(GltfStructure, SetsOfTextureCoordinatesAreWhole) {
    const std::string texture = "/materials/0/pbrMetallicRoughness/baseColorTexture";
    const std::string transform = texture + "/extensions/KHR_texture_transform";
    for (const std::string& path : {texture + "/texCoord", transform + "/texCoord"}) {
        GltfBuilder file;
        fill(file).json[json::json_pointer(path)] = 1.0;
        EXPECT_EQ(file.load().materials.at(0).baseColorTexture.uvSet, 1) << path;
        expectRefused(path, 1.5, {"is out of range; expected a whole number, at least 0, found 1.5"});
    }
    expectRefused("/materials/0/extensions/KHR_materials_sheen/sheenColorTexture/texCoord", "1", {"wrong type"});
}

TEST(GltfStructure, VariantsReferToMaterials) {
    const json variants = {{"variants", {{{"name", "a"}}}}};
    const std::string mappings = "/meshes/0/primitives/0/extensions/KHR_materials_variants/mappings";
    GltfBuilder file;
    fill(file).json["extensions"]["KHR_materials_variants"] = variants;
    file.json["materials"].push_back({{"name", "other"}});
    file.json[json::json_pointer(mappings)] = {{{"material", 1.0}, {"variants", {0.0}}}};
    MessageLog log;
    LoadOptions options;
    options.choice.variant = "a";
    EXPECT_EQ(file.load(log, options).materials.at(1).name, "other");
    expectRefused(mappings + "/0/material", 0.5, {"no such entry in /materials; expected 0 to 0, found 0.5"});
    file.json[json::json_pointer(mappings + "/0/variants")] = "a";
    file.expectRefused({mappings + "/0/variants: has the wrong type; expected an array, found \"a\""});
}

TEST(GltfStructure, CompressedViewsSayWhatIsWrong) {
    const std::string path = "/bufferViews/0/extensions/EXT_meshopt_compression";
    const json good = {{"buffer", 0}, {"byteLength", 9}, {"byteStride", 12}, {"count", 3}, {"mode", "ATTRIBUTES"}};
    const auto refused = [&](const char* name, const json& value, const std::string& part) {
        json extension = good;
        extension[name] = value;
        GltfBuilder file;
        fill(file).json[json::json_pointer(path)] = extension;
        file.expectRefused({path + "/" + name + ": ", part});
    };
    refused("byteLength", 1e30, "found 1e+30");
    refused("byteLength", 0, "found 0");
    refused("byteStride", 300, "expected a whole number from 1 to 256, found 300");
    refused("count", "3", "wrong type");
    refused("byteOffset", -4, "found -4");
    GltfBuilder file;
    fill(file).json[json::json_pointer(path)] = {{"buffer", 0}};
    file.expectRefused({path + "/byteLength: is missing"});
}

TEST(GltfStructure, CamerasHoldNumbers) {
    expectRefused("/cameras/0/perspective", nullptr, {"has the wrong type; expected an object, found null"});
    expectRefused("/cameras/0/perspective/yfov", "wide", {"has the wrong type; expected a number, found \"wide\""});
    expectRefused("/cameras/0/perspective/zfar", "9", {"expected a number, found \"9\""});
    GltfBuilder file;
    fill(file).json["cameras"] = {{{"type", "orthographic"}, {"perspective", {{"yfov", "x"}}}}};
    file.expectRefused({"/cameras/0/orthographic: is missing; expected an object"});
    file.json["cameras"][0]["orthographic"] = {{"xmag", 1}, {"ymag", 1}, {"znear", 0}};
    file.expectRefused({"/cameras/0/orthographic/zfar: is missing; expected a number"});
    file.json["cameras"][0]["orthographic"]["zfar"] = 5;
    EXPECT_EQ(file.load().cameras.size(), 1);
}

TEST(GltfStructure, LightsHaveAType) {
    const std::string light = "/extensions/KHR_lights_punctual/lights/0";
    const auto refused = [&](const json& value, const std::string& part) {
        GltfBuilder file;
        fill(file).json["extensions"]["KHR_lights_punctual"]["lights"] = json::array({value});
        file.expectRefused({"test.glb: " + light + part});
    };
    refused(nullptr, ": has the wrong type; expected an object, found null");
    refused({{"intensity", 1}}, "/type: is missing; expected a string");
    refused({{"type", 3}}, "/type: has the wrong type; expected a string, found 3");
    refused({{"type", "spot"}}, "/spot: is missing; expected an object");
}

TEST(GltfStructure, NodesMoveByNumbers) {
    expectRefused("/nodes/0/translation", "x", {"has the wrong type; expected 3 numbers, found \"x\""});
    expectRefused("/nodes/0/scale", {1, 1}, {"has the wrong length; expected 3, found 2"});
    GltfBuilder file;
    fill(file).json["nodes"][1]["rotation"] = {0, true, 0, 1};
    file.expectRefused({"/nodes/1/rotation/1: has the wrong type; expected a number, found true"});
}

TEST(GltfStructure, OldFilesSayTheirVersion) {
    GltfBuilder file;
    file.json = {{"asset", {{"version", "1.0"}}}, {"accessors", {{"a", json::object()}}}, {"scene", "s"}};
    file.expectRefused({"/asset/version: not a version of glTF that is read", "found \"1.0\""});
}

TEST(GltfStructure, IndicesWithoutBytesAreZeros) {
    GltfBuilder file;
    file.triangle().json["accessors"].push_back({{"componentType", 5123}, {"count", 3}, {"type", "SCALAR"}});
    json other = file.primitive();
    other["indices"] = 2;
    file.json["meshes"][0]["primitives"].push_back(other);
    EXPECT_GE(file.load().triangleCount(), 1);
}

/// A .gltf of one triangle whose buffer of 36 bytes, or as many as it says, is at this URI.
std::string withBuffer(const std::string& uri, size_t length = 36) {
    const json file = {{"asset", {{"version", "2.0"}}},
                       {"nodes", {{{"mesh", 0}}}},
                       {"meshes", {{{"primitives", {{{"attributes", {{"POSITION", 0}}}}}}}}},
                       {"accessors", {{{"bufferView", 0}, {"componentType", 5126}, {"count", 3}, {"type", "VEC3"}}}},
                       {"bufferViews", {{{"buffer", 0}, {"byteLength", 36}}}},
                       {"buffers", {{{"byteLength", length}, {"uri", uri}}}}};
    return file.dump();
}

TEST(GltfStructure, BuffersHoldWhatTheySay) {
    const test::TemporaryFolder folder;
    MessageLog log;
    const auto refused = [&](const std::string& text, const std::initializer_list<std::string>& parts) {
        writeFileAtomically(folder / "a.gltf", text);
        test::expectError(
            ErrorKind::BadInput, [&] { loadGltf(folder / "a.gltf", log); }, parts);
    };
    const std::string head = "data:application/octet-stream;base64,";
    refused(withBuffer(head + std::string(40000, 'A'), 30001),
            {"a.gltf: /buffers/0/byteLength: is more than the data URI \"" + head + "AAA...\" holds",
             "expected at most 30000, found 30001"});
    refused(withBuffer(head), {"/buffers/0/byteLength", "at most 0, found 36"});
    refused(withBuffer(head + "AAAA"), {"/buffers/0/byteLength", "at most 3, found 36"});
    refused(withBuffer(""), {"/buffers/0/uri: is missing, and the file has no binary chunk"});
    refused(withBuffer("a.bin", 0), {"/buffers/0/byteLength: is out of range; expected a whole number, at least 1"});
    refused(withBuffer("nothere.bin"), {"/buffers/0/uri: the buffer file \"nothere.bin\" does not exist"});
    refused(withBuffer("../a.bin"), {"/buffers/0/uri: the file name \"../a.bin\" leads out"});
    refused(withBuffer("http://example.org/" + std::string(99, 'a')),
            {"/buffers/0/uri: ", "\"http://example.org/" + std::string(21, 'a') + "...\" leads out"});
    writeFileAtomically(folder / "short.bin", std::string_view("1234"));
    refused(withBuffer("short.bin"),
            {"/buffers/0/byteLength: is more than the file \"short.bin\" holds", "expected at most 4, found 36"});

    // Longer data are cut, as longer files are.
    for (const size_t bytes : {36, 37, 38, 39, 300}) {
        writeFileAtomically(folder / "a.gltf", withBuffer(head + std::string((bytes + 2) / 3 * 4, 'A')));
        EXPECT_EQ(loadGltf(folder / "a.gltf", log).triangleCount(), 1) << bytes;
    }
}

TEST(GltfStructure, TheBinaryChunkHoldsItsBuffer) {
    GltfBuilder file;
    file.triangle();
    std::vector<uint8_t> glb = file.glb();
    // The chunk claims eight bytes beyond the file's end, its buffer with it.
    const uint32_t jsonBytes = glb[12] + 256u * glb[13], chunk = static_cast<uint32_t>(glb.size()) - 28 - jsonBytes;
    glb[20 + jsonBytes] = static_cast<uint8_t>(chunk + 8);
    std::string text(glb.begin(), glb.end());
    const std::string length = "\"byteLength\":" + std::to_string(file.bin.size()) + "}]";
    const size_t at = text.find(length);
    ASSERT_NE(at, text.npos);
    text.replace(at, length.size(), "\"byteLength\":" + std::to_string(chunk + 8) + "}]");
    ASSERT_EQ(text.size(), glb.size());
    writeFileAtomically(file.folder() / "a.glb", text);
    MessageLog log;
    test::expectError(ErrorKind::BadInput, [&] { loadGltf(file.folder() / "a.glb", log); },
                      {"/buffers/0/byteLength: is more than the file's binary chunk holds"});
}

}  // namespace
}  // namespace lumi
