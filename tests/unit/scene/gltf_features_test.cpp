#include <gtest/gtest.h>

#include "gltf_support.h"
#include "scene/gltf/choices.h"
#include "scene/posed_scene.h"

namespace lumi {
namespace {

using test::expectError;
using test::GltfBuilder;

void expectNear(const Vec3& a, const Vec3& b, float tolerance = 1e-5f) {
    EXPECT_LT(glm::length(a - b), tolerance) << a.x << ' ' << a.y << ' ' << a.z;
}

/// A 1x1 red PNG.
const char* const kRedPng =
    "data:image/"
    "png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mP8z8BQDwAEhQGAhKmMIQAAAABJRU5ErkJggg==";

TEST(GltfFeatures, InstancesShareTheirMesh) {
    GltfBuilder file;
    file.triangle();
    file.json["nodes"] = {{{"mesh", 0}, {"name", "a"}, {"children", {1}}},
                          {{"mesh", 0}, {"name", "b"}, {"scale", {2, 2, 2}}}};
    const Scene scene = file.load();
    ASSERT_EQ(scene.instances.size(), 2u);
    EXPECT_EQ(scene.instances[0].mesh, scene.instances[1].mesh);
    EXPECT_EQ(scene.instances[1].name, "b");
    EXPECT_EQ(scene.nodes[1].parent, 0);
    EXPECT_EQ(scene.triangleCount(), 2);
    expectNear(scene.restBounds().upper, {2, 2, 0});
}

TEST(GltfFeatures, PrimitivesMergeWithAMaterialForEachTriangle) {
    GltfBuilder file;
    file.triangle();
    nlohmann::json second = file.primitive();
    second["material"] = 1;
    file.primitive()["material"] = 0;
    nlohmann::json third = second;
    third["material"] = 0;
    third["attributes"]["POSITION"] = file.floats({0, 0, 5, 1, 0, 5, 0, 1, 5}, "VEC3", 3);
    file.json["meshes"][0]["primitives"].push_back(second);
    file.json["meshes"][0]["primitives"].push_back(third);
    file.json["materials"] = {{{"name", "red"}}, {{"name", "red"}}};
    const Scene scene = file.load();
    const Mesh& mesh = *scene.instances[0].mesh;
    EXPECT_EQ(mesh.triangleMaterial, (std::vector<uint32_t>{0, 1, 0}));
    EXPECT_EQ(mesh.positions.size(), 6u) << "primitives over the same vertices share them";
    ASSERT_EQ(scene.materials.size(), 2u) << "the default material is not used and not kept";
    EXPECT_EQ(scene.materials[1].name, "red-2");
}

TEST(GltfFeatures, StripsAndFans) {
    GltfBuilder file;
    const int p = file.floats({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 2, 0}, "VEC3", 3);
    for (const int mode : {5, 6, 1, 0})
        file.json["meshes"].push_back({{"primitives", {{{"attributes", {{"POSITION", p}}}, {"mode", mode}}}}});
    file.json["nodes"] = {{{"children", {1, 2, 3, 4}}}, {{"mesh", 0}}, {{"mesh", 1}}, {{"mesh", 2}}, {{"mesh", 3}}};
    MessageLog log;
    const Scene scene = file.load(log);
    ASSERT_EQ(scene.instances.size(), 2u) << "meshes of points and lines only are left out";
    EXPECT_EQ(scene.instances[0].mesh->triangles, (std::vector<UVec3>{{0, 1, 2}, {1, 3, 2}, {2, 3, 4}}));
    EXPECT_EQ(scene.instances[1].mesh->triangles, (std::vector<UVec3>{{1, 2, 0}, {2, 3, 0}, {3, 4, 0}}));
    EXPECT_EQ(log.warnings().size(), 1u);
}

TEST(GltfFeatures, MaterialsWithTheirExtensions) {
    GltfBuilder file;
    file.triangle();
    file.primitive()["material"] = 0;
    file.json["materials"] = {nlohmann::json::parse(R"({
        "name": "glass", "alphaMode": "MASK", "alphaCutoff": 0.25, "doubleSided": true, "emissiveFactor": [1, 0.5, 0],
        "pbrMetallicRoughness": {"baseColorFactor": [0.1, 0.2, 0.3, 0.4], "metallicFactor": 0.5, "roughnessFactor": 0.25},
        "extensions": {
          "KHR_materials_emissive_strength": {"emissiveStrength": 4}, "KHR_materials_ior": {"ior": 1.33},
          "KHR_materials_specular": {"specularFactor": 0.7, "specularColorFactor": [1, 0.5, 0.25]},
          "KHR_materials_transmission": {"transmissionFactor": 0.9},
          "KHR_materials_volume": {"thicknessFactor": 2, "attenuationDistance": 3, "attenuationColor": [0.9, 0.8, 0.7]}}})")};
    const Material m = file.load().materials[0];
    EXPECT_EQ(m.name, "glass");
    expectNear(m.baseColor, {0.1f, 0.2f, 0.3f});
    EXPECT_FLOAT_EQ(m.alpha, 0.4f);
    EXPECT_EQ(m.alphaMode, AlphaMode::Mask);
    EXPECT_FLOAT_EQ(m.alphaCutoff, 0.25f);
    EXPECT_TRUE(m.doubleSided);
    expectNear(m.emission, {4, 2, 0});
    EXPECT_FLOAT_EQ(m.ior, 1.33f);
    EXPECT_FLOAT_EQ(m.specular, 0.7f);
    expectNear(m.specularColor, {1, 0.5f, 0.25f});
    EXPECT_FLOAT_EQ(m.transmission, 0.9f);
    EXPECT_TRUE(m.isSolid());
    EXPECT_FLOAT_EQ(m.attenuationDistance, 3);
    expectNear(m.attenuationColor, {0.9f, 0.8f, 0.7f});
}

TEST(GltfFeatures, DefaultsAreThoseOfTheSpecification) {
    GltfBuilder file;
    file.triangle();
    const Material m = file.load().materials[0];
    EXPECT_EQ(m.metallic, 1);
    EXPECT_EQ(m.roughness, 1);
    EXPECT_FALSE(m.emits());
    EXPECT_FALSE(file.load().materials[0].baseColorTexture);
}

TEST(GltfFeatures, TexturesShareImagesAndCarryTheirSamplers) {
    GltfBuilder file;
    file.triangle();
    file.primitive()["material"] = 0;
    file.primitive()["attributes"]["TEXCOORD_0"] = file.floats({0, 0, 1, 0, 0, 1}, "VEC2", 2);
    file.primitive()["attributes"]["NORMAL"] = file.floats({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3", 3);
    file.json["images"] = {{{"uri", kRedPng}}};
    file.json["samplers"] = {{{"wrapS", 33071}, {"wrapT", 33648}, {"magFilter", 9728}}};
    file.json["textures"] = {{{"source", 0}, {"sampler", 0}}, {{"source", 0}}};
    file.json["materials"] = {nlohmann::json::parse(R"({
        "pbrMetallicRoughness": {"baseColorTexture": {"index": 0, "texCoord": 1,
            "extensions": {"KHR_texture_transform": {"offset": [0.5, 0.25], "scale": [2, 3], "rotation": 1.5, "texCoord": 0}}},
            "metallicRoughnessTexture": {"index": 1}},
        "emissiveTexture": {"index": 1}, "normalTexture": {"index": 1, "scale": 0.5}})")};
    const Scene scene = file.load();
    const Material& m = scene.materials[0];
    EXPECT_EQ(m.baseColorTexture.wrapU, Wrap::ClampToEdge);
    EXPECT_EQ(m.baseColorTexture.wrapV, Wrap::MirroredRepeat);
    EXPECT_EQ(m.baseColorTexture.filter, TextureFilter::Nearest);
    EXPECT_EQ(m.baseColorTexture.uvSet, 0);
    EXPECT_EQ(m.baseColorTexture.offset, Vec2(0.5f, 0.25f));
    EXPECT_EQ(m.baseColorTexture.scale, Vec2(2, 3));
    EXPECT_FLOAT_EQ(m.baseColorTexture.rotation, 1.5f);
    EXPECT_EQ(m.baseColorTexture.image, m.emissionTexture.image);
    EXPECT_TRUE(m.baseColorTexture.image->srgb);
    EXPECT_FALSE(m.metallicRoughnessTexture.image->srgb);
    EXPECT_EQ(m.normalScale, 0.5f);
    EXPECT_NEAR(m.baseColorTexture.sample({0, 0}).x, 1, 1e-6f);
    EXPECT_EQ(scene.instances[0].mesh->tangents.size(), 3u) << "a normal map needs tangents";
}

TEST(GltfFeatures, UnlitEmitsItsColour) {
    GltfBuilder file;
    file.triangle();
    file.primitive()["material"] = 0;
    file.json["materials"] = {nlohmann::json::parse(
        R"({"pbrMetallicRoughness": {"baseColorFactor": [0.2, 0.4, 0.6, 1]}, "extensions": {"KHR_materials_unlit": {}}})")};
    const Material m = file.load().materials[0];
    expectNear(m.emission, {0.2f, 0.4f, 0.6f});
    EXPECT_TRUE(m.unlit);
    EXPECT_TRUE(isBlack(m.baseColor));
    EXPECT_EQ(m.specular, 0);
}

TEST(GltfFeatures, SpecularGlossiness) {
    GltfBuilder file;
    file.triangle();
    file.primitive()["material"] = 0;
    file.json["materials"] = {nlohmann::json::parse(
        R"({"extensions": {"KHR_materials_pbrSpecularGlossiness": {"diffuseFactor": [0.5, 0.25, 0, 1],
            "specularFactor": [0.04, 0.08, 0.02], "glossinessFactor": 0.75}}})")};
    const Material m = file.load().materials[0];
    expectNear(m.baseColor, {0.5f, 0.25f, 0});
    EXPECT_EQ(m.metallic, 0);
    EXPECT_FLOAT_EQ(m.roughness, 0.25f);
    expectNear(m.specularColor, {1, 2, 0.5f});
}

TEST(GltfFeatures, MaterialsOfOneGlossShareTheirRoughness) {
    GltfBuilder file;
    file.triangle();
    file.json["images"] = {{{"uri", kRedPng}}};
    file.json["textures"] = {{{"source", 0}}};
    for (const double gloss : {1.0, 0.5, 1.0})
        file.json["materials"].push_back(
            {{"extensions",
              {{"KHR_materials_pbrSpecularGlossiness",
                {{"specularGlossinessTexture", {{"index", 0}}}, {"glossinessFactor", gloss}}}}}});
    const Scene scene = file.load();
    const auto image = [&](size_t i) { return scene.materials[i].metallicRoughnessTexture.image; };
    EXPECT_EQ(image(0), image(2));
    EXPECT_NE(image(0), image(1));
    EXPECT_EQ(image(0)->levels[0].bytes[1], 128) << "the image is half transparent";
    EXPECT_EQ(image(1)->levels[0].bytes[1], 192);
}

TEST(GltfFeatures, PunctualLightsOneToOne) {
    GltfBuilder file;
    file.triangle();
    file.json["extensions"]["KHR_lights_punctual"]["lights"] = nlohmann::json::parse(R"([
        {"type": "point", "name": "lamp", "color": [1, 0.5, 0.25], "intensity": 40, "range": 9},
        {"type": "spot", "intensity": 10, "spot": {"innerConeAngle": 0.5, "outerConeAngle": 1}},
        {"type": "directional", "intensity": 3}])");
    nlohmann::json nodes = {{{"children", {1, 2, 3}}}};
    for (const int light : {0, 1, 2})
        nodes.push_back(
            {{"translation", {0, light, 0}}, {"extensions", {{"KHR_lights_punctual", {{"light", light}}}}}});
    file.json["nodes"] = nodes;
    const Scene scene = file.load();
    ASSERT_EQ(scene.lights.size(), 3u);
    EXPECT_EQ(scene.lights[0].name, "lamp");
    EXPECT_EQ(scene.lights[0].type, LightType::Point);
    expectNear(scene.lights[0].intensity, {40, 20, 10});
    EXPECT_FLOAT_EQ(scene.lights[0].range, 9);
    EXPECT_EQ(scene.lights[1].type, LightType::Spot);
    EXPECT_NEAR(scene.lights[1].innerConeDeg, degrees(0.5f), 1e-3f);
    EXPECT_NEAR(scene.lights[1].outerConeDeg, degrees(1), 1e-3f);
    EXPECT_EQ(scene.lights[1].range, kInfinity);
    expectNear(scene.lights[2].irradiance, {3, 3, 3});
    EXPECT_EQ(scene.lights[2].node, 3);
}

TEST(GltfFeatures, Cameras) {
    GltfBuilder file;
    file.triangle();
    file.json["cameras"] = nlohmann::json::parse(R"([
        {"type": "perspective", "name": "main", "perspective": {"yfov": 0.7, "znear": 0.1, "aspectRatio": 2}},
        {"type": "orthographic", "orthographic": {"xmag": 3, "ymag": 2, "znear": 0, "zfar": 10}}])");
    file.json["nodes"] = {
        {{"children", {1, 2}}, {"mesh", 0}}, {{"camera", 1}, {"translation", {0, 0, 3}}}, {{"camera", 0}}};
    const Scene scene = file.load();
    ASSERT_EQ(scene.cameras.size(), 2u);
    EXPECT_EQ(scene.cameras[0].camera.projection, Projection::Orthographic);
    EXPECT_FLOAT_EQ(scene.cameras[0].camera.yMag, 2);
    expectNear(scene.cameras[0].camera.eye, {0, 0, 3});
    EXPECT_FLOAT_EQ(scene.cameras[0].camera.focus, 3) << "focused on the depth of the scene's middle";
    EXPECT_EQ(scene.cameras[1].camera.name, "main");
    EXPECT_NEAR(scene.cameras[1].camera.fovYDeg, degrees(0.7f), 1e-4f);
}

