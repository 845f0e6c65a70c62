#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "math/hash.h"
#include "physics/bsdf/materials.h"

namespace lumi::test {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

bool isUsable(const Vec3& v) { return isFinite(v) && minComponent(v) >= 0; }

void expectUsable(const Bsdf& bsdf, const std::string& label) {
    Vec3 total(0);
    for (const Lobe lobe : kLobes) {
        ASSERT_TRUE(isUsable(bsdf.albedo(lobe))) << label;
        total += bsdf.albedo(lobe);
    }
    ASSERT_LE(maxComponent(total), 1 + 1e-5f) << label;
    for (int i = 0; i < 25; ++i) {
        const float t = static_cast<float>(i) / 24, almost = std::min(t, 0x1.fffffep-1f);
        const BsdfSample s = bsdf.sample(almost, {1 - almost > 0.99f ? 0.9999999f : 1 - almost, almost});
        ASSERT_TRUE(isUsable(s.weight) && std::isfinite(s.pdf) && s.pdf >= 0) << label;
        ASSERT_EQ(s.delta || s.lobe == Lobe::None, s.pdf == 0) << label;
        ASSERT_NEAR(glm::length(s.wi), s.lobe == Lobe::None ? 0 : 1, 1e-4f) << label;
        for (const float z : {1.0f, 0.3f, 1e-3f, 1e-7f, 0.0f, -1e-7f, -0.4f, -1.0f}) {
            const float r = std::sqrt(1 - z * z);
            const BsdfValue v = bsdf.evaluate({r * std::cos(9 * t), r * std::sin(9 * t), z});
            ASSERT_TRUE(isUsable(v.diffuse) && isUsable(v.specular) && std::isfinite(v.pdf) && v.pdf >= 0)
                << label << " z " << z;
        }
    }
}

TEST(BsdfBounds, AllRoughnessesAndGrazingAngles) {
    std::vector<float> roughnesses;
    for (int i = 0; i <= 20; ++i) roughnesses.push_back(static_cast<float>(i) / 20);
    roughnesses.push_back(0.01999f);
    roughnesses.push_back(0.02f);
    forEachBsdf(
        roughnesses, {1, 0.5f, 1e-2f, 1e-5f, 0},
        [](const Bsdf& bsdf, const BsdfInputs&, const Vec3&, const std::string& label) { expectUsable(bsdf, label); });
}

TEST(BsdfBounds, DegenerateInputs) {
    const float odd[] = {0, 1, -1, 1e-30f, 1e30f, kInfinity, -kInfinity, kNan, 0.5f, 1.0005f};
    const Vec3 directions[] = {{0, 0, 1},    {1, 0, 0},         {0, 0, 0},           {0, 0, -1},
                               {kNan, 0, 1}, {1, 1, kInfinity}, {1e-20f, 0, 1e-20f}, glm::normalize(Vec3(1, 1, 1e-3f))};
    // A fixed walk through the combinations: one input in each place drawn by hash.
    for (uint32_t i = 0; i < 3000; ++i) {
        uint32_t word = i * 16;
        const auto next = [&] { return odd[pcgHash(word++) % std::size(odd)]; };
        BsdfInputs inputs;
        inputs.baseColor = {next(), next(), next()};
        inputs.metallic = next();
        inputs.roughness = next();
        inputs.ior = i % 3 == 0 ? next() : 1.5f;
        inputs.specular = next();
        inputs.specularColor = {next(), next(), next()};
        inputs.transmission = next();
        inputs.solid = (i & 1u) != 0;
        inputs.entering = (i & 2u) != 0;
        const Vec3 wo = directions[pcgHash(word) % std::size(directions)];
        expectUsable(Bsdf(inputs, wo), "combination " + std::to_string(i));
        if (HasFatalFailure()) return;
    }
}

TEST(BsdfBounds, DirectionsThatAreNone) {
    for (const NamedMaterial& material : materials()) {
        BsdfInputs inputs = material.inputs;
        inputs.roughness = 0.3f;
        const Vec3 wo = directionAt(0.5f);
        const Bsdf bsdf(inputs, wo);
        for (const Vec3& wi : {-wo, Vec3(0), Vec3(wo.x, wo.y, -wo.z)}) {
            const BsdfValue v = bsdf.evaluate(wi);
            EXPECT_TRUE(isUsable(v.diffuse) && isUsable(v.specular) && std::isfinite(v.pdf)) << material.name;
        }
    }
}

TEST(BsdfBounds, BlackAbsorbs) {
    BsdfInputs inputs;
    inputs.baseColor = Vec3(0);
    inputs.specular = 0;
    const Bsdf bsdf(inputs, {0, 0, 1});
    EXPECT_TRUE(bsdf.isDelta());
    for (const float u : {0.0f, 0.5f, 0.999f}) {
        EXPECT_EQ(bsdf.sample(u, {0.5f, 0.5f}).lobe, Lobe::None);
        EXPECT_TRUE(isBlack(bsdf.sample(u, {0.5f, 0.5f}).weight));
    }
    EXPECT_EQ(bsdf.evaluate({0, 0, 1}).pdf, 0);
}

}  // namespace
}  // namespace lumi::test
