#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "math/statistics.h"
#include "math/transform.h"
#include "physics/bsdf/materials.h"
#include "trace/fresnel.h"
#include "trace/sampler.h"

namespace lumi::test {
namespace {

BsdfInputs glass(float roughness, bool entering = true, float ior = 1.5f, bool many = false) {
    BsdfInputs inputs;
    inputs.transmission = 1;
    inputs.solid = true;
    inputs.roughness = roughness;
    inputs.entering = entering;
    inputs.ior = ior;
    inputs.multipleScattering = many;
    return inputs;
}

TEST(Dielectric, FresnelKnownValues) {
    EXPECT_NEAR(fresnelDielectric(1, 1.5f), 0.04f, 1e-6f);
    EXPECT_NEAR(fresnelDielectric(1, 1 / 1.5f), 0.04f, 1e-6f);
    EXPECT_NEAR(fresnelDielectric(0, 1.5f), 1, 1e-6f);
    EXPECT_EQ(fresnelDielectric(0.7f, 1 / 1.5f), 1);  // beyond the critical cosine 0.745
    // At Brewster's angle only the perpendicular part is reflected: half of ((n^2 - 1) / (n^2 + 1))^2.
    const float brewster = 1 / std::sqrt(1 + 1.5f * 1.5f);
    EXPECT_NEAR(fresnelDielectric(brewster, 1.5f), 0.5f * sqr(1.25f / 3.25f), 1e-6f);
    EXPECT_NEAR(fresnelDielectric(0.3f, 1), 0, 1e-12f);
    // The same pair of directions reflects the same from both sides.
    const float cosI = 0.4f, cosT = std::sqrt(1 - (1 - cosI * cosI) / (1.5f * 1.5f));
    EXPECT_NEAR(fresnelDielectric(cosI, 1.5f), fresnelDielectric(cosT, 1 / 1.5f), 1e-6f);
}

TEST(Dielectric, SmoothReflectsAndTransmitsAll) {
    for (const bool entering : {true, false})
        for (const float cosTheta : {1.0f, 0.8f, 0.5f, 0.1f, 0.001f}) {
            const Bsdf bsdf(glass(0, entering), directionAt(cosTheta));
            EXPECT_TRUE(bsdf.isDelta());
            EXPECT_NEAR(bsdf.specularAlbedo().y, 1, 1e-6f) << entering << " " << cosTheta;
        }
}

TEST(Dielectric, SmoothDirectionsObeySnell) {
    for (const bool entering : {true, false}) {
        const Vec3 wo = directionAt(0.85f);
        const Bsdf bsdf(glass(0, entering), wo);
        for (uint32_t i = 0; i < 64; ++i) {
            const BsdfSample s = bsdf.sample((static_cast<float>(i) + 0.5f) / 64, {0.3f, 0.6f});
            ASSERT_TRUE(s.delta);
            EXPECT_EQ(s.pdf, 0);
            EXPECT_NEAR(glm::length(s.wi), 1, 1e-6f);
            const float ratio = s.lobe == Lobe::SpecularReflection ? 1 : entering ? 1.5f : 1 / 1.5f;
            EXPECT_NEAR(-s.wi.x * ratio, wo.x, 1e-6f);
            EXPECT_NEAR(-s.wi.y * ratio, wo.y, 1e-6f);
            EXPECT_EQ(s.wi.z > 0, s.lobe == Lobe::SpecularReflection);
        }
    }
}

TEST(Dielectric, ThinWallGoesStraightOnTintedOnce) {
    BsdfInputs inputs = glass(0);
    inputs.solid = false;
    inputs.baseColor = {0.9f, 0.5f, 0.2f};
    const Vec3 wo = directionAt(0.6f);
    const Bsdf bsdf(inputs, wo);
    const BsdfSample s = bsdf.sample(0.999f, {0.5f, 0.5f});
    ASSERT_EQ(s.lobe, Lobe::SpecularTransmission);
    EXPECT_NEAR(glm::length(s.wi + wo), 0, 1e-6f);
    const float through = 1 - fresnelDielectric(0.6f, 1.5f);
    for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(bsdf.albedo(Lobe::SpecularTransmission)[c], through * inputs.baseColor[c], 1e-5f);
        EXPECT_NEAR(s.weight[c] * bsdf.probability(s.lobe), through * inputs.baseColor[c], 1e-5f);
    }
}

TEST(Dielectric, IndexOneIsNotThere) {
    for (const bool solid : {true, false}) {
        BsdfInputs inputs = glass(0.3f, true, 1);
        inputs.solid = solid;
        const Vec3 wo = directionAt(0.5f);
        const Bsdf bsdf(inputs, wo);
        EXPECT_NEAR(maxComponent(bsdf.albedo(Lobe::SpecularReflection)), 0, 1e-12f);
        EXPECT_GT(bsdf.albedo(Lobe::SpecularTransmission).x, 0.97f);
        if (!solid) continue;
        EXPECT_NEAR(glm::length(bsdf.sample(0.5f, {0.2f, 0.2f}).wi + wo), 0, 1e-5f);
    }
}

// Rough glass loses only what would have scattered twice or more between facets: little when nearly smooth.
TEST(Dielectric, RoughLossIsBounded) {
    const float roughnesses[] = {0.05f, 0.2f, 0.4f, 0.7f, 1}, least[] = {0.995f, 0.97f, 0.88f, 0.63f, 0.4f};
    for (const bool entering : {true, false})
        for (const float cosTheta : {1.0f, 0.7f, 0.4f})
            for (int i = 0; i < 5; ++i) {
                const float total = Bsdf(glass(roughnesses[i], entering), directionAt(cosTheta)).specularAlbedo().x;
                EXPECT_LE(total, 1 + 1e-5f);
                EXPECT_GE(total, least[i]) << roughnesses[i] << " " << cosTheta << " " << entering;
            }
}

/// Glass under each weight and colour of KHR_materials_specular: thin, and from both sides of a solid.
template <class Check>
void forEachWeighted(const Check& check) {
    for (const float specular : {0.0f, 0.5f, 1.0f})
        for (const Vec3& colour : {Vec3(1), Vec3(1, 0.2f, 0.2f), Vec3(10)})
            for (const bool solid : {false, true})
                for (const bool entering : {true, false}) {
                    BsdfInputs inputs = glass(0, entering, 1.5f, true);
                    inputs.specular = specular, inputs.specularColor = colour, inputs.solid = solid;
                    if (solid || entering) check(inputs);
                }
}

std::string nameOf(const BsdfInputs& i, float cosTheta) {
    return fmt::format("specular {} of ({} {} {}), solid {}, entering {}, roughness {}, cosine {}", i.specular,
                       i.specularColor.x, i.specularColor.y, i.specularColor.z, i.solid, i.entering, i.roughness,
                       cosTheta);
}

// F0 = min(0.04 specularColor, 1) specular and F90 = specular; what the greatest channel leaves goes through.
TEST(Dielectric, SmoothWeightedFollowsTheFormula) {
    forEachWeighted([](const BsdfInputs& inputs) {
        for (const float cosTheta : {1.0f, 0.8f, 0.5f, 0.05f}) {
            const Bsdf bsdf(inputs, directionAt(cosTheta));
            const float exact = fresnelDielectric(cosTheta, inputs.entering ? 1.5f : 1 / 1.5f);
            const bool total = !inputs.entering && exact == 1;
            Vec3 reflected(1);
            for (int c = 0; c < 3 && !total; ++c) {
                const float f0 = std::min(0.04f * inputs.specularColor[c], 1.0f);
                reflected[c] = inputs.specular * (f0 + (1 - f0) * (exact - 0.04f) / 0.96f);
            }
            for (int c = 0; c < 3; ++c) {
                const std::string name = nameOf(inputs, cosTheta);
                EXPECT_NEAR(bsdf.albedo(Lobe::SpecularReflection)[c], reflected[c], 1e-5f) << name;
                EXPECT_NEAR(bsdf.albedo(Lobe::SpecularTransmission)[c], 1 - maxComponent(reflected), 1e-5f) << name;
            }
        }
    });
}

// What a weight takes from reflection goes through, and a colour above 1 takes from what goes through: where every
// channel is alike a furnace shows 1, and never more.
TEST(Dielectric, WeightedGlassIsOneInFurnace) {
    forEachWeighted([](BsdfInputs inputs) {
        for (const float cosTheta : {1.0f, 0.7f, 0.4f, 0.1f})
            for (const float roughness : {0.0f, 0.05f, 0.3f, 0.8f}) {
                inputs.roughness = roughness;
                const std::string name = nameOf(inputs, cosTheta);
                const Bsdf bsdf(inputs, directionAt(cosTheta));
                const bool white = inputs.specularColor.x == inputs.specularColor.y;
                RunningMoments channels[3];
                for (uint32_t i = 0; i < 4096; ++i) {
                    const SampleStream stream(SamplerKind::Independent, 0, 29, {5, 4, i});
                    const Vec3 weight = bsdf.sample(stream.get1(0), stream.get2(2)).weight;
                    for (int c = 0; c < 3; ++c) channels[c].add(weight[c]);
                }
                for (int c = 0; c < 3; ++c) {
                    const double error = 4.5 * std::sqrt(channels[c].meanVariance());
                    const float albedo = bsdf.specularAlbedo()[c];
                    EXPECT_LE(albedo, 1 + 1e-3f) << name;
                    EXPECT_LE(channels[c].mean(), 1 + 1e-3 + error) << name;
                    if (!white && c > 0) continue;
                    // Inside a clear solid no more is given back than what its table knows for sure.
                    EXPECT_GE(albedo, 1 - (inputs.entering ? 2e-3f : 6e-3f)) << name;
                    EXPECT_GE(channels[c].mean(), 1 - 0.01 - error) << name;
                }
            }
    });
}

// With radiance over the square of the index transported, f(out, in) / n_in^2 = f(in, out) / n_out^2.
TEST(Dielectric, RefractionIsReciprocal) {
    int compared = 0;
    for (uint32_t i = 0; i < 2000; ++i) {
        const bool many = i % 1000 >= 500, weighted = i >= 1000;
        const auto at = [&](bool entering, const Vec3& wo) {
            BsdfInputs inputs = glass(0.5f, entering, 1.5f, many);
            if (weighted) inputs.specular = 0.4f, inputs.specularColor = {3, 5, 0};
            return Bsdf(inputs, wo);
        };
        const SampleStream stream(SamplerKind::Independent, 0, 13, {9, 9, i});
        const Vec3 wo = directionAt(0.1f + 0.9f * stream.get1(0));
        const BsdfSample s = at(true, wo).sample(0.999f, stream.get2(2));
        if (s.lobe != Lobe::SpecularTransmission || s.wi.z > -0.05f) continue;
        const Vec3 backWo(s.wi.x, s.wi.y, -s.wi.z), backWi(wo.x, wo.y, -wo.z);
        const float there = at(true, wo).evaluate(s.wi, Lobe::SpecularTransmission).x / -s.wi.z;
        const float back = at(false, backWo).evaluate(backWi, Lobe::SpecularTransmission).x / wo.z;
        ASSERT_NEAR(there / (1.5f * 1.5f * back), 1, 2e-3f) << many << weighted;
        ++compared;
    }
    EXPECT_GT(compared, 1200);
}

/// Weight of a path from outside at `origin` along `direction` through a unit glass sphere in a furnace of radiance 1.
double spherePath(const BsdfInputs& material, Vec3 origin, Vec3 direction, const RandomKey& key, int maxBounces) {
    const SampleStream stream(SamplerKind::Independent, 0, 17, key);
    double weight = 1;
    bool outside = true;
    for (int bounce = 0; bounce < maxBounces; ++bounce) {
        const float b = glm::dot(origin, direction), c = glm::dot(origin, origin) - 1;
        const float discriminant = b * b - c;
        if (outside && (discriminant <= 0 || b > 0)) return weight;
        const float distance = outside ? -b - std::sqrt(discriminant) : -b + std::sqrt(std::max(0.0f, discriminant));
        origin = glm::normalize(origin + distance * direction);
        const Frame frame(outside ? origin : -origin);
        BsdfInputs inputs = material;
        inputs.entering = outside;
        const Bsdf bsdf(inputs, frame.toLocal(-direction));
        const uint32_t dimension = static_cast<uint32_t>(bounce) * 4;
        const BsdfSample s = bsdf.sample(stream.get1(dimension), stream.get2(dimension + 2));
        if (s.lobe == Lobe::None) return 0;
        weight *= s.weight.x;
        if (s.wi.z < 0) outside = !outside;
        direction = glm::normalize(frame.toWorld(s.wi));
        if (outside) return weight;  // a sphere is not hit again from outside
    }
    return 0;
}

RunningMoments sphereFurnace(const BsdfInputs& material, uint32_t paths) {
    RunningMoments moments;
    for (uint32_t i = 0; i < paths; ++i) {
        const SampleStream stream(SamplerKind::Independent, 0, 19, {1, 1, i});
        const Vec2 u = stream.get2(0);
        const float r = std::sqrt(u.x), phi = 2 * kPi * u.y;
        const Vec3 origin(r * std::cos(phi), r * std::sin(phi), 3);
        moments.add(spherePath(material, origin, {0, 0, -1}, {2, 3, i}, 400));
    }
    return moments;
}

TEST(Dielectric, SmoothSphereVanishesInFurnace) {
    const RunningMoments m = sphereFurnace(glass(0), 20000);
    EXPECT_NEAR(m.mean(), 1, std::max(4 * std::sqrt(m.meanVariance()), 1e-4));
    EXPECT_LT(std::sqrt(m.meanVariance()), 0.01);
}

// Nor does it show under any weight or colour of its reflection that is the same in all channels.
TEST(Dielectric, WeightedSphereVanishesInFurnace) {
    for (const float roughness : {0.0f, 0.4f})
        for (const Vec2& specularAndColour : {Vec2(0, 1), Vec2(0.5f, 1), Vec2(0.5f, 10), Vec2(1, 10), Vec2(1, 0)}) {
            BsdfInputs inputs = glass(roughness, true, 1.5f, true);
            inputs.specular = specularAndColour.x, inputs.specularColor = Vec3(specularAndColour.y);
            const RunningMoments m = sphereFurnace(inputs, 20000);
            const double error = std::sqrt(m.meanVariance());
            EXPECT_NEAR(m.mean(), 1, std::max(4 * error, 1e-4) + (roughness > 0 ? 0.01 : 0))
                << roughness << " " << specularAndColour.x << " " << specularAndColour.y;
            EXPECT_LE(m.mean(), 1 + 1e-3 + 4 * error);
        }
}

TEST(Dielectric, RoughSphereNeverGlows) {
    double previous = 1;
    for (const float roughness : {0.1f, 0.4f, 0.8f}) {
        const RunningMoments m = sphereFurnace(glass(roughness), 20000);
        EXPECT_LE(m.mean(), previous + 4 * std::sqrt(m.meanVariance())) << roughness;
        EXPECT_GE(m.mean(), 0.4) << roughness;
        previous = m.mean();
    }
}

// With what facets scatter more than once nothing is lost: every side of every boundary is white, and so is the sphere.
TEST(Dielectric, WhiteGlassIsOne) {
    for (const float ior : {1.1f, 1.5f, 2.4f})
        for (const bool entering : {true, false})
            for (const float cosTheta : {1.0f, 0.7f, 0.4f, 0.1f})
                for (const float roughness : {0.03f, 0.1f, 0.3f, 0.5f, 0.8f, 1.0f}) {
                    const BsdfInputs inputs = glass(roughness, entering, ior, true);
                    const Vec3 wo = directionAt(cosTheta);
                    const Bsdf bsdf(inputs, wo);
                    EXPECT_NEAR(bsdf.specularAlbedo().x, 1, 2e-3f);
                    RunningMoments m;
                    for (uint32_t i = 0; i < 8192; ++i) {
                        const SampleStream stream(SamplerKind::Independent, 0, 23, {5, 4, i});
                        m.add(bsdf.sample(stream.get1(0), stream.get2(2)).weight.x);
                    }
                    const double error = 4.5 * std::sqrt(m.meanVariance());
                    EXPECT_LE(m.mean(), 1 + 1e-3 + error) << ior << entering << cosTheta << " " << roughness;
                    EXPECT_GE(m.mean(), 1 - 0.01 - error) << ior << entering << cosTheta << " " << roughness;
                }
}

TEST(Dielectric, RoughSphereVanishesInFurnace) {
    for (const float roughness : {0.1f, 0.3f, 0.6f, 1.0f}) {
        const RunningMoments m = sphereFurnace(glass(roughness, true, 1.5f, true), 100000);
        const double error = std::sqrt(m.meanVariance());
        EXPECT_LT(error, 0.003) << roughness;
        EXPECT_NEAR(m.mean(), 1, 0.01) << roughness;
        EXPECT_LE(m.mean(), 1 + 1e-3 + 3 * error) << roughness;
    }
}

}  // namespace
}  // namespace lumi::test
