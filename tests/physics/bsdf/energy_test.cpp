#include <gtest/gtest.h>

#include <cmath>

#include "math/statistics.h"
#include "physics/bsdf/materials.h"
#include "trace/sampler.h"

namespace lumi::test {
namespace {

const std::vector<float> kRoughnesses{0, 0.02f, 0.1f, 0.3f, 0.6f, 1};
const std::vector<float> kCosines{1, 0.9f, 0.6f, 0.3f, 0.1f};

/// One per cent of the value, or of a quarter of what arrives.
void expectClose(const Vec3& found, const Vec3& expected, const std::string& label) {
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(found[c], expected[c], 0.01f * std::max(expected[c], 0.25f)) << label << ", channel " << c;
}

const char* nameOf(Lobe lobe) {
    constexpr const char* kNames[] = {"none", "diffuse", "reflection", "transmission", "clearcoat", "sheen"};
    return kNames[static_cast<int>(lobe)];
}

/// By how much the tables of albedos may say too little, and a surface shine brighter than its furnace (AlbedoTable's
/// tests hold them to it).
constexpr double kTableError = 1e-3;
/// Standard errors that one of some ten thousand means may be off with a chance of 1%.
constexpr double kSigmas = 4.9;

// In a furnace of radiance 1 a lobe shows its directional albedo; all together never more than arrives.
TEST(BsdfEnergy, FurnaceBySamplingEqualsAlbedo) {
    constexpr uint32_t kSamples = 8192;
    forEachBsdf(kRoughnesses, kCosines, [](const Bsdf& bsdf, const BsdfInputs&, const Vec3&, const std::string& label) {
        RunningMoments lobes[kLobeCount][3], totals[3];
        for (uint32_t i = 0; i < kSamples; ++i) {
            const SampleStream stream(SamplerKind::Independent, 0, 1, {3, 4, i});
            const BsdfSample s = bsdf.sample(stream.get1(0), stream.get2(2));
            const bool drawn = s.lobe != Lobe::None;
            for (int lobe = 0; lobe < kLobeCount; ++lobe) {
                Vec3 share(0);
                if (drawn && s.delta && s.lobe == kLobes[lobe]) share = s.weight;
                if (drawn && !s.delta) share = bsdf.evaluate(s.wi, kLobes[lobe]) / s.pdf;
                for (int c = 0; c < 3; ++c) lobes[lobe][c].add(share[c]);
            }
            for (int c = 0; c < 3; ++c) totals[c].add(drawn ? s.weight[c] : 0);
        }
        Vec3 albedos(0);
        const auto expectAlbedo = [&](const RunningMoments& m, double expected, const std::string& name) {
            EXPECT_NEAR(m.mean(), expected, 0.01 * std::max(expected, 0.25) + kSigmas * std::sqrt(m.meanVariance())) << name;
        };
        for (int lobe = 0; lobe < kLobeCount; ++lobe) {
            const Vec3 albedo = bsdf.albedo(kLobes[lobe]);
            for (int c = 0; c < 3; ++c) expectAlbedo(lobes[lobe][c], albedo[c], label + ", " + nameOf(kLobes[lobe]));
            albedos += albedo;
        }
        EXPECT_LE(maxComponent(albedos), 1 + 1e-5f) << label;
        for (int c = 0; c < 3; ++c) {
            expectAlbedo(totals[c], albedos[c], label + ", all lobes");
            EXPECT_LE(totals[c].mean(), 1 + kTableError + kSigmas * std::sqrt(totals[c].meanVariance())) << label;
        }
    });
}

TEST(BsdfEnergy, QuadratureOfEvaluateEqualsAlbedo) {
    forEachBsdf({0.02f, 0.06f, 0.3f, 0.6f, 1}, {1, 0.6f, 0.3f, 0.1f},
                [](const Bsdf& bsdf, const BsdfInputs& inputs, const Vec3& wo, const std::string& label) {
                    Vec3 total(0);
                    for (const Lobe lobe : kLobes) {
                        if (isBlack(bsdf.albedo(lobe))) continue;
                        if (lobe == Lobe::Clearcoat && inputs.layers.clearcoatRoughness == 0) {
                            total += bsdf.albedo(lobe);
                            continue;
                        }
                        const LobeIntegral integral = integrateLobe(bsdf, inputs, wo, lobe);
                        EXPECT_LE(integral.error, 1e-3f) << label << ", " << nameOf(lobe);
                        expectClose(integral.value, bsdf.albedo(lobe), label + ", " + nameOf(lobe));
                        total += integral.value;
                    }
                    EXPECT_LE(maxComponent(total), 1 + kTableError) << label;
                });
}

// With nothing absorbed and a smooth layer, what the layer lets through comes out of the white base again.
TEST(BsdfEnergy, SmoothWhitePlasticKeepsAllEnergy) {
    for (const float cosTheta : kCosines) {
        BsdfInputs inputs;
        inputs.roughness = 0;
        const Bsdf bsdf(inputs, directionAt(cosTheta));
        EXPECT_NEAR(bsdf.albedo(Lobe::Diffuse).x + bsdf.specularAlbedo().x, 1, 1e-5f) << cosTheta;
    }
}

TEST(BsdfEnergy, LambertIsBaseColorOverPi) {
    BsdfInputs inputs;
    inputs.specular = 0;
    inputs.baseColor = {0.8f, 0.4f, 0.2f};
    const Bsdf bsdf(inputs, directionAt(0.3f));
    const Vec3 wi = glm::normalize(Vec3(0.2f, -0.5f, 0.7f));
    for (int c = 0; c < 3; ++c) {
        EXPECT_FLOAT_EQ(bsdf.albedo(Lobe::Diffuse)[c], inputs.baseColor[c]);
        EXPECT_NEAR(bsdf.evaluate(wi).diffuse[c], inputs.baseColor[c] * kInvPi * wi.z, 1e-6f);
    }
}

// Head-on reflectance of a smooth surface is F0 to the letter.
TEST(BsdfEnergy, HeadOnReflectanceIsF0) {
    BsdfInputs inputs;
    inputs.roughness = 0;
    inputs.ior = 1.7f;
    inputs.specular = 0.5f;
    inputs.specularColor = {1, 0.5f, 0};
    const Vec3 albedo = Bsdf(inputs, {0, 0, 1}).specularAlbedo();
    const float f0 = sqr(0.7f / 2.7f) * 0.5f;
    EXPECT_NEAR(albedo.x, f0, 1e-6f);
    EXPECT_NEAR(albedo.y, 0.5f * f0, 1e-6f);
    EXPECT_NEAR(albedo.z, 0, 1e-6f);
    inputs.metallic = 1;
    inputs.baseColor = {0.9f, 0.6f, 0.3f};
    EXPECT_NEAR(Bsdf(inputs, {0, 0, 1}).specularAlbedo().y, 0.6f, 1e-6f);
}

TEST(BsdfEnergy, TablesOfOneIndexAreMadeOnce) {
    const float ior = DielectricAlbedo::roundedIor(1.6f);
    const DielectricAlbedo* first = &DielectricAlbedo::get(ior, true);
    EXPECT_EQ(first, &DielectricAlbedo::get(ior, true));
    EXPECT_NE(first, &DielectricAlbedo::get(ior, false));
    EXPECT_NEAR(ior, 1.6f, 0.5f / 1024);
}

}  // namespace
}  // namespace lumi::test
