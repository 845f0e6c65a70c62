// Each warp against its density: cells of the target hold what the density's integral over them says.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <vector>

#include "math/hash.h"
#include "math/sin_cos.h"
#include "math/statistics.h"
#include "math/warp.h"

namespace lumi {
namespace {

constexpr uint32_t kSamples = 400000;
constexpr double kLevel = 1e-4;

/// p-value that cells (each 0..count-1 of a sample) are equally likely.
double uniformity(uint32_t count, uint32_t seed, const std::function<double(Vec2)>& cellOf) {
    std::vector<double> observed(count, 0.0);
    for (uint32_t i = 0; i < kSamples; ++i) {
        const double cell = cellOf({unitFloat(hashCombine(seed, i, 0)), unitFloat(hashCombine(seed, i, 1))});
        EXPECT_GE(cell, 0);
        observed[static_cast<size_t>(std::min(cell, count - 1.0))] += 1;
    }
    return chiSquareTest(observed, std::vector<double>(count, double(kSamples) / count));
}

/// Cell of (u, v) in [0,1)^2 on a 20x20 grid.
double grid(double u, double v) { return std::min(19.0, std::floor(u * 20)) * 20 + std::min(19.0, std::floor(v * 20)); }
double turn(double y, double x) {
    const double angle = std::atan2(y, x) / (2 * M_PI);
    return angle < 0 ? angle + 1 : angle;
}

TEST(SinCosTurns, AgreesWithTheLibraryAllAround) {
    for (int i = -40000; i <= 40000; ++i) {
        const float turns = static_cast<float>(i) / 16384;
        const double angle = 2 * 3.14159265358979323846 * turns;
        const SinCos value = sinCosTurns(turns);
        ASSERT_NEAR(value.sine, std::sin(angle), 2e-7) << turns;
        ASSERT_NEAR(value.cosine, std::cos(angle), 2e-7) << turns;
    }
    EXPECT_EQ(sinCosTurns(0.25f).cosine, 0);
    EXPECT_EQ(sinCosTurns(0.5f).sine, 0);
}

TEST(Warp, DiskIsUniform) {
    EXPECT_GT(uniformity(400, 1,
                         [](Vec2 u) {
                             const Vec2 d = sampleDisk(u);
                             EXPECT_LE(glm::length(d), 1.00001f);
                             return grid(d.x * d.x + d.y * d.y, turn(d.y, d.x));
                         }),
              kLevel);
    EXPECT_EQ(sampleDisk({0.5f, 0.5f}), Vec2(0));
}

TEST(Warp, HemisphereIsCosineWeighted) {
    // The density cos/pi makes sin^2 of the angle uniform.
    EXPECT_GT(uniformity(400, 2,
                         [](Vec2 u) {
                             const Vec3 w = sampleCosineHemisphere(u);
                             EXPECT_GE(w.z, 0);
                             EXPECT_NEAR(glm::length(w), 1, 1e-5f);
                             return grid(1 - double(w.z) * w.z, turn(w.y, w.x));
                         }),
              kLevel);
    EXPECT_EQ(pdfCosineHemisphere(-0.1f), 0);
    EXPECT_FLOAT_EQ(pdfCosineHemisphere(1), kInvPi);
}

TEST(Warp, SphereIsUniform) {
    EXPECT_GT(uniformity(400, 3,
                         [](Vec2 u) {
                             const Vec3 w = sampleSphere(u);
                             EXPECT_NEAR(glm::length(w), 1, 1e-5f);
                             return grid(0.5 * (1 - w.z), turn(w.y, w.x));
                         }),
              kLevel);
    EXPECT_FLOAT_EQ(pdfSphere() * 4 * kPi, 1);
}

TEST(Warp, ConesAreUniformEvenWhenTheyAreNarrow) {
    for (const float angle : {60.0f, 0.25f, 0.01f}) {
        const double exact = 2 * std::pow(std::sin(angle * M_PI / 360), 2);
        const auto height = static_cast<float>(exact);
        EXPECT_GT(uniformity(400, 4,
                             [&](Vec2 u) {
                                 const Vec3 w = sampleCone(u, height);
                                 // sin^2 tells narrow angles apart where 1 - cos has no bits left: 1 - cos = s / (1 +
                                 // sqrt(1 - s)).
                                 const double s = double(w.x) * w.x + double(w.y) * w.y;
                                 const double h = s / (1 + std::sqrt(std::max(0.0, 1 - s)));
                                 EXPECT_LE(h, exact * 1.0001);
                                 return grid(h / exact * 0.99999, turn(w.y, w.x));
                             }),
                  kLevel)
            << angle;
        EXPECT_NEAR(pdfCone(height) * 2 * M_PI * exact, 1, 1e-5);
    }
}

TEST(Warp, TrianglesAreUniform) {
    // Barycentrics to a square: x = (1 - b1 - b2), fold: u = 1 - sqrt(1 - ...): the classical inverse.
    EXPECT_GT(uniformity(400, 5,
                         [](Vec2 u) {
                             const Vec2 b = sampleTriangle(u);
                             EXPECT_GE(b.x, 0);
                             EXPECT_GE(b.y, 0);
                             EXPECT_LE(b.x + b.y, 1.000001f);
                             const double rest = 1 - double(b.x);  // distribution of b1: 1 - (1 - b1)^2
                             return grid(1 - rest * rest, rest > 0 ? b.y / rest : 0);
                         }),
              kLevel);
}

TEST(Warp, TestsCanFail) {
    // A cosine hemisphere is not uniform in height.
    EXPECT_LT(uniformity(400, 6,
                         [](Vec2 u) {
                             const Vec3 w = sampleCosineHemisphere(u);
                             return grid(1 - w.z, turn(w.y, w.x));
                         }),
              kLevel);
}

TEST(Warp, LatLongKeepsItsConventions) {
    const auto expectDirection = [](Vec2 uv, const Vec3& wanted) {
        const Vec3 found = directionFromLatLong(uv);
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c], wanted[c], 1e-6f);
    };
    expectDirection({0.5f, 0.5f}, {0, 0, -1});
    expectDirection({0, 0.5f}, {0, 0, 1});
    expectDirection({0.75f, 0.5f}, {1, 0, 0});
    expectDirection({0.3f, 0}, {0, 1, 0});
    expectDirection({0.3f, 1}, {0, -1, 0});
    for (uint32_t i = 0; i < 5000; ++i) {
        const Vec2 uv(unitFloat(pcgHash(2 * i)), 0.01f + 0.98f * unitFloat(pcgHash(2 * i + 1)));
        const Vec2 back = latLongFromDirection(directionFromLatLong(uv));
        EXPECT_NEAR(back.x, uv.x, 1e-4f);
        EXPECT_NEAR(back.y, uv.y, 1e-4f);
        EXPECT_LT(back.x, 1);
    }
    EXPECT_LT(latLongFromDirection({-0.0f, 0, 1}).x, 1);
    EXPECT_LT(latLongFromDirection({0.0f, 0, 1}).x, 1);
}

}  // namespace
}  // namespace lumi
