#include "math/block_sum.h"

#include <gtest/gtest.h>

#include "math/hash.h"

namespace lumi {
namespace {

double value(uint64_t index) { return unitFloat(pcgHash(static_cast<uint32_t>(index))) * 1e3 + 1e-9; }

double sumOf(uint64_t first, uint64_t count) {
    BlockSum<double> sum;
    for (uint64_t i = first; i < first + count; ++i) sum.add(i, value(i));
    return sum.total();
}

TEST(BlockSum, AnySplitIntoAlignedBlocksGivesTheSameBits) {
    const double whole = sumOf(0, 256);
    for (const uint64_t part : {1, 2, 8, 16, 64, 128}) {
        BlockSum<double> sum;
        for (uint64_t first = 0; first < 256; first += part) sum.add(first, part, sumOf(first, part));
        EXPECT_EQ(sum.total(), whole) << part;
    }
}

TEST(BlockSum, IsTheSumForAnyRange) {
    for (const uint64_t first : {0, 3, 16, 37})
        for (const uint64_t count : {1, 2, 5, 31, 100}) {
            double plain = 0;
            for (uint64_t i = first; i < first + count; ++i) plain += value(i);
            EXPECT_NEAR(sumOf(first, count), plain, 1e-9 * plain);
        }
}

TEST(BlockSum, MixedSplitsOfAnUnalignedRangeAgree) {
    // 12 = [4, 8) + [8, 16) as blocks or one by one.
    BlockSum<double> blocks;
    blocks.add(4, 4, sumOf(4, 4));
    blocks.add(8, 8, sumOf(8, 8));
    EXPECT_EQ(blocks.total(), sumOf(4, 12));
}

}  // namespace
}  // namespace lumi
