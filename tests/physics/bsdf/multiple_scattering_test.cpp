#include <gtest/gtest.h>

#include "physics/bsdf/materials.h"
#include "trace/sampler.h"

namespace lumi::test {
namespace {

// A metal that absorbs nothing is invisible in a furnace, however rough.
TEST(MultipleScattering, WhiteMetalIsOne) {
    for (int step = 1; step <= 20; ++step)
        for (const float cosTheta : {1.0f, 0.8f, 0.5f, 0.2f, 0.05f})
            for (const float anisotropy : {0.0f, 0.5f}) {
                BsdfInputs inputs;
                inputs.metallic = 1;
                inputs.roughness = static_cast<float>(step) / 20;
                inputs.multipleScattering = true;
                inputs.layered = true;
                inputs.layers.anisotropy = anisotropy;
                const Bsdf bsdf(inputs, directionAt(cosTheta));
                EXPECT_NEAR(bsdf.specularAlbedo().y, 1, 1e-5f);
                double sum = 0;
                constexpr uint32_t kSamples = 8192;
                for (uint32_t i = 0; i < kSamples; ++i) {
                    const SampleStream stream(SamplerKind::Sobol, 0, 1, {3, 4, i});
                    const BsdfSample s = bsdf.sample(stream.get1(0), stream.get2(2));
                    if (s.lobe != Lobe::None) sum += s.weight.y;
                }
                EXPECT_NEAR(sum / kSamples, 1, 0.01) << inputs.roughness << " " << cosTheta << " " << anisotropy;
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
