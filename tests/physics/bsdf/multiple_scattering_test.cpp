#include <gtest/gtest.h>

#include <cmath>

#include "math/statistics.h"
#include "physics/bsdf/materials.h"
#include "trace/anisotropic_albedo.h"
#include "trace/fresnel.h"
#include "trace/sampler.h"

namespace lumi::test {
namespace {

// A metal that absorbs nothing is invisible in a furnace, however rough and however stretched its facets.
TEST(MultipleScattering, WhiteMetalIsOne) {
    for (const float roughness : {0.0f, 0.02f, 0.05f, 0.1f, 0.2f, 0.35f, 0.5f, 0.7f, 0.85f, 1.0f})
        for (const float cosTheta : {1.0f, 0.8f, 0.5f, 0.2f, 0.05f})
            for (const float anisotropy : {0.0f, 0.2f, 0.5f, 0.8f, 1.0f}) {
                BsdfInputs inputs;
                inputs.metallic = 1;
                inputs.roughness = roughness;
                inputs.multipleScattering = true;
                inputs.layered = true;
                inputs.layers.anisotropy = anisotropy;
                inputs.layers.anisotropyDirection = {0.3f, 1};
                const Bsdf bsdf(inputs, directionAt(cosTheta));
                EXPECT_NEAR(bsdf.specularAlbedo().y, 1, 1e-5f);
                RunningMoments m;
                for (uint32_t i = 0; i < 4096; ++i) {
                    const SampleStream stream(SamplerKind::Independent, 0, 1, {3, 4, i});
                    m.add(bsdf.sample(stream.get1(0), stream.get2(2)).weight.y);
                }
                const double error = 4.5 * std::sqrt(m.meanVariance());
                EXPECT_LE(m.mean(), 1 + 1e-3 + error) << roughness << " " << cosTheta << " " << anisotropy;
                EXPECT_GE(m.mean(), 1 - 0.01 - error) << roughness << " " << cosTheta << " " << anisotropy;
            }
}

/// The pair of SchlickAlbedo by the midpoint rule over slopes in proportion to the facets' own distribution.
glm::dvec2 albedoBySlopes(const Ggx& ggx, const Vec3& wo) {
    constexpr int kRings = 200, kTurns = 720;
    glm::dvec2 sum(0);
    for (int i = 0; i < kRings; ++i)
        for (int j = 0; j < kTurns; ++j) {
            const double t = (i + 0.5) / kRings, slope = std::sqrt(1 / (t * t) - 1),
                         phi = 2 * M_PI * (j + 0.5) / kTurns;
            const double x = ggx.alpha * ggx.stretch * slope * std::cos(phi),
                         y = ggx.alpha * ggx.shrink * slope * std::sin(phi);
            const glm::dvec3 h = glm::normalize(glm::dvec3(x, y, 1)), o(wo);
            const double c = glm::dot(o, h);
            const Vec3 wi(2 * c * h - o);
            if (c <= 0 || wi.z <= 0) continue;
            // Facets of this slope have the area 1 / h.z over the surface.
            const double share = 2 * t * c / (h.z * wo.z) * maskingShadowing(ggx.lambda(wo), ggx.lambda(wi));
            const double s = schlickWeight(static_cast<float>(c));
            sum += share * glm::dvec2(1 - s, s);
        }
    return sum / double(kRings * kTurns);
}

// The tables keep what their headers promise: the sum matters most, for what it lacks is what is given back.
TEST(AlbedoTable, IsotropicIsOffByLessThanAThousandth) {
    for (uint32_t i = 0; i < 60; ++i) {
        const SampleStream stream(SamplerKind::Independent, 0, 25, {6, 6, i});
        const float roughness = 0.02f + 0.98f * sqr(stream.get1(0)), cosTheta = 0.02f + 0.98f * sqr(stream.get1(1));
        const Ggx ggx{sqr(roughness)};
        const glm::dvec2 exact = albedoBySlopes(ggx, directionAt(cosTheta));
        const Vec2 tabled = SchlickAlbedo::get().directional(RoughnessRow(roughness), {ggx.alpha, cosTheta});
        EXPECT_NEAR(tabled.x + tabled.y, exact.x + exact.y, 1e-3) << roughness << " " << cosTheta;
        EXPECT_NEAR(tabled.y, exact.y, 1.5e-3) << roughness << " " << cosTheta;
    }
}

TEST(AlbedoTable, StretchedNeverSaysTooLittle) {
    for (uint32_t i = 0; i < 60; ++i) {
        const SampleStream stream(SamplerKind::Independent, 0, 26, {6, 7, i});
        const Vec2 roughness = Vec2(0.02f) + 0.98f * stream.get2(0);
        const float cosTheta = 0.02f + 0.98f * sqr(stream.get1(2)), phi = 2 * kPi * stream.get1(3);
        const float r = std::sqrt(1 - cosTheta * cosTheta);
        const Ggx ggx = Ggx::anisotropic(sqr(roughness.x), sqr(roughness.y));
        const Vec3 wo(r * std::cos(phi), r * std::sin(phi), cosTheta);
        const glm::dvec2 exact = albedoBySlopes(ggx, wo);
        const Vec2 tabled = AnisotropicAlbedo::get().directional(ggx, wo);
        EXPECT_GE(tabled.x + tabled.y, exact.x + exact.y - 1e-3)
            << roughness.x << " " << roughness.y << " " << cosTheta;
        EXPECT_LE(tabled.x + tabled.y, exact.x + exact.y + 5e-3)
            << roughness.x << " " << roughness.y << " " << cosTheta;
    }
}

// Metals absorb at each bounce: what comes back more than once is more saturated, and less than all that was lost.
TEST(MultipleScattering, ColouredMetalSaturates) {
    BsdfInputs inputs;
    inputs.metallic = 1;
    inputs.roughness = 1;
    inputs.baseColor = {0.9f, 0.5f, 0.1f};
    const Vec3 once = Bsdf(inputs, directionAt(0.7f)).specularAlbedo();
    inputs.multipleScattering = true;
    const Vec3 many = Bsdf(inputs, directionAt(0.7f)).specularAlbedo(), added = many - once;
    EXPECT_GT(added.x / added.z, once.x / once.z);
    for (int c = 0; c < 3; ++c) EXPECT_LT(many[c], 1);
}

TEST(MultipleScattering, SmoothSurfacesHaveNone) {
    BsdfInputs inputs;
    inputs.metallic = 1;
    inputs.roughness = 0;
    const Bsdf without(inputs, directionAt(0.4f));
    inputs.multipleScattering = true;
    const Bsdf with(inputs, directionAt(0.4f));
    EXPECT_EQ(with.specularAlbedo(), without.specularAlbedo());
    EXPECT_TRUE(with.isDelta());
}

}  // namespace
}  // namespace lumi::test
