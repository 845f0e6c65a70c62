// Error of few samples, spread so that the eye and a filter average it out: few low frequencies at the same size.
#include "trace/blue_noise.h"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <set>
#include <vector>

#include "support/transport_scene.h"
#include "trace/sampler.h"

namespace lumi {
namespace {

using namespace test;
constexpr int kSide = BlueNoiseTile::kSide;

TEST(BlueNoise, TileHoldsEveryRankOnce) {
    std::set<float> values;
    for (uint32_t y = 0; y < kSide; ++y)
        for (uint32_t x = 0; x < kSide; ++x) values.insert(BlueNoiseTile::instance().at(x, y));
    EXPECT_EQ(values.size(), size_t(kSide) * kSide);
    EXPECT_EQ(*values.begin(), 0);
    EXPECT_LT(*values.rbegin(), 1);
    EXPECT_EQ(BlueNoiseTile::instance().at(5, 70), BlueNoiseTile::instance().at(5 + kSide, 6));
}

TEST(BlueNoise, TileHasHardlyAnyLowFrequencies) {
    // Power of all waves up to an eighth of a cycle a pixel, against the mean power of white noise of the same
    // variance.
    double low = 0, variance = 0;
    int waves = 0;
    for (uint32_t i = 0; i < uint32_t(kSide) * kSide; ++i)
        variance += std::pow(double(BlueNoiseTile::instance().at(i % kSide, i / kSide)) - 0.5, 2);
    for (int v = 0; v <= 8; ++v)
        for (int u = -8; u <= 8; ++u) {
            if (u * u + v * v > 64 || (v == 0 && u <= 0)) continue;
            std::complex<double> sum = 0;
            for (int y = 0; y < kSide; ++y)
                for (int x = 0; x < kSide; ++x) {
                    const double value =
                        BlueNoiseTile::instance().at(static_cast<uint32_t>(x), static_cast<uint32_t>(y));
                    sum += value * std::polar(1.0, 2 * 3.14159265358979 * (u * x + v * y) / kSide);
                }
            low += std::norm(sum);
            ++waves;
        }
    EXPECT_LT(low / waves, 0.03 * variance);
}

/// Two dimensions with one place in the tile would rise and fall together from pixel to pixel.
TEST(BlueNoise, EveryDimensionHasAPlaceOfItsOwn) {
    for (uint32_t seed = 0; seed < 300; ++seed) {
        const auto rise = [&](uint32_t dimension, uint32_t x, uint32_t y) {
            const auto at = [&](uint32_t px, uint32_t py) {
                return SampleStream(SamplerKind::BlueNoise, 0, seed, {px, py, 0}).get1(dimension);
            };
            const float difference = at(x, y) - at(0, 0);
            return std::lround((difference < 0 ? difference + 1 : difference) * kSide * kSide) % (kSide * kSide);
        };
        std::set<std::pair<long, long>> places;
        for (uint32_t d = 0; d < dimension::vertex(4, 0); ++d) places.emplace(rise(d, 1, 0), rise(d, 0, 1));
        ASSERT_EQ(places.size(), dimension::vertex(4, 0)) << "seed " << seed;
    }
}

struct ErrorPower {
    double all = 0, low = 0;  ///< mean square, and that of means over 4 x 4 pixels times 16: equal for white noise
};

TEST(BlueNoise, ErrorOfAnImageHasFewLowFrequenciesAtTheSameSize) {
    TinyScene tiny;
    tiny.add(floorMesh(20), lambert(0.7f));
    tiny.add(boxMesh(Vec3(1)), lambert(0.5f), translation(Vec3(0.8f, 0.5f, 0)));
    Light lamp;
    lamp.type = LightType::Rectangle;
    lamp.size = Vec2(1.5f, 1.5f);
    lamp.radiance = Vec3(4);
    tiny.addLight(lamp, lookAt(Vec3(-1, 3, 1), Vec3(0), Vec3(0, 0, 1)));
    Tracer tracer;
    tracer.bind(tiny.pose());
    const Extent2 extent{96, 64};
    PathSettings path = plainPaths(1);
    path.sampler = SamplerKind::Sobol;
    const Camera camera = lookFrom(Vec3(0, 3, 5), Vec3(0, 0, -0.3f), 35);
    Signals truth, frame;
    FrameSampling sampling = frameOf(camera, extent, 512, path, {Signal::Noisy}, 99);
    sampling.jitter = Jitter::None;
    ASSERT_TRUE(tracer.sample(sampling, truth));
    sampling.samplesPerPixel = 1;

    const auto power = [&](SamplerKind kind) {
        ErrorPower sum;
        for (uint32_t seed = 0; seed < 4; ++seed) {
            sampling.path.sampler = kind;
            sampling.seed = seed;
            EXPECT_TRUE(tracer.sample(sampling, frame));
            const auto error = [&](int x, int y) {
                const double value = truth[Signal::Noisy].at(1, x, y);
                return (frame[Signal::Noisy].at(1, x, y) - value) / (value + 0.05);
            };
            for (int y = 0; y < extent.height; y += 4)
                for (int x = 0; x < extent.width; x += 4) {
                    double block = 0;
                    for (int k = 0; k < 16; ++k) {
                        const double e = error(x + k % 4, y + k / 4);
                        block += e, sum.all += e * e;
                    }
                    sum.low += block * block;
                }
        }
        return sum;
    };
    const ErrorPower white = power(SamplerKind::Sobol), blue = power(SamplerKind::BlueNoise);
    EXPECT_NEAR(white.low / white.all, 1, 0.25);
    EXPECT_NEAR(blue.all / white.all, 1, 0.1);
    EXPECT_LT(blue.low / blue.all, 0.5 * white.low / white.all);
}

}  // namespace
}  // namespace lumi
