#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "physics/bsdf/materials.h"
#include "trace/clearcoat.h"
#include "trace/fresnel.h"
#include "trace/sheen.h"
#include "trace/thin_film.h"

namespace lumi::test {
namespace {

Vec3 fromAngles(float cosTheta, float phi) {
    const float r = std::sqrt(1 - cosTheta * cosTheta);
    return {r * std::cos(phi), r * std::sin(phi), cosTheta};
}

TEST(ThinFilm, NothingIsTheBareSurface) {
    const Vec3 f0(0.04f, 0.5f, 0.95f);
    const ThinFilm film(1.4f, 0, f0);
    for (const float c : {1.0f, 0.7f, 0.3f, 0.05f})
        for (int k = 0; k < 3; ++k)
            EXPECT_NEAR(film.reflectance(c)[k], f0[k] + (1 - f0[k]) * schlickWeight(c), 1e-6f) << c;
}

// A quarter of a wave of the geometric mean's index takes the reflection of glass away, half a wave leaves it.
TEST(ThinFilm, QuarterWaveIsAntireflective) {
    const float index = std::sqrt(1.5f), quarter = 550 / (4 * index);
    const Vec3 f0(0.04f);
    EXPECT_LT(ThinFilm(index, quarter, f0).reflectance(1).y, 0.004f);
    EXPECT_NEAR(ThinFilm(index, 2 * quarter, f0).reflectance(1).y, 0.04f, 0.008f);
}

// Too thick for colours: the incoherent sum of all bounces between its faces.
TEST(ThinFilm, ThickFilmIsAPlate) {
    const ThinFilm film(1.5f, 60000, Vec3(0.9f));
    const float index = (1 + std::sqrt(0.9f)) / (1 - std::sqrt(0.9f));
    const float upper = 0.04f, lower = sqr((index - 1.5f) / (index + 1.5f));
    const float plate = upper + sqr(1 - upper) * lower / (1 - upper * lower);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(film.reflectance(1)[c], plate, 1e-3f);
}

TEST(ThinFilm, StaysInRangeAndAveragesRight) {
    for (const float index : {1.0f, 1.3f, 1.8f, 2.5f})
        for (const float thickness : {0.0f, 5.0f, 100.0f, 250.0f, 400.0f, 700.0f, 1000.0f}) {
            // The average is taken at twelve angles, which resolve three waves of violet light and twice that in the
            // second order.
            if (2 * thickness * (index - std::sqrt(sqr(index) - 1)) > 3 * 380) continue;
            const ThinFilm film(index, thickness, {0.04f, 0.4f, 1});
            Vec3 sum(0);
            for (int i = 0; i < 400; ++i) {
                const float c = std::sqrt((static_cast<float>(i) + 0.5f) / 400);
                const Vec3 r = film.reflectance(c);
                ASSERT_TRUE(isFinite(r) && minComponent(r) >= 0 && maxComponent(r) <= 1);
                sum += r / 400.0f;
            }
            for (int k = 0; k < 3; ++k)
                EXPECT_NEAR(film.averageReflectance()[k], sum[k], 0.005f) << index << " " << thickness;
        }
}

TEST(Sheen, LobeIsReciprocalAndNeverGlows) {
    LayerInputs layers;
    layers.sheenColor = {1, 0.5f, 0.2f};
    for (const float roughness : {0.0f, 0.2f, 0.5f, 1.0f}) {
        layers.sheenRoughness = roughness;
        for (const float c : {1.0f, 0.6f, 0.2f, 0.05f, 0.01f}) {
            const Vec3 wo = fromAngles(c, 0.4f), wi = fromAngles(0.37f, 2.1f);
            const Vec3 there = Sheen(layers, wo).evaluate(wi).f / wi.z, back = Sheen(layers, wi).evaluate(wo).f / wo.z;
            EXPECT_NEAR(there.x, back.x, 1e-4f * back.x);
            glm::dvec3 sum(0);
            constexpr int kRings = 200, kSectors = 100;
            for (int i = 0; i < kRings * kSectors; ++i) {
                const float x = (static_cast<float>(i / kSectors) + 0.5f) / kRings;
                const Vec3 w = fromAngles(x * x, 2 * kPi * (static_cast<float>(i % kSectors) + 0.5f) / kSectors);
                sum += glm::dvec3(Sheen(layers, wo).evaluate(w).f) * (2.0 * x);
            }
            sum *= 2 * M_PI / (kRings * kSectors);
            EXPECT_NEAR(sum.x, Sheen(layers, wo).albedo().x, 0.01 * std::max(sum.x, 0.25)) << roughness << " " << c;
            EXPECT_LE(sum.x, 1.002) << roughness << " " << c;
        }
    }
}

TEST(Clearcoat, LobeIsReciprocal) {
    LayerInputs layers;
    layers.clearcoat = 0.7f, layers.clearcoatRoughness = 0.3f;
    layers.clearcoatNormal = glm::normalize(Vec3(0.1f, -0.2f, 1));
    const Vec3 a = fromAngles(0.4f, 0.4f), b = fromAngles(0.6f, 3.1f), n = layers.clearcoatNormal;
    const float ab = Clearcoat(layers, a).evaluate(b).f.x / glm::dot(b, n);
    EXPECT_NEAR(ab, Clearcoat(layers, b).evaluate(a).f.x / glm::dot(a, n), 1e-4f * ab);
    EXPECT_GT(ab, 0);
}

TEST(Clearcoat, SmoothCoatMirrorsAboutItsOwnNormal) {
    BsdfInputs inputs;
    inputs.layered = true;
    inputs.layers.clearcoat = 1;
    inputs.layers.clearcoatNormal = glm::normalize(Vec3(0.1f, 0, 1));
    const Vec3 wo = fromAngles(0.8f, 1), n = inputs.layers.clearcoatNormal;
    const BsdfSample s = Bsdf(inputs, wo).sample(0, {0.5f, 0.5f});
    ASSERT_EQ(s.lobe, Lobe::Clearcoat);
    EXPECT_TRUE(s.delta);
    EXPECT_NEAR(glm::length(s.wi - (2 * glm::dot(wo, n) * n - wo)), 0, 1e-5f);
}

// Layers over a white surface that keeps all energy change nothing in a furnace.
TEST(Layers, WhiteStaysWhite) {
    for (const float c : {1.0f, 0.5f, 0.1f}) {
        BsdfInputs inputs;
        inputs.roughness = 0;
        inputs.layered = true;
        inputs.layers.sheenColor = Vec3(1), inputs.layers.sheenRoughness = 0.4f;
        inputs.layers.clearcoat = 1, inputs.layers.clearcoatRoughness = 0.2f;
        const Bsdf bsdf(inputs, fromAngles(c, 0));
        EXPECT_NEAR(bsdf.albedo(Lobe::Diffuse).x + bsdf.specularAlbedo().x, 1, 1e-4f) << c;
    }
}

// The least film is nearly none, for every base and where light and eye graze.
TEST(Layers, FilmBeginsWithoutAStep) {
    const Vec3 wo = fromAngles(std::cos(radians(85)), 0);
    for (const float transmission : {0.0f, 0.5f, 1.0f})
        for (const float metallic : {0.0f, 0.5f})
            for (const float specular : {1.0f, 0.4f})
                for (const float degrees : {85.0f, 20.0f}) {
                    BsdfInputs inputs;
                    inputs.transmission = transmission, inputs.metallic = metallic, inputs.specular = specular;
                    inputs.layered = inputs.multipleScattering = true;
                    inputs.layers.iridescenceThickness = 400;
                    const Bsdf bare(inputs, wo);
                    inputs.layers.iridescence = 1e-4f;
                    const Bsdf filmed(inputs, wo);
                    const Vec3 wi = fromAngles(std::cos(radians(degrees)), 2);
                    const std::string name = fmt::format("transmission {}, metallic {}, specular {}, light at {}",
                                                         transmission, metallic, specular, degrees);
                    for (const Lobe lobe : {Lobe::Diffuse, Lobe::SpecularReflection, Lobe::SpecularTransmission})
                        for (int c = 0; c < 3; ++c) {
                            const float albedo = bare.albedo(lobe)[c], value = bare.evaluate(wi, lobe)[c];
                            EXPECT_NEAR(filmed.albedo(lobe)[c], albedo, 0.002f * albedo) << name;
                            EXPECT_NEAR(filmed.evaluate(wi, lobe)[c], value, 0.002f * value) << name;
                        }
                    for (const float share : {1e-4f, 0.3f, 1.0f}) {
                        inputs.layers.iridescence = share;
                        const Bsdf some(inputs, wo);
                        EXPECT_LE(maxComponent(some.albedo(Lobe::Diffuse) + some.specularAlbedo()), 1 + 1e-5f) << name;
                    }
                }
}

// With nothing on it a layered material is the plain one to the last bit.
TEST(Layers, NoneIsTheSameBits) {
    forEachBsdf({0, 0.3f, 1}, {0.9f, 0.2f},
                [](const Bsdf&, const BsdfInputs& given, const Vec3& wo, const auto& label) {
                    BsdfInputs inputs = given;
                    inputs.layers = {};
                    inputs.layered = false;
                    const Bsdf plain(inputs, wo);
                    inputs.layered = true;
                    const Bsdf layered(inputs, wo);
                    const Vec3 wi = fromAngles(0.6f, 2);
                    EXPECT_EQ(plain.evaluate(wi).specular, layered.evaluate(wi).specular) << label;
                    EXPECT_EQ(plain.evaluate(wi).pdf, layered.evaluate(wi).pdf) << label;
                    EXPECT_EQ(plain.sample(0.7f, {0.2f, 0.3f}).wi, layered.sample(0.7f, {0.2f, 0.3f}).wi) << label;
                });
}

// Stretched facets make a highlight that is long across the brushing and narrow along the other way.
TEST(Anisotropy, HighlightIsLongAlongItsDirection) {
    BsdfInputs inputs;
    inputs.metallic = 1, inputs.roughness = 0.3f;
    inputs.layered = true;
    inputs.layers.anisotropy = 0.8f, inputs.layers.anisotropyDirection = {0, 1};
    const Bsdf bsdf(inputs, {0, 0, 1});
    EXPECT_GT(bsdf.evaluate(fromAngles(0.8f, kPi / 2)).specular.x, 10 * bsdf.evaluate(fromAngles(0.8f, 0)).specular.x);
}

}  // namespace
}  // namespace lumi::test
