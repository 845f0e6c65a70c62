#include "trace/environment.h"

#include <gtest/gtest.h>

#include "math/hash.h"
#include "math/statistics.h"
#include "math/warp.h"

namespace lumi {
namespace {

/// Dim with two bright spots, one at the seam, one near the pole.
Environment spottedSky(int width, int height) {
    auto image = std::make_shared<Image>(Extent2{width, height}, 3);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (int c = 0; c < 3; ++c)
                image->at(c, x, y) = 0.2f + (x == width - 1 && y == height / 3 ? 500.0f : 0.0f) +
                                     (x == width / 4 && y == 1 ? 300.0f : 0.0f);
    Environment sky;
    sky.image = image;
    sky.scale = 2;
    sky.rotateDeg = 70;
    return sky;
}

TEST(EnvironmentLight, LookupFollowsTheContract) {
    auto image = std::make_shared<Image>(Extent2{8, 4}, 3);
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 8; ++x)
            image->at(0, x, y) = static_cast<float>(x), image->at(1, x, y) = static_cast<float>(y);
    Environment sky;
    sky.image = image;
    EnvironmentLight light;
    light.build(sky);
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 8; ++x) {
            const Vec3 found = light.radiance(directionFromLatLong(Vec2((x + 0.5f) / 8, (y + 0.5f) / 4)));
            EXPECT_NEAR(found.x, x, 1e-4);
            EXPECT_NEAR(found.y, y, 1e-4);
        }
    // Turned by 90 degrees counter-clockwise seen from above, what was at -Z is at -X.
    sky.rotateDeg = 90;
    EnvironmentLight turned;
    turned.build(sky);
    EXPECT_LT(glm::distance(turned.radiance(Vec3(-1, 0, 0)), light.radiance(Vec3(0, 0, -1))), 1e-3f);
}

TEST(EnvironmentLight, DensityIntegratesToOneAndMatchesItsSamples) {
    for (const int width : {16, 64, 300, 1500, 3200}) {
        EnvironmentLight light;
        light.build(spottedSky(width, width / 2));
        RunningMoments inverse, integral;
        double brightest = 0;
        for (uint32_t i = 0; i < 200000; ++i) {
            const Vec2 u(unitFloat(hashCombine(1, i)), unitFloat(hashCombine(2, i)));
            float pdf = 0;
            Vec2 place;
            const Vec3 direction = light.sample(u, pdf, place);
            const Vec3 radiance = light.radianceAt(place);
            ASSERT_GT(pdf, 0);
            ASSERT_NEAR(glm::length(direction), 1, 1e-5);
            // A sample on a cell's border may fall to either side.
            if (i < 2000 && std::abs(light.pdf(direction) - pdf) > 1e-3f * pdf) inverse.add(0);
            else if (i < 2000) inverse.add(1);
            integral.add(radiance.y / pdf);
            brightest = std::max(brightest, double(radiance.y / pdf));
        }
        EXPECT_GT(inverse.mean(), 0.995);
        RunningMoments whole;
        for (uint32_t i = 0; i < 400000; ++i) {
            const Vec3 direction = sampleSphere(Vec2(unitFloat(hashCombine(3, i)), unitFloat(hashCombine(4, i))));
            whole.add(light.pdf(direction) * 4 * kPi);
        }
        EXPECT_NEAR(whole.mean(), 1, 5 * std::sqrt(whole.meanVariance())) << width;
        // The integral of radiance: 4 pi times the mean.
        const double expected = 4 * kPi * light.meanLuminance();
        EXPECT_NEAR(integral.mean(), expected, 0.02 * expected) << width;
        EXPECT_LT(std::sqrt(integral.meanVariance()), 0.01 * expected) << "importance sampling that helps";
        EXPECT_LT(brightest, 100 * expected) << width;
    }
}

TEST(EnvironmentLight, EveryDirectionWithLightCanBeDrawn) {
    EnvironmentLight light;
    light.build(spottedSky(64, 32));
    for (uint32_t i = 0; i < 20000; ++i) {
        const Vec3 direction = sampleSphere(Vec2(unitFloat(hashCombine(5, i)), unitFloat(hashCombine(6, i))));
        if (light.radiance(direction).y > 0) {
            EXPECT_GT(light.pdf(direction), 0);
        }
    }
}

TEST(EnvironmentLight, ConstantAndBlack) {
    Environment sky;
    EnvironmentLight light;
    light.build(sky);
    EXPECT_TRUE(light.black());
    sky.constant = Vec3(2, 3, 4);
    sky.scale = 0.5f;
    light.build(sky);
    EXPECT_FALSE(light.black());
    EXPECT_EQ(light.radiance(Vec3(0, 1, 0)), Vec3(1, 1.5f, 2));
    EXPECT_FLOAT_EQ(light.pdf(Vec3(1, 0, 0)), pdfSphere());
}

}  // namespace
}  // namespace lumi
