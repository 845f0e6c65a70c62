// Numbers of materials that are out of range, or none: the nearest is taken, or the default, with a warning.
#include <gtest/gtest.h>

#include "gltf_support.h"

namespace lumi {
namespace {

using nlohmann::json;
using test::GltfBuilder;

/// The first material of a file with these properties; `warnings` are all that is said, without the file's name.
Material loaded(const json& material, const std::vector<std::string>& warnings) {
    GltfBuilder file;
    file.triangle().primitive()["material"] = 0;
    file.json["materials"] = {material};
    file.json["images"] = {{{"uri",
                             "data:image/bmp;base64,"
                             "Qk06AAAAAAAAADYAAAAoAAAAAQAAAAEAAAABABgAAAAAAAQAAAAAAAAAAAAAAAAAAAAAAAAA////AA=="}}};
    file.json["textures"] = {{{"source", 0}}};
    file.primitive()["attributes"]["TEXCOORD_0"] = file.floats({0, 0, 1, 0, 0, 1}, "VEC2", 2);
    MessageLog log;
    const Scene scene = file.load(log);
    std::vector<std::string> expected;
    for (const std::string& warning : warnings) expected.push_back("test.glb: /materials/0/" + warning);
    EXPECT_EQ(log.warnings(), expected) << material.dump();
    return scene.materials.at(0);
}

json extension(const std::string& name, const json& properties) { return {{"extensions", {{name, properties}}}}; }

TEST(GltfNumbers, OutOfRangeTakesTheNearest) {
    const Material core =
        loaded({{"pbrMetallicRoughness",
                 {{"roughnessFactor", 5}, {"metallicFactor", 0.25}, {"baseColorFactor", {1e300, 0.5, -1, 1}}}},
                {"emissiveFactor", {7, 0, -2}}},
               {"pbrMetallicRoughness/baseColorFactor/0: 1e+300 is out of range; 1 is taken",
                "pbrMetallicRoughness/baseColorFactor/2: -1 is out of range; 0 is taken",
                "pbrMetallicRoughness/roughnessFactor: 5 is out of range; 1 is taken",
                "emissiveFactor/2: -2 is out of range; 0 is taken"});
    EXPECT_EQ(core.roughness, 1);
    EXPECT_EQ(core.metallic, 0.25f);
    EXPECT_EQ(core.baseColor, Vec3(1, 0.5f, 0));
    EXPECT_EQ(core.emission, Vec3(7, 0, 0));

    EXPECT_EQ(loaded(extension("KHR_materials_clearcoat", {{"clearcoatFactor", -3}}),
                     {"extensions/KHR_materials_clearcoat/clearcoatFactor: -3 is out of range; 0 is taken"})
                  .clearcoat,
              0);
    EXPECT_EQ(loaded(extension("KHR_materials_ior", {{"ior", -1}}),
                     {"extensions/KHR_materials_ior/ior: -1 is out of range; 1 is taken"})
                  .ior,
              1);
    EXPECT_EQ(loaded(extension("KHR_materials_volume", {{"attenuationDistance", 0}}),
                     {"extensions/KHR_materials_volume/attenuationDistance: 0 is out of range; inf is taken"})
                  .attenuationDistance,
              kInfinity);
}

TEST(GltfNumbers, WhatIsNoNumberTakesTheDefault) {
    const std::string coat = "extensions/KHR_materials_clearcoat/clearcoatFactor";
    loaded(extension("KHR_materials_clearcoat", {{"clearcoatFactor", "much"}}),
           {coat + ": \"much\" is not a number; 0 is taken"});
    loaded(extension("KHR_materials_clearcoat", {{"clearcoatFactor", json::array()}}),
           {coat + ": an array is not a number; 0 is taken"});
    const Material core =
        loaded({{"pbrMetallicRoughness", {{"baseColorFactor", {0.5, 0.5, 0.5}}, {"metallicFactor", 0}}}},
               {"pbrMetallicRoughness/baseColorFactor: an array is not 4 numbers; 1 is taken"});
    EXPECT_EQ(core.baseColor, Vec3(1));
    EXPECT_EQ(core.metallic, 0);
    const std::string transform = "pbrMetallicRoughness/baseColorTexture/extensions/KHR_texture_transform/";
    const Material turned = loaded(
        {{"pbrMetallicRoughness",
          {{"baseColorTexture",
            {{"index", 0}, {"extensions", {{"KHR_texture_transform", {{"scale", "x"}, {"offset", {1, 2}}}}}}}}}}},
        {transform + "scale: \"x\" is not 2 numbers; 1 is taken"});
    EXPECT_EQ(turned.baseColorTexture.scale, Vec2(1));
    EXPECT_EQ(turned.baseColorTexture.offset, Vec2(1, 2));
}

TEST(GltfNumbers, GoodOnesAreLeftAlone) {
    EXPECT_GT(loaded(extension("KHR_materials_ior", {{"ior", 0}}), {}).ior, 1000);
    EXPECT_EQ(loaded(extension("KHR_materials_volume", {{"attenuationDistance", 0.25}}), {}).attenuationDistance,
              0.25f);
    EXPECT_EQ(loaded({{"pbrMetallicRoughness", {{"roughnessFactor", 1.0000000001}}}}, {}).roughness, 1);
    EXPECT_EQ(loaded(extension("KHR_materials_emissive_strength", {{"emissiveStrength", 1000}}), {}).name,
              "material 0");
}

}  // namespace
}  // namespace lumi
