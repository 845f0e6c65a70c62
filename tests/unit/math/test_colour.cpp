#include <gtest/gtest.h>

#include <set>

#include "math/colour.h"
#include "math/hash.h"

namespace lumi {
namespace {

TEST(Colour, SrgbRoundTripAndKnownPoints) {
    for (float x = -2; x < 4; x += 0.01f) EXPECT_NEAR(linearFromSrgb(srgbFromLinear(x)), x, 2e-6f * (1 + std::abs(x)));
    EXPECT_NEAR(srgbFromLinear(0.2140411f), 0.5f, 1e-6f);
    EXPECT_EQ(srgbFromLinear(0.0f), 0.0f);
    EXPECT_NEAR(srgbFromLinear(1.0f), 1.0f, 1e-6f);
    EXPECT_EQ(srgbFromLinear(-0.3f), -srgbFromLinear(0.3f));
    // The two branches meet.
    EXPECT_NEAR(srgbFromLinear(0.0031308f), srgbFromLinear(0.0031309f), 2e-6f);
    for (int i = 0; i < 256; ++i) EXPECT_EQ(static_cast<int>(srgbFromLinear(linearFromSrgbTable()[i]) * 255 + 0.5f), i);
}

TEST(Colour, LuminanceWeightsSumToOne) {
    EXPECT_NEAR(luminance(Vec3(1)), 1.0f, 1e-6f);
    EXPECT_EQ(average(Vec3(1, 2, 3)), 2.0f);
}

TEST(Hash, UnitFloatsStayBelowOne) {
    EXPECT_LT(unitFloat(0xffffffffu), 1.0f);
    EXPECT_EQ(unitFloat(0), 0.0f);
    EXPECT_EQ(unitFloat(0x80000000u), 0.5f);
}

TEST(Hash, IsAPermutationAndMixes) {
    std::set<uint32_t> seen;
    double sum = 0;
    for (uint32_t i = 0; i < 20000; ++i) {
        seen.insert(pcgHash(i));
        sum += unitFloat(pcgHash(i));
    }
    EXPECT_EQ(seen.size(), 20000u);
    EXPECT_NEAR(sum / 20000, 0.5, 0.01);
    // One input bit changes about half of the output bits.
    int flipped = 0;
    for (uint32_t i = 0; i < 1000; ++i) flipped += __builtin_popcountll(mixBits(i) ^ mixBits(i ^ (1ull << (i % 64))));
    EXPECT_NEAR(flipped / 1000.0, 32, 1);
    EXPECT_NE(hashCombine(1, 2), hashCombine(2, 1));
    EXPECT_NE(hashCombine(1, 2, 3), hashCombine(1, 3, 2));
}

}  // namespace
}  // namespace lumi
