// What exporters write where nothing is: null, an index of -1, an empty array. It is read as absent, in one warning.
#include <gtest/gtest.h>

#include "gltf_support.h"

namespace lumi {
namespace {

using nlohmann::json;
using test::GltfBuilder;

/// A triangle with a material, a texture, a skin, a camera and an animation.
GltfBuilder& fill(GltfBuilder& file) {
    file.triangle().primitive()["material"] = 0;
    file.json["images"] = {{{"uri",
                             "data:image/bmp;base64,"
                             "Qk06AAAAAAAAADYAAAAoAAAAAQAAAAEAAAABABgAAAAAAAQAAAAAAAAAAAAAAAAAAAAAAAAA////AA=="}}};
    file.json["samplers"] = {json::object()};
    file.json["textures"] = {{{"source", 0}, {"sampler", 0}}};
    file.json["materials"] = {{{"name", "m"}}};
    file.json["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 0.1}}}}};
    file.json["skins"] = {{{"joints", {0}}}};
    file.json["nodes"] = {{{"mesh", 0}, {"children", {1}}}, {{"name", "second"}}};
    const int times = file.floats({0, 1}, "SCALAR", 1), moves = file.floats({0, 0, 0, 0, 0, 0}, "VEC3", 3);
    file.json["animations"] = {{{"samplers", {{{"input", times}, {"output", moves}}}},
                                {"channels", {{{"sampler", 0}, {"target", {{"path", "scale"}}}}}}}};
    file.json["accessors"].push_back({{"componentType", 5126}, {"count", 1}, {"type", "SCALAR"}});
    return file;
}

/// The file with `value` at a path opens, and what the warning says of it comes last.
void expectAbsent(const std::string& path, const json& value, const std::string& shown = {},
                  const std::string& inside = {}) {
    SCOPED_TRACE(path + " = " + value.dump());
    GltfBuilder file;
    fill(file).json[json::json_pointer(path)] = value;
    MessageLog log;
    ASSERT_NO_THROW(EXPECT_EQ(file.load(log).triangleCount(), 1));
    const std::string wanted = "test.glb: " + path + inside + ": " + (shown.empty() ? value.dump() : shown);
    EXPECT_EQ(log.warnings(), std::vector<std::string>{wanted + " is read as absent"});
}

TEST(GltfAbsent, OptionalIndices) {
    for (const char* path :
         {"/textures/0/sampler", "/skins/0/skeleton", "/skins/0/inverseBindMatrices", "/nodes/1/mesh", "/nodes/0/skin",
          "/nodes/1/camera", "/meshes/0/primitives/0/indices", "/meshes/0/primitives/0/material",
          "/meshes/0/primitives/0/attributes/NORMAL", "/accessors/4/bufferView", "/images/0/bufferView",
          "/animations/0/channels/0/target/node", "/scene", "/samplers/0/magFilter", "/samplers/0/minFilter"}) {
        expectAbsent(path, -1);
        expectAbsent(path, nullptr);
    }
    for (const json& value : {json(-1), json()})
        expectAbsent("/materials/0/normalTexture", {{"index", value}}, value.dump(), "/index");
}

TEST(GltfAbsent, NullIsWhatIsNotThere) {
    for (const char* path :
         {"/nodes/1/children", "/accessors/0/byteOffset", "/bufferViews/0/byteStride", "/meshes/0/primitives/0/mode",
          "/meshes/0/primitives/0/targets", "/meshes/0/primitives/0/extensions", "/materials/0/normalTexture",
          "/materials/0/pbrMetallicRoughness", "/animations", "/skins", "/cameras", "/nodes/0/translation",
          "/cameras/0/perspective/zfar", "/extensions"})
        expectAbsent(path, nullptr);
    GltfBuilder file;
    file.triangle().json["samplers"] = nullptr;
    EXPECT_EQ(file.load().triangleCount(), 1);
}

TEST(GltfAbsent, ExtensionsWithoutMembers) {
    for (const char* owner : {"/materials/0", "/nodes/0", "/meshes/0/primitives/0"})
        expectAbsent(std::string(owner) + "/extensions", json::array(), "an empty array");
    for (const char* path :
         {"/materials/0/extensions/KHR_materials_sheen", "/nodes/1/extensions/KHR_lights_punctual"}) {
        expectAbsent(path, json::array(), "an empty array");
        expectAbsent(path, nullptr);
    }
}

TEST(GltfAbsent, AFirstSceneThatIsNotThere) {
    expectAbsent("/scene", nullptr);
    GltfBuilder file;
    file.triangle().json["scenes"] = json::array();
    EXPECT_EQ(file.load().triangleCount(), 1);
    file.json.erase("scenes");
    EXPECT_EQ(file.load().triangleCount(), 1);
    file.json["scene"] = 1;
    file.expectRefused({"/scene: no such entry in /scenes", "found 1"});
}

TEST(GltfAbsent, OneWarningForAll) {
    GltfBuilder file;
    fill(file).json["skins"][0]["skeleton"] = -1;
    file.primitive()["material"] = nullptr;
    file.json["nodes"][0]["skin"] = -1;
    MessageLog log;
    file.load(log);
    EXPECT_EQ(log.warnings(), std::vector<std::string>{"test.glb: /meshes/0/primitives/0/material: null is read as "
                                                       "absent, as in 2 more places"});
}

TEST(GltfAbsent, NamesBesideAttributes) {
    expectAbsent("/meshes/0/primitives/0/attributes/extras", json::object(), "an object");
    for (const json& value : {json("x"), json(99), json(-7), json(0.5), json()})
        expectAbsent("/meshes/0/primitives/0/attributes/_OWN", value);
    GltfBuilder file;
    fill(file);
    const json position = file.primitive()["attributes"]["POSITION"];
    file.primitive()["targets"] = {{{"POSITION", position}, {"NORMAL", -1}, {"extra", {{"name", "A"}}}},
                                   {{"POSITION", position}, {"NORMAL", -1}, {"extra", {{"name", "B"}}}}};
    MessageLog log;
    const Scene scene = file.load(log);
    ASSERT_EQ(scene.instances.size(), 1);
    EXPECT_EQ(scene.instances[0].mesh->morphTargets.size(), 2);
    EXPECT_EQ(log.warnings(), std::vector<std::string>{"test.glb: /meshes/0/primitives/0/targets/0/NORMAL: -1 is read "
                                                       "as absent, as in 3 more places"});
}

TEST(GltfAbsent, TexturesOfTheApplicationsOwn) {
    GltfBuilder file;
    fill(file).json["materials"][0] = {
        {"customTexture", "foo"}, {"lightTexture", {{"uri", "x"}}}, {"pbrMetallicRoughness", {{"myTexture", 3}}}};
    MessageLog log;
    file.load(log);
    EXPECT_TRUE(log.warnings().empty());
}

TEST(GltfAbsent, NotWhereItMustBe) {
    for (const char* path : {"/bufferViews/0/buffer", "/accessors/0/count", "/animations/0/samplers/0/input",
                             "/skins/0/joints/0", "/nodes/0/children/0", "/scenes/0/nodes/0"})
        for (const json& value : {json(-1), json()}) {
            SCOPED_TRACE(path);
            GltfBuilder file;
            fill(file).json[json::json_pointer(path)] = value;
            file.expectRefused({std::string("test.glb: ") + path + ": ", "found " + value.dump()});
        }
}

}  // namespace
}  // namespace lumi
