// Every metric within a mask, and its map, against definitions written out; exposures that belong to the reference.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "measure/metrics.h"

namespace lumi {
namespace {

Image randomImage(Extent2 extent, uint32_t seed) {
    std::mt19937 generator(seed);
    std::uniform_real_distribution<float> uniform(0, 1.2f);
    Image image(extent, 3);
    for (size_t i = 0; i < image.size(); ++i) image.data()[i] = uniform(generator);
    return image;
}

/// The left half counts, and the images differ in the right one alone.
ImagePair pairThatDiffersWhereNothingCounts(Extent2 extent) {
    ImagePair pair{randomImage(extent, 1), randomImage(extent, 1), Image(extent, 1), 0};
    for (int y = 0; y < extent.height; ++y)
        for (int x = 0; x < extent.width; ++x) {
            if (x < extent.width / 2) pair.mask.at(0, x, y) = 1;
            else
                for (int c = 0; c < 3; ++c) pair.image.at(c, x, y) *= 0.2f;
        }
    pair.prepare();
    return pair;
}

TEST(Masks, WhatIsMaskedOutCountsAtMostWithinAWindow) {
    const ImagePair pair = pairThatDiffersWhereNothingCounts({400, 180});
    ImagePair whole{pair.image, pair.reference, {}, 0};
    whole.prepare();
    for (const Metric& metric : metricCatalog()) {
        const Measurement masked = metric.measure(pair, true), all = metric.measure(whole, false);
        const std::string id = metric.id;
        if (id == "cpbd") continue;  // of the image alone; below
        if (id == "psnr") {
            EXPECT_TRUE(std::isinf(masked.value));
            EXPECT_TRUE(std::isfinite(all.value));
        } else if (metric.higherIsBetter) {
            const double reach = id == "ms_ssim" ? 0.8 : 0.5;  // its coarse windows look far over the border
            EXPECT_GT(masked.value, 1 - reach * (1 - all.value)) << id;
        } else {
            EXPECT_LT(masked.value, 0.2 * all.value + 1e-12) << id;
        }
        ASSERT_EQ(masked.map.extent(), pair.image.extent()) << id;
        for (int y = 0; y < 180; y += 7)
            for (int x = 200; x < 400; x += 7) EXPECT_EQ(masked.map.at(0, x, y), 0) << id;
    }
}

TEST(Masks, MsSsimOfOneScaleIsTheMeanOfWindowsThatCount) {
    // 16 pixels a side: one scale fits, so that MS-SSIM is SSIM.
    ImagePair pair{randomImage({16, 16}, 3), randomImage({16, 16}, 3), Image({16, 16}, 1), 0};
    const Image noise = randomImage({16, 16}, 4);
    for (size_t i = 0; i < noise.size(); ++i)
        pair.image.data()[i] += 0.2f * noise.data()[i];  // alike: no value below 0
    for (int x = 0; x < 8; ++x)
        for (int y = 0; y < 16; ++y) pair.mask.at(0, x, y) = 1;
    pair.prepare();
    const Measurement one = measureSsim(pair, true), multi = measureMsSsim(pair, true);
    EXPECT_NEAR(one.value, multi.value, 1e-6);
    for (int y = 5; y < 11; ++y)
        for (int x = 5; x < 8; ++x) EXPECT_NEAR(multi.map.at(0, x, y), one.map.at(0, x, y), 1e-5);
}

TEST(Masks, NothingThatCountsIsNoValue) {
    ImagePair pair{randomImage({200, 180}, 3), randomImage({200, 180}, 4), Image({200, 180}, 1), 0};
    pair.prepare();
    EXPECT_TRUE(std::isnan(measureSsim(pair, false).value));
    EXPECT_TRUE(std::isnan(measureMsSsim(pair, false).value));
}

/// Ramps over `width` pixels between two levels `contrast` apart, edges at multiples of 32.
Image ramps(int width, float contrast = 200) {
    Image gray({128, 128}, 1);
    for (int y = 0; y < 128; ++y)
        for (int x = 0; x < 128; ++x) {
            const float t =
                std::clamp(static_cast<float>(x % 32 - 16 + width / 2) / static_cast<float>(width), 0.0f, 1.0f);
            gray.at(0, x, y) = 20 + contrast * (x / 32 % 2 ? 1 - t : t);
        }
    return gray;
}

TEST(Cpbd, AnEdgeIsBlurredByItsWidthAgainstWhatIsNoticed) {
    // A blur of 3 pixels is just noticeable, of 5 where contrast is at most 50: P = 1 - exp(-(w / 3)^3.6) is 1 - 1/e
    // there, the most that counts as sharp.
    for (const auto& [contrast, noticeable] : {std::pair(200.0f, 3), std::pair(48.0f, 5)})
        for (const int width : {2, 3, 4, 5, 6}) {
            const Image gray = ramps(width, contrast);
            Image map;
            const double value = cpbd(std::as_const(gray).plane(0), nullptr, &map);
            EXPECT_EQ(value, width <= noticeable ? 1 : 0) << width << " of " << noticeable;
            for (size_t i = 0; i < map.size(); ++i)
                if (map.data()[i] > 0) {
                    ASSERT_NEAR(map.data()[i], 1 - std::exp(-std::pow(width / double(noticeable), 3.6)), 1e-6);
                }
        }
}

TEST(Cpbd, EdgesOnASlantAndFaintOnesDoNotCount) {
    Image gray({96, 96}, 1);
    const auto edgesOf = [&](auto value) {
        for (int y = 0; y < 96; ++y)
            for (int x = 0; x < 96; ++x) gray.at(0, x, y) = value(x, y);
        int64_t edges = 0;
        cpbd(std::as_const(gray).plane(0), nullptr, nullptr, &edges);
        return edges;
    };
    EXPECT_GT(edgesOf([](int x, int) { return x < 48 ? 20.0f : 220.0f; }), 90);
    EXPECT_EQ(edgesOf([](int x, int y) { return x < y ? 20.0f : 220.0f; }), 0);  // 45 degrees
    EXPECT_EQ(edgesOf([](int, int y) { return y < 48 ? 20.0f : 220.0f; }), 0);
    // A step of 5 levels has a Sobel slope of 2.5 a pixel, one of 3 has 1.5.
    EXPECT_GT(edgesOf([](int x, int) { return x < 48 ? 20.0f : 25.0f; }), 90);
    EXPECT_EQ(edgesOf([](int x, int) { return x < 48 ? 20.0f : 23.0f; }), 0);
}

TEST(Cpbd, OnlyEdgesInTheMaskCount) {
    Image gray = ramps(2);
    const Image soft = ramps(10);
    for (int y = 0; y < 128; ++y)
        for (int x = 64; x < 128; ++x) gray.at(0, x, y) = soft.at(0, x, y);
    Image left({128, 128}, 1), right({128, 128}, 1);
    for (int y = 0; y < 128; ++y)
        for (int x = 0; x < 128; ++x) (x < 60 ? left : right).at(0, x, y) = x < 60 || x > 70 ? 1.0f : 0.0f;
    EXPECT_EQ(cpbd(std::as_const(gray).plane(0), &left), 1);
    EXPECT_EQ(cpbd(std::as_const(gray).plane(0), &right), 0);
}

TEST(HdrFlip, ExposuresBelongToTheReferenceWhateverTheImageHolds) {
    ImagePair clean{randomImage({32, 32}, 5), randomImage({32, 32}, 6), {}, 0};
    ImagePair broken = clean;
    for (int x = 0; x < 32; ++x)
        for (int y = 0; y < 12; ++y) broken.image.at(0, x, y) = std::nanf("");
    clean.prepare(), broken.prepare();
    EXPECT_EQ(broken.nonFinitePixels, 32 * 12);
    const Measurement a = measureHdrFlip(clean, false), b = measureHdrFlip(broken, false);
    for (size_t i = 0; i < 3; ++i) EXPECT_EQ(a.details[i], b.details[i]);
}

TEST(HdrFlip, AFixedRangeIsTaken) {
    ImagePair pair{randomImage({32, 32}, 5), randomImage({32, 32}, 6), {}, 0};
    pair.settings.flipExposures = FlipExposures{-2, 1, 4};
    pair.prepare();
    const Measurement four = measureHdrFlip(pair, false);
    EXPECT_EQ(four.details[0].second, -2);
    EXPECT_EQ(four.details[2].second, 4);
    pair.settings.flipExposures = FlipExposures{-2, -2, 1};
    EXPECT_LE(measureHdrFlip(pair, false).value, four.value) << "the maximum over fewer exposures";
}

}  // namespace
}  // namespace lumi
