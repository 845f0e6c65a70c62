#include <gtest/gtest.h>

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

// In a furnace of radiance 1 a lobe shows its directional albedo; all together never more than arrives.
TEST(BsdfEnergy, FurnaceBySamplingEqualsAlbedo) {
    forEachBsdf(kRoughnesses, kCosines, [](const Bsdf& bsdf, const BsdfInputs& inputs, const Vec3&, const std::string& label) {
        const uint32_t kSamples = inputs.layered ? 65536 : 16384;
        glm::dvec3 sums[kLobeCount] = {}, total(0);
        for (uint32_t i = 0; i < kSamples; ++i) {
            const SampleStream stream(SamplerKind::Sobol, 0, 1, {3, 4, i});
            const BsdfSample s = bsdf.sample(stream.get1(0), stream.get2(2));
            if (s.lobe == Lobe::None) continue;
            total += glm::dvec3(s.weight);
            for (int lobe = 0; lobe < kLobeCount; ++lobe) {
                if (s.delta && s.lobe == kLobes[lobe]) sums[lobe] += glm::dvec3(s.weight);
                if (!s.delta) sums[lobe] += glm::dvec3(bsdf.evaluate(s.wi, kLobes[lobe]) / s.pdf);
            }
        }
        Vec3 albedos(0);
        for (int lobe = 0; lobe < kLobeCount; ++lobe) {
            expectClose(Vec3(sums[lobe] / double(kSamples)), bsdf.albedo(kLobes[lobe]),
                        label + ", " + nameOf(kLobes[lobe]));
            albedos += bsdf.albedo(kLobes[lobe]);
        }
        expectClose(Vec3(total / double(kSamples)), albedos, label + ", all lobes");
        EXPECT_LE(maxComponent(albedos), 1 + 1e-5f) << label;
        EXPECT_LE(maxComponent(Vec3(total / double(kSamples))), 1.005f) << label;
    });
}

TEST(BsdfEnergy, QuadratureOfEvaluateEqualsAlbedo) {
    forEachBsdf({0.05f, 0.1f, 0.3f, 0.6f, 1}, kCosines,
                [](const Bsdf& bsdf, const BsdfInputs& inputs, const Vec3& wo, const std::string& label) {
                    // Stretched a hundredfold, the midpoint rule's facets are too few.
                    if (inputs.layers.anisotropy > 0 && inputs.roughness < 0.3f) return;
                    Vec3 total(0);
                    for (const Lobe lobe : kLobes) {
                        if (isBlack(bsdf.albedo(lobe))) continue;
                        if (lobe == Lobe::Clearcoat && inputs.layers.clearcoatRoughness == 0) {
                            total += bsdf.albedo(lobe);
                            continue;
                        }
                        const Vec3 integral = integrateLobe(bsdf, inputs, wo, lobe);
                        expectClose(integral, bsdf.albedo(lobe), label + ", " + nameOf(lobe));
                        total += integral;
                    }
                    EXPECT_LE(maxComponent(total), 1.004f) << label;
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
