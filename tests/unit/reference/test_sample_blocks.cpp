// Block sums against plain sums written here: whatever the split, the same bits; and what they say of the noise.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "math/block_sum.h"
#include "reference/sample_blocks.h"

namespace lumi {
namespace {

constexpr Extent2 kExtent{7, 5};

/// The leaf of number `index`: random sums, the same every time.
SampleBlock leaf(uint64_t index) {
    std::mt19937 generator(static_cast<uint32_t>(index) + 1);
    std::exponential_distribution<double> radiance(1);
    SampleBlock block = SampleBlock::shaped({index * kLeafSamples, (index + 1) * kLeafSamples}, kExtent);
    for (size_t i = 0; i < block.sum.size(); ++i) block.sum.data()[i] = kLeafSamples * radiance(generator);
    return block;
}

SampleBlocks blocksOf(uint64_t firstLeaf, uint64_t endLeaf) {
    SampleBlocks blocks;
    for (uint64_t i = firstLeaf; i < endLeaf; ++i) blocks.add(leaf(i));
    return blocks;
}

double luminanceSum(const SampleBlock& block, int64_t pixel) {
    const double* v = block.sum.data();
    const int64_t n = kExtent.area();
    return 0.2126 * v[pixel] + 0.7152 * v[n + pixel] + 0.0722 * v[2 * n + pixel];
}

void expectSame(const SampleBlocks& a, const SampleBlocks& b) {
    ASSERT_EQ(a.blocks().size(), b.blocks().size());
    for (size_t i = 0; i < a.blocks().size(); ++i) {
        EXPECT_EQ(a.blocks()[i].first, b.blocks()[i].first);
        EXPECT_EQ(a.blocks()[i].count, b.blocks()[i].count);
        EXPECT_EQ(a.blocks()[i].sum, b.blocks()[i].sum);
        EXPECT_EQ(a.blocks()[i].left, b.blocks()[i].left);
        EXPECT_EQ(a.blocks()[i].scatter, b.blocks()[i].scatter);
    }
}

TEST(SampleBlocks, TheMeanIsThatOfAlignedPairwiseSums) {
    for (const uint64_t leaves : {1, 2, 3, 7, 16, 37}) {
        const Image mean = blocksOf(0, leaves).mean({}, 0);
        for (const size_t i : {size_t(0), size_t(33), mean.size() - 1}) {
            BlockSum<double> expected;
            for (uint64_t k = 0; k < leaves; ++k) expected.add(k, leaf(k).sum.data()[i]);
            EXPECT_EQ(mean.data()[i],
                      static_cast<float>(expected.total() * (1.0 / static_cast<double>(leaves * kLeafSamples))));
        }
    }
}

TEST(SampleBlocks, ATailIsAddedFirst) {
    const SampleBlocks blocks = blocksOf(0, 3);
    ImageOf<double> tail(kExtent, 3);
    tail.fill(0.3);
    const Image mean = blocks.mean(tail, 5);
    const double sum = (leaf(0).sum.data()[4] + leaf(1).sum.data()[4]) + (leaf(2).sum.data()[4] + 0.3);
    EXPECT_EQ(mean.data()[4], static_cast<float>(sum * (1.0 / 53)));
    EXPECT_EQ(SampleBlocks().mean(tail, 2).data()[0], 0.15f);
}

TEST(SampleBlocks, AnySplitGivesTheSameBits) {
    const SampleBlocks whole = blocksOf(0, 45);
    for (const auto& cuts : {std::vector<uint64_t>{13}, {1, 2, 3}, {16, 32}, {5, 6, 31, 44}}) {
        SampleBlocks merged;
        uint64_t begin = 0;
        for (size_t i = 0; i <= cuts.size(); ++i) {
            const uint64_t end = i < cuts.size() ? cuts[i] : 45;
            const SampleBlocks part = blocksOf(begin, end);
            for (const SampleBlock& block : part.blocks()) merged.add(block);
            begin = end;
        }
        expectSame(whole, merged);
    }
}

TEST(SampleBlocks, HalvesHoldEverySampleOnce) {
    const SampleBlocks blocks = blocksOf(0, 12);  // blocks of 8 and 4 leaves
    const Image first = blocks.half(false), second = blocks.half(true), mean = blocks.mean({}, 0);
    double expected = 0;
    for (const uint64_t k : {0, 1, 2, 3, 8, 9}) expected += leaf(k).sum.data()[11];
    EXPECT_NEAR(first.data()[11], expected / (6 * kLeafSamples), 1e-6);
    for (size_t i = 0; i < mean.size(); ++i)
        EXPECT_NEAR((first.data()[i] + second.data()[i]) / 2, mean.data()[i], 1e-6);
    EXPECT_TRUE(blocksOf(0, 1).half(false).empty());
}

TEST(SampleBlocks, TheStandardErrorIsThatOfEqualParts) {
    for (const uint64_t leaves : {16, 23, 32, 50, 64}) {
        const uint64_t samples = leaves * kLeafSamples;
        const uint64_t leavesOfPart = leaves >= 64 ? 4 : leaves >= 32 ? 2 : 1, parts = leaves / leavesOfPart;
        const Image error = blocksOf(0, leaves).standardError(samples);
        for (const int64_t pixel : {0, 17}) {
            std::vector<double> sums(parts, 0.0);
            for (uint64_t k = 0; k < parts * leavesOfPart; ++k) sums[k / leavesOfPart] += luminanceSum(leaf(k), pixel);
            double mean = 0, squares = 0;
            for (const double sum : sums) mean += sum / static_cast<double>(parts);
            for (const double sum : sums) squares += (sum - mean) * (sum - mean);
            const double ofParts = std::sqrt(squares / static_cast<double>(parts - 1) / static_cast<double>(parts)) /
                                   static_cast<double>(leavesOfPart * kLeafSamples);
            const double all =
                ofParts * std::sqrt(static_cast<double>(parts * leavesOfPart) / static_cast<double>(leaves));
            EXPECT_NEAR(error.data()[pixel], all, 1e-5 * all) << leaves;
        }
    }
    EXPECT_TRUE(blocksOf(0, 15).standardError(240).empty());
}

TEST(SampleBlocks, TheStandardErrorOfIndependentLeavesIsTheirOwn) {
    // Sums of exponentials with mean 1 a leaf of 16 each: luminance has variance (0.2126^2 + 0.7152^2 + 0.0722^2).
    const Image error = blocksOf(0, 512).standardError(512 * kLeafSamples);
    double squares = 0;
    for (size_t i = 0; i < error.size(); ++i)
        squares += error.data()[i] * error.data()[i] / static_cast<double>(error.size());
    const double expected = (0.2126 * 0.2126 + 0.7152 * 0.7152 + 0.0722 * 0.0722) / 512;
    EXPECT_NEAR(squares / expected, 1, 0.3);  // 35 pixels with 15 degrees of freedom: 0.06 standard deviation
    const Image mean = blocksOf(0, 512).mean({}, 0);
    EXPECT_NEAR(relativeError(mean, error), std::sqrt(expected / (1 + 0.001)), 0.2 * std::sqrt(expected));
    EXPECT_TRUE(std::isnan(relativeError(mean, Image())));
}

TEST(SampleBlocks, AlignedBlocksAreAsLargeAsTheirPlaceAllows) {
    EXPECT_EQ(alignedBlock(0, 4096), (SampleRange{0, 4096}));
    EXPECT_EQ(alignedBlock(0, 4000), (SampleRange{0, 2048}));
    EXPECT_EQ(alignedBlock(48, 4096), (SampleRange{48, 64}));
    EXPECT_EQ(alignedBlock(64, 4096), (SampleRange{64, 128}));
    EXPECT_EQ(alignedBlock(0, 4096, 64), (SampleRange{0, 64}));
}

}  // namespace
}  // namespace lumi
