#include "study/intervals.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "math/hash.h"

namespace lumi::test {
namespace {

/// Uniform in [0,1), of a fixed stream.
double uniform(uint64_t index) { return static_cast<double>(mixBits(index) >> 11) * 0x1p-53; }

/// A normal deviate from twelve uniform ones would have short tails; the polar form has none of that.
double normal(uint64_t index) {
    return std::sqrt(-2 * std::log(1 - uniform(2 * index))) * std::cos(2 * M_PI * uniform(2 * index + 1));
}

TEST(Intervals, AreStudentsOwn) {
    // Mean 5, deviations -2 -1 0 1 2: s^2 = 2.5, standard error sqrt(0.5), t(0.025, 4) = 2.77645.
    const std::vector<double> values{3, 4, 5, 6, 7};
    const Interval interval = meanInterval(values, 0.95);
    EXPECT_DOUBLE_EQ(interval.mean, 5);
    EXPECT_NEAR(interval.standardError, std::sqrt(0.5), 1e-12);
    EXPECT_NEAR(interval.high - 5, 2.77645 * std::sqrt(0.5), 1e-5);
    EXPECT_NEAR(5 - interval.low, 2.77645 * std::sqrt(0.5), 1e-5);
    EXPECT_TRUE(interval.excludesZero());
}

TEST(Intervals, OneValueSaysNothingOfItsNoise) {
    const Interval one = meanInterval(std::vector<double>{3}, 0.95);
    EXPECT_EQ(one.mean, 3);
    EXPECT_FALSE(one.known());
    EXPECT_TRUE(std::isnan(one.low));
    EXPECT_FALSE(one.excludesZero());
    EXPECT_TRUE(std::isnan(meanInterval({}, 0.95).mean));
}

/// Nineteen of twenty intervals hold the true mean, by either method.
TEST(Intervals, HoldTheTrueMeanAsOftenAsTheySay) {
    constexpr int trials = 1000, size = 12;
    for (const IntervalMethod method : {IntervalMethod::StudentT, IntervalMethod::Bootstrap}) {
        int held = 0;
        for (int t = 0; t < trials; ++t) {
            std::vector<double> values(size);
            for (int i = 0; i < size; ++i)
                values[static_cast<size_t>(i)] = 2 + normal(static_cast<uint64_t>(t * size + i));
            const Interval interval = meanInterval(values, 0.95, method);
            held += interval.low <= 2 && 2 <= interval.high;
        }
        // Twelve values are few for a bootstrap, which comes out a little short.
        EXPECT_NEAR(held / double(trials), method == IntervalMethod::StudentT ? 0.95 : 0.92, 0.025);
    }
}

/// Of two to five units every resample has the sign that all of them happen to have: noise must not be ranked by that.
TEST(Intervals, ResamplesOfAFewUnitsRankNoNoise) {
    constexpr int trials = 400;
    for (int size = 2; size <= 5; ++size) {
        int ranked = 0;
        for (int t = 0; t < trials; ++t) {
            std::vector<std::vector<double>> values(2, std::vector<double>(static_cast<size_t>(size)));
            for (int i = 0; i < 2 * size; ++i)
                values[static_cast<size_t>(i & 1)][static_cast<size_t>(i / 2)] =
                    normal(static_cast<uint64_t>((size * trials + t) * 16 + i));
            ranked += rankMethods(values, false, 0.95, IntervalMethod::Bootstrap)[0].certain();
        }
        EXPECT_LE(ranked / double(trials), 0.08) << size << " units";
    }
    EXPECT_TRUE(
        meanInterval(std::vector<double>{1, 1.1, 0.9, 1, 1.2, 0.8}, 0.95, IntervalMethod::Bootstrap).excludesZero());
}

TEST(Intervals, PairsRemoveWhatBothShare) {
    // Differences 1, 1, 1.2: clearly above 0, though the values themselves spread over ten.
    const std::vector<double> a{11, 1, 6.2}, b{10, 0, 5};
    EXPECT_TRUE(pairedInterval(a, b, 0.95).excludesZero());
    EXPECT_FALSE(pairedInterval(a, std::vector<double>{0, 10, 5}, 0.95).excludesZero());
}

/// A value that is missing takes its pair with it, and nothing else: the pairs that are left belong together.
TEST(Intervals, MissingValuesDoNotBreakPairs) {
    const double missing = std::nan("");
    const std::vector<double> a{11, missing, 1, 6, INFINITY}, b{10, 3, 0, missing, 2};
    const Interval difference = pairedInterval(a, b, 0.95);
    EXPECT_EQ(difference.count, 2);
    EXPECT_DOUBLE_EQ(difference.mean, 1);
    EXPECT_EQ(meanInterval(a, 0.95).count, 3);
    EXPECT_DOUBLE_EQ(meanInterval(a, 0.95).mean, 6);
    EXPECT_EQ(meanInterval(std::vector<double>{missing}, 0.95).count, 0);
    // The second method has a value in one unit only: nothing tells it from the others.
    const std::vector<Rank> ranks = rankMethods({{1, 1.1, 0.9}, {missing, missing, 5}, {3, 3.1, 2.9}}, false, 0.95);
    EXPECT_EQ(ranks[0].best, 1);
    EXPECT_EQ(ranks[0].worst, 2);
    EXPECT_EQ(ranks[1].best, 1);
    EXPECT_EQ(ranks[1].worst, 3);
}

/// Of the mean the jackknife is the mean's own interval.
TEST(Intervals, TheJackknifeOfAMeanIsItsInterval) {
    const std::vector<double> values{3, 4, 5, 6, 9};
    std::vector<double> without;
    for (const double left : values) without.push_back((27 - left) / 4);
    const Interval jackknife = meanInterval(pseudoValues(27.0 / 5, without), 0.95), plain = meanInterval(values, 0.95);
    EXPECT_NEAR(jackknife.mean, plain.mean, 1e-12);
    EXPECT_NEAR(jackknife.low, plain.low, 1e-12);
    EXPECT_TRUE(pseudoValues(1, std::vector<double>{1, 2}).empty()) << "two units are too few";
}

TEST(Ranks, AreGivenOnlyWhereTheNoiseAllows) {
    // Two that nobody can tell apart, and one far behind.
    const std::vector<std::vector<double>> errors{{1.0, 1.2, 0.9, 1.1}, {1.1, 1.0, 1.1, 0.9}, {5.0, 5.2, 4.9, 5.1}};
    const std::vector<Rank> ranks = rankMethods(errors, false, 0.95);
    EXPECT_EQ(ranks[0].best, 1);
    EXPECT_EQ(ranks[0].worst, 2);
    EXPECT_EQ(ranks[1].best, 1);
    EXPECT_EQ(ranks[1].worst, 2);
    EXPECT_EQ(ranks[2].best, 3);
    EXPECT_TRUE(ranks[2].certain());
    // Where higher is better the order turns round.
    EXPECT_EQ(rankMethods(errors, true, 0.95)[2].best, 1);
    EXPECT_TRUE(rankMethods(errors, true, 0.95)[2].certain());
}

TEST(Ranks, OfOneSeedOrOfEqualImagesAreNone) {
    for (const auto& values : {std::vector<std::vector<double>>{{1}, {2}}, {{1, 2, 3}, {1, 2, 3}}})
        for (const Rank& rank : rankMethods(values, false, 0.95)) {
            EXPECT_EQ(rank.best, 1);
            EXPECT_EQ(rank.worst, 2);
        }
}

/// Of equal methods fewer than one table in twenty may show a difference, however many methods there are.
TEST(Ranks, AllPairsTogetherKeepTheLevel) {
    constexpr int tables = 400, methods = 5, seeds = 6;
    int wrong = 0;
    for (int t = 0; t < tables; ++t) {
        std::vector<std::vector<double>> values(methods, std::vector<double>(seeds));
        uint64_t index = static_cast<uint64_t>(t) * methods * seeds;
        for (auto& method : values)
            for (double& value : method) value = normal(++index);
        bool any = false;
        for (const Rank& rank : rankMethods(values, false, 0.95)) any |= rank.best != 1 || rank.worst != methods;
        wrong += any;
    }
    EXPECT_LE(wrong / double(tables), 0.07);
    EXPECT_GT(wrong, 0) << "a test that never fires tells nothing";
}

/// Pixels with a known offset and known noise, a reference with noise of its own.
TEST(BiasAndVariance, ComeApart) {
    constexpr size_t pixels = 20000, seeds = 4;
    constexpr double bias = 0.3, sigma = 0.5, referenceSigma = 0.2;
    std::vector<double> squared(seeds, 0.0);
    double squaredMean = 0;
    for (size_t p = 0; p < pixels; ++p) {
        const double reference = referenceSigma * normal(p);
        double sum = 0;
        for (size_t k = 0; k < seeds; ++k) {
            const double error = bias + sigma * normal((k + 1) * pixels + p) - reference;
            squared[k] += error * error / pixels;
            sum += error;
        }
        squaredMean += sum * sum / (seeds * seeds) / pixels;
    }
    const BiasVariance parts = separateBias(squared, squaredMean, referenceSigma * referenceSigma);
    EXPECT_NEAR(parts.squaredBias, bias * bias, 0.006);
    EXPECT_NEAR(parts.variance, sigma * sigma, 0.006);
    EXPECT_NEAR(parts.meanSquaredError, bias * bias + sigma * sigma, 0.01);
    EXPECT_TRUE(std::isnan(separateBias(std::vector<double>{1}, 1, 0).variance)) << "one seed cannot tell";
}

TEST(Slopes, AreThoseOfPowers) {
    const std::vector<double> n{1, 4, 16, 64};
    std::vector<double> error;
    for (const double x : n) error.push_back(3 / std::sqrt(x));
    EXPECT_NEAR(logLogSlope(n, error), -0.5, 1e-12);
    EXPECT_TRUE(std::isnan(logLogSlope(n, std::vector<double>{1, 1, 0, 1})));
    EXPECT_TRUE(std::isnan(logLogSlope(std::vector<double>{2, 2}, std::vector<double>{1, 3})));
    EXPECT_NEAR(logLogAt(n, error, 8), 3 / std::sqrt(8.0), 1e-12);
    EXPECT_EQ(logLogAt(n, error, 4), error[1]);
    EXPECT_TRUE(std::isnan(logLogAt(n, error, 65)));
}

/// One wiggle in a curve leaves the rest of it in range: what counts is the last crossing.
TEST(Slopes, ACurveThatTurnsBackIsReadFromItsEnd) {
    const std::vector<double> spp{1, 2, 4, 8, 16}, error{0.1914, 0.1347, 0.14, 0.09, 0.095};
    EXPECT_NEAR(logLogAt(error, spp, 0.1909, Course::Falling), 1.005, 0.001);
    const double crossed = logLogAt(error, spp, 0.137, Course::Falling);
    EXPECT_TRUE(4 < crossed && crossed < 8) << "reached at 2 spp, lost again, and reached for good after 4";
    EXPECT_TRUE(std::isnan(logLogAt(error, spp, 0.2, Course::Falling)) &&
                std::isnan(logLogAt(error, spp, 0.05, Course::Falling)));
}

}  // namespace
}  // namespace lumi::test
