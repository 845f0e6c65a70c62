#include "trace/sampler.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <vector>

#include "math/statistics.h"

namespace lumi {
namespace {

/// Those whose pixels know nothing of one another, and all.
constexpr SamplerKind kKinds[] = {SamplerKind::Sobol, SamplerKind::Halton, SamplerKind::Independent};
constexpr SamplerKind kAllKinds[] = {SamplerKind::Sobol, SamplerKind::Halton, SamplerKind::Independent,
                                     SamplerKind::BlueNoise};

SampleStream sobol(uint32_t x, uint32_t y, uint32_t sample, uint32_t seed = 0) {
    return {SamplerKind::Sobol, 16, seed, {x, y, sample}};
}

/// True if each of the 2^k boxes of every shape 2^-a by 2^-(k-a) holds exactly one of the points.
bool isNet(const std::vector<Vec2>& points) {
    int k = 0;
    while ((size_t(1) << k) < points.size()) ++k;
    for (int a = 0; a <= k; ++a) {
        std::vector<int> count(points.size(), 0);
        for (const Vec2& p : points) {
            const auto column = static_cast<size_t>(p.x * static_cast<float>(1 << a));
            const auto row = static_cast<size_t>(p.y * static_cast<float>(1 << (k - a)));
            if (++count[(column << (k - a)) + row] > 1) return false;
        }
    }
    return true;
}

TEST(Sampler, SobolPairsAreNets) {
    for (const uint32_t size : {1u, 2u, 4u, 16u, 64u, 256u, 1024u, 4096u})
        for (const uint32_t pair : {0u, 2u, 6u, 46u, 1000u})
            for (const uint32_t block : {0u, 1u, 5u}) {
                // Any aligned block of a power of two is a net, not only the first: frames continue the sequence.
                std::vector<Vec2> points;
                for (uint32_t i = 0; i < size; ++i) points.push_back(sobol(11, 7, block * size + i, 3).get2(pair));
                EXPECT_TRUE(isNet(points)) << size << " points, dimension " << pair << ", block " << block;
            }
}

TEST(Sampler, OtherPairsAreNotNets) {
    // The property is that of pairs: dimension 1 with dimension 2 is no pair. Guards against isNet() being vacuous.
    std::vector<Vec2> points;
    for (uint32_t i = 0; i < 256; ++i) points.push_back({sobol(1, 2, i).get1(1), sobol(1, 2, i).get1(2)});
    EXPECT_FALSE(isNet(points));
}

TEST(Sampler, SingleDimensionsAreStratified) {
    for (const uint32_t dimension : {0u, 1u, 4u, 7u, 93u}) {
        std::set<int> strata;
        for (uint32_t i = 0; i < 512; ++i) strata.insert(static_cast<int>(sobol(4, 4, i).get1(dimension) * 512));
        EXPECT_EQ(strata.size(), 512u);
    }
}

TEST(Sampler, PairsAgreeWithSingles) {
    for (const SamplerKind kind : kAllKinds)
        for (const uint32_t dimension : {0u, 6u, 60u, 126u, 300u}) {
            const SampleStream stream(kind, 16, 5, {3, 9, 12});
            const Vec2 pair = stream.get2(dimension);
            EXPECT_EQ(pair.x, stream.get1(dimension));
            EXPECT_EQ(pair.y, stream.get1(dimension + 1));
        }
}

TEST(Sampler, StaysInRangeForAnyKey) {
    const uint32_t words[] = {0, 1, 2, 0x7fffffffu, 0x80000000u, 0xfffffffeu, 0xffffffffu};
    for (const SamplerKind kind : kAllKinds)
        for (const uint32_t x : words)
            for (const uint32_t sample : words)
                for (const uint32_t dimension : {0u, 1u, 54u, 127u, 128u, 0x7ffffffeu})
                    for (const int loop : {16, 1, 0x7fffffff}) {
                        const float value = SampleStream(kind, loop, x, {x, ~x, sample}).get1(dimension);
                        ASSERT_GE(value, 0);
                        ASSERT_LT(value, 1);
                    }
}

// Over pixels at one sample index each dimension is uniform: the scrambles and rotations are.
TEST(Sampler, UniformOverPixels) {
    constexpr int kBins = 64, kSide = 200;
    const int tests = 4 * 5;
    for (const SamplerKind kind : kAllKinds)
        for (const uint32_t dimension : {0u, 1u, 9u, 100u, 200u}) {
            std::vector<double> observed(kBins), expected(kBins, double(kSide) * kSide / kBins);
            for (uint32_t y = 0; y < kSide; ++y)
                for (uint32_t x = 0; x < kSide; ++x)
                    observed[static_cast<size_t>(SampleStream(kind, 16, 1, {x, y, 5}).get1(dimension) * kBins)] += 1;
            EXPECT_GT(chiSquareTest(observed, expected), sidakLevel(0.01, tests)) << dimension;
        }
}

// Neighbouring pixels, seeds and dimensions know nothing of one another: joint histograms are flat.
TEST(Sampler, ScramblesAreIndependent) {
    constexpr int kBins = 16, kSide = 200;
    const auto pairedWith = [](SamplerKind kind, uint32_t x, uint32_t y, int how) {
        switch (how) {
            case 0: return SampleStream(kind, 16, 1, {x + 1, y, 3}).get1(2);
            case 1: return SampleStream(kind, 16, 1, {x, y + 1, 3}).get1(2);
            case 2: return SampleStream(kind, 16, 2, {x, y, 3}).get1(2);
            default: return SampleStream(kind, 16, 1, {x, y, 3}).get1(8);
        }
    };
    for (const SamplerKind kind : kKinds)
        for (int how = 0; how < 4; ++how) {
            std::vector<double> observed(kBins * kBins);
            const std::vector<double> expected(kBins * kBins, double(kSide) * kSide / (kBins * kBins));
            for (uint32_t y = 0; y < kSide; ++y)
                for (uint32_t x = 0; x < kSide; ++x) {
                    // Every second column, so that each number is used once.
                    const float a = SampleStream(kind, 16, 1, {2 * x, 2 * y, 3}).get1(2);
                    const float b = pairedWith(kind, 2 * x, 2 * y, how);
                    observed[static_cast<size_t>(a * kBins) * kBins + static_cast<size_t>(b * kBins)] += 1;
                }
            EXPECT_GT(chiSquareTest(observed, expected), sidakLevel(0.01, 3 * 4)) << how;
        }
}

// What nested scrambling is for: over a smooth function 64 points err far less than 64 independent ones do.
TEST(Sampler, SobolIntegratesSmoothFunctionsFasterThanIndependent) {
    const auto squaredError = [](SamplerKind kind) {
        RunningMoments errors;
        for (uint32_t pixel = 0; pixel < 400; ++pixel) {
            double sum = 0;
            for (uint32_t i = 0; i < 64; ++i) {
                const Vec2 u = SampleStream(kind, 64, 0, {pixel, 0, i}).get2(4);
                sum += std::exp(u.x) * std::cos(u.y);
            }
            const double error = sum / 64 - (std::exp(1.0) - 1) * std::sin(1.0);
            errors.add(error * error);
        }
        return errors.mean();
    };
    EXPECT_LT(squaredError(SamplerKind::Sobol), 0.01 * squaredError(SamplerKind::Independent));
}

TEST(Sampler, HaltonRepeatsAfterItsLoop) {
    for (const uint32_t dimension : {0u, 1u, 13u, 130u}) {
        const auto at = [&](uint32_t sample) {
            return SampleStream(SamplerKind::Halton, 16, 0, {8, 9, sample}).get1(dimension);
        };
        std::set<float> values;
        for (uint32_t i = 0; i < 16; ++i) {
            EXPECT_EQ(at(i), at(i + 16));
            EXPECT_EQ(at(i), at(i + 160));
            values.insert(at(i));
        }
        EXPECT_EQ(values.size(), 16u);
    }
}

TEST(Sampler, HaltonIsRadicalInverseRotated) {
    // 1/2, 1/4, 3/4 in base 2 and 1/3, 2/3, 1/9 in base 3, apart from the pixel's rotation, which sample 0 shows.
    const float expected[2][3] = {{0.5f, 0.25f, 0.75f}, {1.0f / 3, 2.0f / 3, 1.0f / 9}};
    for (uint32_t dimension = 0; dimension < 2; ++dimension) {
        const auto at = [&](uint32_t sample) {
            return SampleStream(SamplerKind::Halton, 1024, 0, {2, 3, sample}).get1(dimension);
        };
        for (uint32_t i = 0; i < 3; ++i) {
            const float difference = at(i + 1) - at(0);
            EXPECT_NEAR(difference - std::floor(difference), expected[dimension][i], 1e-6f);
        }
    }
}

TEST(Sampler, IsAFunctionOfItsArguments) {
    for (const SamplerKind kind : kAllKinds) {
        const SampleStream a(kind, 16, 7, {100, 200, 3}), b(kind, 16, 7, {100, 200, 3});
        const SampleStream otherSeed(kind, 16, 8, {100, 200, 3}), otherSample(kind, 16, 7, {100, 200, 4});
        for (uint32_t dimension = 0; dimension < 64; dimension += 2) {
            EXPECT_EQ(a.get2(dimension), b.get2(dimension));
            EXPECT_NE(a.get2(dimension), otherSeed.get2(dimension));
            EXPECT_NE(a.get2(dimension), otherSample.get2(dimension));
        }
    }
}

TEST(Sampler, DimensionsOfVerticesDoNotOverlap) {
    EXPECT_EQ(dimension::vertex(0, 0), dimension::kCamera);
    EXPECT_EQ(dimension::vertex(1, dimension::kLobe), dimension::vertex(0, dimension::kRoulette) + 2);
    for (const uint32_t use : {dimension::kBsdf, dimension::kLight, dimension::kLightPoint})
        EXPECT_EQ(dimension::vertex(3, use) % 2, 0u);
}

}  // namespace
}  // namespace lumi
