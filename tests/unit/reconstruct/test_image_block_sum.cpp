#include "reconstruct/accumulate/image_block_sum.h"

#include <gtest/gtest.h>

#include <cmath>

#include "math/block_sum.h"
#include "math/hash.h"

namespace lumi {
namespace {

/// Values whose sums round differently in nearly every order: 60 binary orders of magnitude apart.
double wildValue(uint64_t index) {
    const uint32_t bits = hashCombine(static_cast<uint32_t>(index), 3);
    return std::ldexp(1 + static_cast<double>(unitFloat(bits)), static_cast<int>(bits % 61) - 30);
}

ImageOf<double> pixel(double value) {
    ImageOf<double> image({1, 1}, 1);
    image.fill(value);
    return image;
}

/// The total of [0, count) added in steps of `step` (which divides count), each itself a sum over the aligned tree.
float totalInSteps(uint64_t count, uint64_t step) {
    ImageBlockSum sum;
    Image out({1, 1}, 1);
    for (uint64_t first = 0; first < count; first += step) {
        BlockSum<double> samples;
        for (uint64_t i = first; i < first + step; ++i) samples.add(i, wildValue(i));
        ImageOf<double> last = pixel(samples.total());
        if (first + step == count) sum.scaledTotal(last, 1, out);
        sum.add(first / step, 1, std::move(last));
    }
    return out.at(0, 0, 0);
}

TEST(ImageBlockSum, AnyAlignedSplitGivesTheSameBits) {
    for (const uint64_t count : {8u, 64u, 96u, 1024u}) {
        const float once = totalInSteps(count, count);
        for (uint64_t step = 1; step < count && count % step == 0; step *= 2)
            EXPECT_EQ(totalInSteps(count, step), once) << count << '/' << step;
    }
}

TEST(ImageBlockSum, OneStepOfAnySizeEqualsSingleSteps) {
    for (uint64_t count = 1; count <= 70; ++count)
        EXPECT_EQ(totalInSteps(count, count), totalInSteps(count, 1)) << count;
}

TEST(ImageBlockSum, KeepsOneImageForEachSetBit) {
    ImageBlockSum sum;
    for (uint64_t i = 0; i < 0b1011; ++i) sum.add(i, 1, pixel(1));
    EXPECT_EQ(sum.bytes(), 3 * sizeof(double));
    Image out({1, 1}, 1);
    sum.scaledTotal(pixel(1), 1.0 / 12, out);
    EXPECT_EQ(out.at(0, 0, 0), 1);
}

TEST(ImageBlockSum, AnUnalignedStartAddsUpToo) {
    ImageBlockSum sum;
    Image out({1, 1}, 1);
    for (uint64_t i = 5; i < 40; ++i) {
        sum.scaledTotal(pixel(1), 1, out);
        EXPECT_EQ(out.at(0, 0, 0), static_cast<float>(i - 4));
        sum.add(i, 1, pixel(1));
    }
    EXPECT_LE(sum.bytes(), 10 * sizeof(double));
}

}  // namespace
}  // namespace lumi
