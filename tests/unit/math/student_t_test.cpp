#include "math/student_t.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace lumi::test {
namespace {

/// Printed in every table of the distribution.
TEST(StudentT, QuantilesAreThoseOfTheTables) {
    EXPECT_NEAR(studentQuantile(0.025, 1), 12.7062, 1e-4);
    EXPECT_NEAR(studentQuantile(0.025, 2), 4.30265, 1e-5);
    EXPECT_NEAR(studentQuantile(0.025, 4), 2.77645, 1e-5);
    EXPECT_NEAR(studentQuantile(0.025, 10), 2.22814, 1e-5);
    EXPECT_NEAR(studentQuantile(0.025, 30), 2.04227, 1e-5);
    EXPECT_NEAR(studentQuantile(0.005, 9), 3.24984, 1e-5);
    EXPECT_NEAR(studentQuantile(0.05, 120), 1.65765, 1e-5);
    EXPECT_NEAR(studentQuantile(0.025, std::numeric_limits<double>::infinity()), 1.959964, 1e-6);
    EXPECT_NEAR(studentQuantile(0.5, 3), 0, 1e-12);
}

TEST(StudentT, TailsHaveTheirClosedForms) {
    for (const double t : {-3.0, -0.4, 0.0, 0.7, 2.5}) {
        // One degree of freedom is Cauchy's distribution; two have a root.
        EXPECT_NEAR(studentTail(t, 1), 0.5 - std::atan(t) / M_PI, 1e-12);
        EXPECT_NEAR(studentTail(t, 2), 0.5 - t / (2 * std::sqrt(2 + t * t)), 1e-12);
        EXPECT_NEAR(studentTail(t, 7) + studentTail(-t, 7), 1, 1e-12);
    }
    EXPECT_NEAR(studentTail(1.3, 1e7), 0.5 * std::erfc(1.3 / std::sqrt(2.0)), 1e-7);
}

TEST(StudentT, TheIncompleteBetaFunctionHasItsClosedForms) {
    for (const double x : {0.0, 0.1, 0.5, 0.8, 1.0}) {
        EXPECT_NEAR(incompleteBeta(1, 1, x), x, 1e-14);
        EXPECT_NEAR(incompleteBeta(3, 1, x), x * x * x, 1e-13);
        EXPECT_NEAR(incompleteBeta(2, 5, x) + incompleteBeta(5, 2, 1 - x), 1, 1e-13);
    }
    EXPECT_NEAR(incompleteBeta(0.5, 0.5, 0.25), 1.0 / 3, 1e-12);  // the arcsine distribution
}

}  // namespace
}  // namespace lumi::test
