// Against published tables and closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "math/hash.h"
#include "math/statistics.h"

namespace lumi {
namespace {

TEST(Statistics, MedianIsTheMiddle) {
    EXPECT_EQ(median({}), 0);
    EXPECT_EQ(median({3}), 3);
    EXPECT_EQ(median({9, 1, 5}), 5);
    EXPECT_EQ(median({9, 1, 5, 2}), 3.5);
    EXPECT_EQ(median({4, 4, 4, 0, 100, 100}), 4);
}

TEST(Statistics, MomentsMatchTheDefinition) {
    RunningMoments moments;
    EXPECT_EQ(moments.sampleVariance(), 0);
    EXPECT_EQ(moments.meanVariance(), 0);
    // A large offset would cancel in the naive form.
    for (const double x : {4.0, 7.0, 13.0, 16.0}) moments.add(1e9 + x);
    EXPECT_EQ(moments.count(), 4);
    EXPECT_DOUBLE_EQ(moments.mean(), 1e9 + 10);
    EXPECT_DOUBLE_EQ(moments.sampleVariance(), 30);
    EXPECT_DOUBLE_EQ(moments.meanVariance(), 7.5);
}

TEST(Statistics, NormalTail) {
    EXPECT_DOUBLE_EQ(normalTail(0), 0.5);
    EXPECT_NEAR(normalTail(1.959963985), 0.025, 1e-10);
    EXPECT_NEAR(normalTail(3), 0.001349898, 1e-9);
    EXPECT_NEAR(normalTail(-1), 1 - normalTail(1), 1e-15);
    EXPECT_NEAR(normalTail(6) / 9.865876e-10, 1, 1e-6);
}

TEST(Statistics, ChiSquareTail) {
    // 95% and 99% points of the usual table.
    const double table[][3] = {
        {1, 3.841459, 6.634897}, {2, 5.991465, 9.210340}, {10, 18.307038, 23.209251}, {100, 124.342113, 135.806723}};
    for (const auto& [dof, five, one] : table) {
        EXPECT_NEAR(chiSquareTail(five, dof), 0.05, 1e-6) << dof;
        EXPECT_NEAR(chiSquareTail(one, dof), 0.01, 1e-6) << dof;
        EXPECT_EQ(chiSquareTail(0, dof), 1);
    }
    // Two degrees of freedom: exp(-x/2).
    for (double x = 0.1; x < 100; x *= 1.7) EXPECT_NEAR(chiSquareTail(x, 2) / std::exp(-x / 2), 1, 1e-12);
    EXPECT_NEAR(gammaQ(0.5, 0.8), std::erfc(std::sqrt(0.8)), 1e-12);
}

TEST(Statistics, SidakLevelHoldsTogether) {
    EXPECT_NEAR(sidakLevel(0.05, 1), 0.05, 1e-15);
    for (const int64_t count : {int64_t(10), int64_t(1000000)})
        EXPECT_NEAR(-std::expm1(static_cast<double>(count) * std::log1p(-sidakLevel(0.01, count))), 0.01, 1e-9);
}

TEST(Statistics, ChiSquareTestKnowsAFairDie) {
    // Statistic 5.0 / 5 dof for (22,24,17,20,15,22) of 120: sum (o-20)^2/20 = (4+16+9+0+25+4)/20 = 2.9.
    const std::vector<double> observed = {22, 24, 17, 20, 15, 22}, expected(6, 20);
    EXPECT_NEAR(chiSquareTest(observed, expected), chiSquareTail(2.9, 5), 1e-12);
    const std::vector<double> loaded = {40, 24, 17, 20, 5, 14};
    EXPECT_LT(chiSquareTest(loaded, expected), 1e-4);
}

TEST(Statistics, ChiSquareTestPoolsAndRefusesTheImpossible) {
    const std::vector<double> expected = {2, 2, 2, 50, 50}, observed = {1, 3, 2, 50, 50};
    EXPECT_NEAR(chiSquareTest(observed, expected), 1, 1e-12);
    EXPECT_EQ(chiSquareTest(std::vector<double>{1, 99}, std::vector<double>{0, 100}), 0);
    EXPECT_EQ(chiSquareTest(std::vector<double>{100}, std::vector<double>{100}), 1);
}

TEST(Statistics, PValuesOfTrueHypothesesAreUniform) {
    std::vector<double> deciles(10, 0.0);
    for (uint32_t trial = 0; trial < 2000; ++trial) {
        std::vector<double> cells(16, 0.0);
        for (uint32_t i = 0; i < 1600; ++i) cells[hashCombine(trial, i) % 16] += 1;
        const double p = chiSquareTest(cells, std::vector<double>(16, 100));
        deciles[static_cast<size_t>(std::min(9.0, p * 10))] += 1;
    }
    EXPECT_GT(chiSquareTest(deciles, std::vector<double>(10, 200)), 1e-3);
}

}  // namespace
}  // namespace lumi
