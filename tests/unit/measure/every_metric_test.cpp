// What must hold for every metric of the catalogue, row by row: its plain definition, identity, symmetry, masks, broken
// pixels, maps, sizes.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "base/error.h"
#include "math/colour.h"
#include "measure/metrics.h"
#include "plain_definitions.h"

namespace lumi {
namespace {

/// How the number follows from the map: its mean over the pixels that count, their root mean square, minus the decibels
/// of its mean, one minus its mean over the centres of windows, the share of edges (where it is above 0) that round to
/// 63 percent at most. That of MS-SSIM does not: a product of means is no mean of products.
enum class Map { Mean, RootOfMeanSquare, Decibels, Windows, Edges, PixelsAlone };

struct Row {
    const char* id;
    plain::Result (*definition)(const ImagePair&);
    double tolerance;    ///< of the value
    double ofIdentical;  ///< exactly; NaN: as the reference has it
    bool symmetric, higherIsBetter;
    double low, high;  ///< no value is outside
    Map map;
    double ofPixels;  ///< tolerance of a map's pixel
    Extent2 extent{37, 29};
};

constexpr double kInf = std::numeric_limits<double>::infinity();
const Row kRows[] = {
    {"rmse", plain::rmse, 1e-6, 0, true, false, 0, 1, Map::RootOfMeanSquare, 3e-5},
    {"relmse", plain::relmse, 2e-5, 0, false, false, 0, kInf, Map::Mean, 6e-4},
    {"mse", plain::mse, 1e-6, 0, true, false, 0, kInf, Map::Mean, 3e-5},
    {"mae", plain::mae, 1e-6, 0, true, false, 0, kInf, Map::Mean, 3e-5},
    {"psnr", plain::psnr, 1e-4, kInf, true, true, 0, kInf, Map::Decibels, 3e-5},
    {"smape", plain::smape, 1e-6, 0, true, false, 0, 2, Map::Mean, 3e-5},
    {"ssim", plain::ssim, 1e-5, 1, true, true, -1, 1, Map::Windows, 3e-4},
    {"ms_ssim", plain::msSsim, 1e-4, 1, true, true, 0, 1, Map::PixelsAlone, 1e-3, {178, 177}},
    {"flip", plain::flip, 2e-5, 0, true, false, 0, 1, Map::Mean, 6e-4},
    {"hdr_flip", plain::hdrFlip, 2e-5, 0, false, false, 0, 1, Map::Mean, 6e-4},
    {"cpbd", plain::cpbd, 1e-9, std::nan(""), false, true, 0, 1, Map::Edges, 1e-6, {150, 97}},
};

/// Smooth shapes with noise, brighter than a screen in places.
Image picture(Extent2 extent, uint32_t seed, float noise) {
    std::mt19937 generator(seed);
    std::uniform_real_distribution<float> uniform(-1, 1);
    Image image(extent, 3);
    for (int c = 0; c < 3; ++c)
        for (int y = 0; y < extent.height; ++y)
            for (int x = 0; x < extent.width; ++x) {
                const float wave = 0.5f + 0.4f * std::sin(0.21f * static_cast<float>(x + 2 * c)) *
                                              std::cos(0.17f * static_cast<float>(y));
                const float edge = (x / 13 + y / 11) % 2 ? 1.6f : 0.5f;
                image.at(c, x, y) = std::max(0.001f, wave * edge + noise * uniform(generator));
            }
    return image;
}

ImagePair pairFor(const Row& row) { return {picture(row.extent, 2, 0.15f), picture(row.extent, 1, 0.01f), {}, -0.4f}; }

Image maskFor(Extent2 extent) {
    Image mask(extent, 1);
    for (int y = 0; y < extent.height; ++y)
        for (int x = 0; x < extent.width; ++x)
            mask.at(0, x, y) = x > extent.width / 3 && (x + y) % 5 != 0 ? 1.0f : 0.5f;
    return mask;
}

class EveryMetric : public testing::TestWithParam<Row> {
protected:
    const Row& row = GetParam();
    const Metric& metric = findMetric(row.id);
    void expectDefinition(const ImagePair& pair) const {
        const Measurement seen = metric.measure(pair, true);
        const plain::Result defined = row.definition(pair);
        EXPECT_NEAR(seen.value, defined.value, row.tolerance);
        EXPECT_TRUE(seen.reason.empty()) << seen.reason;
        EXPECT_GE(seen.value, row.low);
        EXPECT_LE(seen.value, row.high);
        ASSERT_EQ(seen.map.extent(), row.extent);
        ASSERT_EQ(defined.map.width, row.extent.width);
        ASSERT_EQ(defined.map.height, row.extent.height);
        double worst = 0;
        for (int y = 0; y < defined.map.height; ++y)
            for (int x = 0; x < defined.map.width; ++x)
                worst = std::max(worst, std::abs(defined.map.at(x, y) - static_cast<double>(seen.map.at(0, x, y))));
        EXPECT_LT(worst, row.ofPixels) << "a pixel of the map";
    }
};

TEST_P(EveryMetric, EqualsItsDefinition) {
    ImagePair pair = pairFor(row);
    pair.prepare();
    expectDefinition(pair);
    EXPECT_EQ(metric.measure(pair, false).value, metric.measure(pair, true).value) << "whether or not a map is wanted";
}

TEST_P(EveryMetric, EqualsItsDefinitionInAMask) {
    ImagePair pair = pairFor(row);
    pair.prepare();
    const double whole = metric.measure(pair, false).value;
    pair.mask = maskFor(row.extent);
    pair.prepare();
    expectDefinition(pair);
    const Measurement masked = metric.measure(pair, true);
    EXPECT_NE(masked.value, whole);
    for (int y = 0; y < row.extent.height; ++y)
        for (int x = 0; x < row.extent.width; ++x)
            ASSERT_TRUE(pair.counts(x, y) || masked.map.at(0, x, y) == 0) << x << ' ' << y;
}

TEST_P(EveryMetric, IdenticalImagesGiveTheExactValue) {
    for (const bool masked : {false, true}) {
        ImagePair pair = pairFor(row);
        pair.image = pair.reference;
        if (masked) pair.mask = maskFor(row.extent);
        pair.prepare();
        const Measurement seen = metric.measure(pair, true);
        EXPECT_EQ(seen.value, std::isnan(row.ofIdentical) ? seen.details.back().second : row.ofIdentical);
        EXPECT_EQ(seen.reason.empty(), std::isfinite(seen.value));
        if (std::isnan(row.ofIdentical)) continue;
        for (size_t i = 0; i < seen.map.size(); ++i) ASSERT_EQ(seen.map.data()[i], 0);
    }
}

TEST_P(EveryMetric, IsAsSymmetricAsDeclared) {
    ImagePair pair = pairFor(row);
    ImagePair swapped{pair.reference, pair.image, {}, pair.exposureEv};
    pair.prepare(), swapped.prepare();
    EXPECT_EQ(metric.symmetric, row.symmetric);
    EXPECT_EQ(metric.higherIsBetter, row.higherIsBetter);
    const double there = metric.measure(pair, false).value, back = metric.measure(swapped, false).value;
    EXPECT_EQ(there == back, row.symmetric) << there << ' ' << back;
}

TEST_P(EveryMetric, BrokenPixelsAreCountedAndCountForNothing) {
    const float nan = std::nanf(""), infinite = static_cast<float>(kInf);
    ImagePair broken = pairFor(row), without = pairFor(row);
    without.mask = Image(row.extent, 1);
    without.mask.fill(1);
    const struct {
        int x, y;
        float value;
        bool inReference;
    } places[] = {{3, 4, nan, false},
                  {20, 9, infinite, false},
                  {11, 20, -infinite, false},
                  {8, 13, nan, true},
                  {25, 25, infinite, true}};
    for (const auto& place : places) {
        (place.inReference ? broken.reference : broken.image).at(place.x % 3, place.x, place.y) = place.value;
        without.mask.at(0, place.x, place.y) = 0;
        for (int c = 0; c < 3; ++c) {
            if (place.inReference) without.reference.at(c, place.x, place.y) = 0;
            without.image.at(c, place.x, place.y) = without.reference.at(c, place.x, place.y);
        }
    }
    broken.prepare(), without.prepare();
    EXPECT_EQ(broken.nonFiniteImage, 3);
    EXPECT_EQ(broken.nonFiniteReference, 2);
    EXPECT_EQ(broken.nonFinitePixels, 5);
    EXPECT_EQ(broken.countedPixels, row.extent.area() - 5);
    const Measurement seen = metric.measure(broken, true);
    EXPECT_TRUE(std::isfinite(seen.value));
    EXPECT_EQ(seen.value, metric.measure(without, false).value);
    EXPECT_NEAR(seen.value, row.definition(without).value, row.tolerance);
    for (const auto& place : places) EXPECT_EQ(seen.map.at(0, place.x, place.y), 0);
    for (size_t i = 0; i < seen.map.size(); ++i) ASSERT_TRUE(std::isfinite(seen.map.data()[i]));
}

TEST_P(EveryMetric, NothingThatCountsIsNoValueAndSaysWhy) {
    const auto expectNone = [&](ImagePair pair, const std::string& reason) {
        pair.prepare();
        for (const bool map : {false, true}) {
            const Measurement seen = metric.measure(pair, map);
            EXPECT_TRUE(std::isnan(seen.value)) << reason << ": " << seen.value;
            EXPECT_EQ(seen.reason, reason);
        }
    };
    ImagePair pair = pairFor(row);
    pair.mask = Image(row.extent, 1);
    expectNone(pair, "the mask leaves no pixel");
    pair.mask = {};
    Image none(row.extent, 3);
    none.fill(std::nanf(""));
    expectNone({none, pair.reference, {}, 0}, "no pixel of the image is finite");
    expectNone({pair.image, none, {}, 0}, "no pixel of the reference is finite");
    pair.mask = Image(row.extent, 1);
    pair.mask.at(0, 9, 9) = 1;
    pair.image.at(2, 9, 9) = std::nanf("");
    expectNone(pair, "no pixel in the mask is finite in both images");
}

TEST_P(EveryMetric, OtherSizesAreRefused) {
    ImagePair pair = pairFor(row);
    pair.reference = picture({row.extent.width, row.extent.height + 1}, 1, 0);
    EXPECT_THROW(pair.prepare("a.exr"), Error);
    pair = pairFor(row);
    pair.mask = Image({row.extent.height, row.extent.width}, 1);
    EXPECT_THROW(pair.prepare("a.exr"), Error);
}

/// The number as the map tells it.
double numberOf(const Row& row, const ImagePair& pair, const Image& map) {
    double sum = 0, squares = 0, count = 0, windows = 0, edges = 0, sharp = 0;
    for (int y = 0; y < map.height(); ++y)
        for (int x = 0; x < map.width(); ++x) {
            const double value = map.at(0, x, y);
            sum += value, squares += value * value, count += pair.counts(x, y);
            windows += pair.counts(x, y) && x >= 5 && y >= 5 && x < map.width() - 5 && y < map.height() - 5;
            edges += value > 0, sharp += value > 0 && value < 0.635f;
        }
    switch (row.map) {
        case Map::Mean: return sum / count;
        case Map::RootOfMeanSquare: return std::sqrt(squares / count);
        case Map::Decibels: return -10 * std::log10(sum / count);
        case Map::Windows: return 1 - sum / windows;
        case Map::Edges: return sharp / edges;
        case Map::PixelsAlone: break;
    }
    return std::nan("");
}

TEST_P(EveryMetric, TheMapBelongsToTheNumber) {
    ImagePair pair = pairFor(row);
    pair.mask = maskFor(row.extent);
    pair.prepare();
    const Measurement seen = metric.measure(pair, true);
    if (row.map == Map::PixelsAlone) {  // with one scale it is the mean over windows
        Row small = row;
        small.map = Map::Windows, small.extent = {61, 19};
        ImagePair one{picture(small.extent, 2, 0.02f), picture(small.extent, 1, 0.01f)};
        one.prepare();
        const Measurement single = metric.measure(one, true);
        EXPECT_EQ(single.details.back(), (std::pair<std::string, double>{"scales", 1}));
        Image inside = single.map;  // the border repeats the nearest window, which is no window of its own
        for (int y = 0; y < 19; ++y)
            for (int x = 0; x < 61; ++x)
                if (x < 5 || y < 5 || x >= 56 || y >= 14) inside.at(0, x, y) = 0;
        EXPECT_NEAR(numberOf(small, one, inside), single.value, 1e-5);
        return;
    }
    EXPECT_NEAR(numberOf(row, pair, seen.map), seen.value, row.map == Map::Decibels ? 1e-4 : 1e-6);
}

TEST(MsSsim, SaysHowManyScalesFit) {
    for (const auto& [side, scales] : {std::pair{11, 1}, {20, 1}, {21, 2}, {160, 4}, {161, 5}, {170, 5}}) {
        ImagePair pair{picture({170, side}, 2, 0.1f), picture({170, side}, 1, 0)};
        pair.prepare();
        EXPECT_EQ(measureMsSsim(pair, false).details.back(), (std::pair<std::string, double>{"scales", scales}))
            << side;
    }
}

TEST_P(EveryMetric, ImagesOfAnySizeGiveAValueOrSayWhyNot) {
    for (const Extent2 extent :
         {Extent2{1, 1}, Extent2{2, 9}, Extent2{10, 40}, Extent2{11, 11}, Extent2{23, 12}, Extent2{267, 13}}) {
        ImagePair pair{picture(extent, 2, 0.1f), picture(extent, 1, 0), {}, 0};
        pair.prepare();
        const Measurement seen = metric.measure(pair, true);
        EXPECT_EQ(seen.reason.empty(), std::isfinite(seen.value)) << extent.width << 'x' << extent.height;
        EXPECT_EQ(seen.map.extent(), extent);
    }
}

INSTANTIATE_TEST_SUITE_P(Catalogue, EveryMetric, testing::ValuesIn(kRows),
                         [](const auto& tested) { return std::string(tested.param.id); });

TEST(EveryMetricOfTheCatalogue, HasARow) {
    ASSERT_EQ(std::size(kRows), metricCatalog().size());
    for (size_t i = 0; i < metricCatalog().size(); ++i) EXPECT_STREQ(kRows[i].id, metricCatalog()[i].id);
}

}  // namespace
}  // namespace lumi
