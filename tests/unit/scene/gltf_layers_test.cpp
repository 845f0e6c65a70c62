#include <gtest/gtest.h>

#include "params/parameter.h"
#include "unit/scene/gltf_support.h"

namespace lumi::test {
namespace {

Material loaded(const char* material, MessageLog& log) {
    GltfBuilder file;
    file.triangle();
    file.primitive()["material"] = 0;
    file.json["materials"] = {nlohmann::json::parse(material)};
    return file.load(log).materials[0];
}

TEST(GltfLayers, FactorsAreRead) {
    MessageLog log;
    const Material m = loaded(R"({"extensions": {
        "KHR_materials_clearcoat": {"clearcoatFactor": 0.5, "clearcoatRoughnessFactor": 0.25},
        "KHR_materials_sheen": {"sheenColorFactor": [1, 0.5, 0.25], "sheenRoughnessFactor": 0.75},
        "KHR_materials_anisotropy": {"anisotropyStrength": 0.6, "anisotropyRotation": 1.5},
        "KHR_materials_iridescence": {"iridescenceFactor": 0.8, "iridescenceIor": 1.7,
          "iridescenceThicknessMinimum": 200, "iridescenceThicknessMaximum": 500}}})",
                              log);
    EXPECT_TRUE(log.warnings().empty());
    EXPECT_TRUE(m.isLayered());
    EXPECT_FLOAT_EQ(m.clearcoat, 0.5f);
    EXPECT_FLOAT_EQ(m.clearcoatRoughness, 0.25f);
    EXPECT_FLOAT_EQ(m.sheenColor.y, 0.5f);
    EXPECT_FLOAT_EQ(m.sheenRoughness, 0.75f);
    EXPECT_FLOAT_EQ(m.anisotropy, 0.6f);
    EXPECT_FLOAT_EQ(m.anisotropyRotation, 1.5f);
    EXPECT_FLOAT_EQ(m.iridescence, 0.8f);
    EXPECT_FLOAT_EQ(m.iridescenceIor, 1.7f);
    EXPECT_FLOAT_EQ(m.iridescenceThicknessMin, 200);
    EXPECT_FLOAT_EQ(m.iridescenceThicknessMax, 500);
}

TEST(GltfLayers, DefaultsAreThoseOfTheSpecification) {
    MessageLog log;
    const Material m = loaded(R"({"extensions": {"KHR_materials_clearcoat": {}, "KHR_materials_sheen": {},
        "KHR_materials_anisotropy": {}, "KHR_materials_iridescence": {}}})",
                              log);
    EXPECT_FALSE(m.isLayered());
    EXPECT_FLOAT_EQ(m.iridescenceIor, 1.3f);
    EXPECT_FLOAT_EQ(m.iridescenceThicknessMin, 100);
    EXPECT_FLOAT_EQ(m.iridescenceThicknessMax, 400);
}

TEST(GltfLayers, NonsenseIsClamped) {
    MessageLog log;
    const Material m = loaded(R"({"extensions": {
        "KHR_materials_clearcoat": {"clearcoatFactor": 7, "clearcoatRoughnessFactor": -1},
        "KHR_materials_sheen": {"sheenColorFactor": [-1, 9, 0]},
        "KHR_materials_iridescence": {"iridescenceIor": 0, "iridescenceThicknessMaximum": -5}}})",
                              log);
    EXPECT_FLOAT_EQ(m.clearcoat, 1);
    EXPECT_FLOAT_EQ(m.clearcoatRoughness, 0);
    EXPECT_EQ(m.sheenColor, Vec3(0, 1, 0));
    EXPECT_FLOAT_EQ(m.iridescenceIor, 1);
    EXPECT_FLOAT_EQ(m.iridescenceThicknessMax, 0);
}

TEST(GltfLayers, UnlitScattersNothing) {
    MessageLog log;
    const Material m = loaded(R"({"pbrMetallicRoughness": {"baseColorFactor": [0.2, 0.3, 0.4, 1]}, "extensions": {
        "KHR_materials_unlit": {}, "KHR_materials_clearcoat": {"clearcoatFactor": 1},
        "KHR_materials_sheen": {"sheenColorFactor": [1, 1, 1]}, "KHR_materials_anisotropy": {"anisotropyStrength": 1},
        "KHR_materials_iridescence": {"iridescenceFactor": 1}}})",
                              log);
    EXPECT_FALSE(m.isLayered());
    EXPECT_EQ(m.emission, Vec3(0.2f, 0.3f, 0.4f));
}

TEST(GltfLayers, EmissionBeyondSumsIsLimitedAndSaid) {
    MessageLog log;
    const Material m = loaded(R"({"emissiveFactor": [1e9, 1e9, 0],
        "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 1e38}}})",
                              log);
    EXPECT_EQ(m.emission, Vec3(1e9f, 1e9f, 0));
    ASSERT_EQ(log.warnings().size(), 1u);
    EXPECT_NE(log.warnings()[0].find("/materials/0 emits"), std::string::npos);
    MessageLog quiet;
    EXPECT_EQ(loaded(R"({"emissiveFactor": [1, 1, 1],
        "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 1e6}}})",
                     quiet)
                  .emission,
              Vec3(1e6f));
    EXPECT_TRUE(quiet.warnings().empty());
}

// What a user can move depends on which layers are there, and moves them.
TEST(GltfLayers, LayersAreParameters) {
    Material m;
    const auto describe = [&](ParameterVisitor& v) { m.describe(v); };
    setParameter(describe, "anisotropy", ParameterValue(0.5f), "test");
    setParameter(describe, "anisotropy-rotate-deg", ParameterValue(90.0f), "test");
    EXPECT_FLOAT_EQ(m.anisotropyRotation, kPi / 2);
    setParameter(describe, "clearcoat", ParameterValue(1.0f), "test");
    setParameter(describe, "clearcoat-roughness", ParameterValue(0.3f), "test");
    EXPECT_FLOAT_EQ(m.clearcoatRoughness, 0.3f);
}

}  // namespace
}  // namespace lumi::test
