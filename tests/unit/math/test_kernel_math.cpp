#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "math/kernel_math.h"

namespace lumi {
namespace {

TEST(KernelMath, Exp2AndLog2AreWithinTheirStatedErrors) {
    double worst = 0;
    for (double x = -125.9; x < 126.9; x += 0.0137) {
        const auto exact = std::exp2(static_cast<double>(static_cast<float>(x)));
        worst = std::max(worst, std::abs(kernelExp2(static_cast<float>(x)) / exact - 1));
    }
    EXPECT_LT(worst, 3e-7);
    worst = 0;
    for (double x = 1e-37; x < 1e38; x *= 1.00731) {
        const double exact = std::log2(static_cast<double>(static_cast<float>(x)));
        worst = std::max(worst, std::abs(kernelLog2(static_cast<float>(x)) - exact) / std::max(1.0, std::abs(exact)));
    }
    EXPECT_LT(worst, 4e-7);
}

TEST(KernelMath, EdgesAreFinite) {
    const float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
    for (const float x : {nan, infinity, -infinity, 1e30f, -1e30f, 0.0f}) {
        EXPECT_TRUE(std::isfinite(kernelExp2(x))) << x;
        EXPECT_GT(kernelExp2(x), 0) << x;
    }
    for (const float x : {0.0f, -1.0f, nan, -infinity}) EXPECT_LT(kernelLog2(x), -125) << x;
    EXPECT_EQ(kernelLog2(1.0f), 0.0f);
    EXPECT_EQ(kernelExp2(0.0f), 1.0f);
    EXPECT_LT(kernelPow(0.0f, 2.0f), 1e-37f);
}

TEST(KernelMath, PowersOfTheRangesInUse) {
    double worst = 0;
    for (double x = 1e-4; x <= 1; x += 1e-4)
        for (const float y : {1 / 2.4f, 2.4f, 2.2f, 0.5f}) {
            const double exact = std::pow(static_cast<double>(static_cast<float>(x)), static_cast<double>(y));
            worst = std::max(worst, std::abs(kernelPow(static_cast<float>(x), y) / exact - 1));
        }
    EXPECT_LT(worst, 1e-5);
    EXPECT_NEAR(kernelExp(1.0f), 2.7182818f, 2e-6f);
}

}  // namespace
}  // namespace lumi