TEST(GltfFeatures, MatricesBecomeTransformsWhereTheyCan) {
    GltfBuilder file;
    file.triangle();
    file.json["nodes"][0]["matrix"] = {0, 2, 0, 0, -2, 0, 0, 0, 0, 0, 2, 0, 5, 6, 7, 1};
    const Scene turned = file.load();
    EXPECT_FALSE(turned.nodes[0].hasMatrix);
    expectNear(turned.nodes[0].local.scale, Vec3(2));
    expectNear(transformPoint(poseScene(std::make_shared<Scene>(turned), {})->instances[0].worldFromObject, {1, 0, 0}),
               {5, 8, 7});
    file.json["nodes"][0]["matrix"] = {1, 0, 0, 0, 0.5, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    EXPECT_TRUE(file.load().nodes[0].hasMatrix) << "shear";
    file.json["nodes"][0]["matrix"] = {-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    const Scene mirrored = file.load();
    EXPECT_FALSE(mirrored.nodes[0].hasMatrix);
    EXPECT_TRUE(isMirroring(mirrored.nodes[0].local.matrix()));
}

TEST(GltfFeatures, ScenesAreChosenByIndex) {
    GltfBuilder file;
    file.triangle();
    file.json["nodes"] = {{{"mesh", 0}, {"name", "first"}}, {{"mesh", 0}, {"name", "second"}}};
    file.json["scenes"] = {{{"nodes", {0}}}, {{"nodes", {1}}}};
    file.json["scene"] = 1;
    EXPECT_EQ(file.load().instances.at(0).name, "second");
    MessageLog log;
    LoadOptions options;
    options.choice.index = 0;
    EXPECT_EQ(file.load(log, options).instances.at(0).name, "first");
    options.choice.index = 2;
    expectError(ErrorKind::Usage, [&] { file.load(log, options); }, {"below 2"});
    file.json.erase("scenes");
    file.json.erase("scene");
    EXPECT_EQ(file.load().instances.size(), 2u) << "without scenes, every root is shown";
}

TEST(GltfFeatures, Variants) {
    GltfBuilder file;
    file.triangle();
    file.json["materials"] = {{{"name", "day"}}, {{"name", "night"}}};
    file.primitive()["material"] = 0;
    file.primitive()["extensions"]["KHR_materials_variants"]["mappings"] = {{{"material", 1}, {"variants", {1}}}};
    file.json["extensions"]["KHR_materials_variants"]["variants"] = {{{"name", "day"}}, {{"name", "night"}}};
    MessageLog log;
    LoadOptions options;
    EXPECT_EQ(file.load(log, options).instances[0].mesh->material, 0u);
    options.choice.variant = "night";
    EXPECT_EQ(file.load(log, options).instances[0].mesh->material, 1u);
    options.choice.variant = "dusk";
    expectError(ErrorKind::Usage, [&] { file.load(log, options); }, {"day, night", "dusk"});
}

TEST(GltfFeatures, ChoicesAreReadWithoutTheRest) {
    GltfBuilder file;
    file.triangle();
    file.json["scenes"] = {{{"nodes", {0}}, {"name", "day \u00e4"}}, {{"nodes", {0}}}};
    file.json["scene"] = 1.0;
    file.json["extensions"]["KHR_materials_variants"]["variants"] = {{{"name", "red"}}, {{"name", "green"}}};
    file.json["nodes"][0]["scenes"] = {{{"name", "none of them"}}};
    test::TemporaryFolder folder;
    writeFileAtomically(folder / "a.glb", file.glb());
    const gltf::Choices choices = gltf::readChoices(folder / "a.glb");
    EXPECT_EQ(choices.scenes, (std::vector<std::string>{"day \u00e4", ""}));
    EXPECT_EQ(choices.defaultScene, 1);
    EXPECT_EQ(choices.variants, (std::vector<std::string>{"red", "green"}));
    writeFileAtomically(
        folder / "b.gltf",
        std::string_view(R"({"scenes": 7, "scene": "a", "extensions": {"KHR_materials_variants": []}})"));
    EXPECT_TRUE(gltf::readChoices(folder / "b.gltf").scenes.empty());
    writeFileAtomically(folder / "c.gltf", std::string_view("{\"scenes\": [\n{]}"));
    expectError(ErrorKind::BadInput, [&] { gltf::readChoices(folder / "c.gltf"); }, {"c.gltf:2:2", "not valid JSON"});
}

TEST(GltfFeatures, FiveInfluencesAndJointsOutsideTheScene) {
    GltfBuilder file;
    file.triangle();
    const int j0 = file.accessor<uint8_t>({0, 1, 2, 3, 0, 0, 0, 0, 1, 0, 0, 0}, "VEC4", 4, 5121);
    const int w0 = file.floats({1, 1, 1, 1, 2, 0, 0, 0, 0, 0, 0, 0}, "VEC4", 4);
    const int j1 = file.accessor<uint8_t>({4, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}, "VEC4", 4, 5121);
    const int w1 = file.floats({1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}, "VEC4", 4);
    nlohmann::json& attributes = file.primitive()["attributes"];
    attributes["JOINTS_0"] = j0, attributes["WEIGHTS_0"] = w0, attributes["JOINTS_1"] = j1,
    attributes["WEIGHTS_1"] = w1;
    file.json["nodes"] = {{{"mesh", 0}, {"skin", 0}},  {{"children", {2, 3, 4, 5, 6}}}, {}, {}, {}, {},
                          {{"translation", {0, 0, 5}}}};
    for (const size_t i : {2u, 3u, 4u, 5u}) file.json["nodes"][i] = nlohmann::json::object();
    file.json["skins"] = {{{"joints", {2, 3, 4, 5, 6}}}};
    const auto scene = std::make_shared<Scene>(file.load());
    const Mesh& mesh = *scene->instances[0].mesh;
    EXPECT_EQ(mesh.skin.first, (std::vector<uint32_t>{0, 5, 6, 7}));
    EXPECT_NEAR(mesh.skin.weight[4], 0.2f, 1e-6f);
    EXPECT_EQ(mesh.skin.weight[5], 1);
    EXPECT_EQ(mesh.skin.joint[6], 0u) << "no weight at all follows joint 0";
    const auto posed = poseScene(scene, {});
    expectNear(posed->instances[0].deformed->positions[0], {0, 0, 1});
    expectNear(posed->instances[0].deformed->positions[1], {1, 0, 0});
    file.json["skins"][0]["joints"] = {2, 3, 4, 5};
    file.expectRefused({"/nodes/0/skin", "joint", "below 4"});
}

TEST(GltfFeatures, AnimationsOfAllKinds) {
    GltfBuilder file;
    file.triangle();
    const int morph = file.floats({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3", 3);
    file.primitive()["targets"] = {{{"POSITION", morph}}};
    file.json["meshes"][0]["weights"] = {0.5};
    const int times = file.floats({0, 2}, "SCALAR", 1);
    const int slide = file.floats({0, 0, 0, 4, 0, 0}, "VEC3", 3);
    const int weights = file.floats({0, 1}, "SCALAR", 1);
    file.json["animations"] = {{{"channels",
                                 {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}},
                                  {{"sampler", 1}, {"target", {{"node", 0}, {"path", "weights"}}}}}},
                                {"samplers",
                                 {{{"input", times}, {"output", slide}},
                                  {{"input", times}, {"output", weights}, {"interpolation", "STEP"}}}}}};
    file.json["animations"].push_back(file.json["animations"][0]);
    MessageLog log;
    const auto scene = std::make_shared<Scene>(file.load(log));
    ASSERT_EQ(scene->animations.size(), 1u) << "the second moves the same things";
    EXPECT_FLOAT_EQ(scene->duration(), 2);
    EXPECT_EQ(scene->nodes[0].morphWeights, std::vector<float>{0.5f});
    const auto posed = poseScene(scene, {.open = 1, .close = 1, .previousOpen = 0.5f});
    expectNear(Vec3(posed->instances[0].worldFromObject[3]), {2, 0, 0});
    expectNear(Vec3(posed->instances[0].worldFromObjectPrevious()[3]), {1, 0, 0});
    expectNear(posed->instances[0].deformed->positions[0], {0, 0, 0});
    file.json["animations"][0]["samplers"][0]["output"] = weights;
    file.expectRefused({"/animations/0/samplers/0/output"});
}

TEST(GltfFeatures, ContentDigestFollowsEveryByte) {
    GltfBuilder file;
    file.triangle();
    const std::string before = file.load().contentDigest;
    EXPECT_EQ(before, file.load().contentDigest);
    EXPECT_EQ(before.size(), 16u);
    file.bin[0] = 1;
    EXPECT_NE(before, file.load().contentDigest);
}

/// In a path a plus is a plus [RFC 3986]; a percent sign that escapes nothing is one too.
TEST(GltfFeatures, NamesOfFilesMayHavePlusAndPercentSigns) {
    test::TemporaryFolder folder;
    GltfBuilder file;
    file.triangle();
    for (const char* name : {"c++.bin", "100%.bin", "50%2B.bin"}) {
        const std::string onDisk = name == std::string("50%2B.bin") ? "50+.bin" : name;
        file.json["buffers"] = {{{"byteLength", file.bin.size()}, {"uri", name}}};
        writeFileAtomically(folder / onDisk, file.bin);
        writeFileAtomically(folder / "a.gltf", std::string_view(file.json.dump()));
        MessageLog log;
        EXPECT_EQ(loadGltf(folder / "a.gltf", log).triangleCount(), 1) << name;
    }
}

TEST(GltfFeatures, FilesWithPartsAndEscapedNames) {
    test::TemporaryFolder folder;
    GltfBuilder file;
    file.triangle();
    file.json["buffers"] = {{{"byteLength", file.bin.size()}, {"uri", "sub%20folder/the%20data.bin"}}};
    std::vector<uint8_t> longer = file.bin;
    longer.resize(longer.size() + 3);
    writeFileAtomically(folder / "sub folder/the data.bin", longer);
    writeFileAtomically(folder / "a b.gltf", std::string_view(file.json.dump()));
    MessageLog log;
    const Scene scene = loadGltf(folder / "a b.gltf", log);
    EXPECT_EQ(scene.triangleCount(), 1);
    EXPECT_TRUE(log.warnings().empty());
    std::filesystem::resize_file(folder / "sub folder/the data.bin", 10);
    expectError(ErrorKind::BadInput, [&] { loadGltf(folder / "a b.gltf", log); }, {"a b.gltf"});
}

}  // namespace
}  // namespace lumi
