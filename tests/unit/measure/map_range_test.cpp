// Which colours the error maps of a metric share.
#include "measure/map_range.h"

#include <gtest/gtest.h>

#include <limits>

namespace lumi::test {
namespace {

/// 100 values: `low`, but for the last `count`, which are `high`.
Image mapOf(float low, float high, int count) {
    Image map({10, 10}, 1);
    map.fill(low);
    for (int i = 100 - count; i < 100; ++i) map.at(0, i % 10, i / 10) = high;
    return map;
}

float highOf(const char* metric, const std::vector<Image>& maps) {
    MapRange range(findMetric(metric));
    for (const Image& map : maps) range.add(map);
    EXPECT_EQ(range.display().low, 0);
    EXPECT_EQ(range.display().high, range.high());
    EXPECT_FALSE(range.display().autoRange);
    return range.high();
}

TEST(MapRange, GoesToTheLargestPercentileOfAMap) {
    EXPECT_EQ(highOf("mse", {mapOf(0.25f, 0.5f, 5)}), 0.5f);
    EXPECT_EQ(highOf("mse", {mapOf(0.25f, 900, 1)}), 0.25f) << "one pixel in a hundred is left out";
    EXPECT_EQ(highOf("mse", {mapOf(0.25f, 0.5f, 5), mapOf(1, 2, 5), {}}), 2) << "of several maps the larger";
}

TEST(MapRange, ShowsAFewWrongPixels) {
    EXPECT_EQ(highOf("rmse", {mapOf(0, 7, 1)}), 7);
    EXPECT_EQ(highOf("rmse", {mapOf(0, std::numeric_limits<float>::infinity(), 1)}), 1);
    EXPECT_EQ(highOf("rmse", {mapOf(0, 0, 0)}), 1) << "equal images";
    EXPECT_EQ(highOf("rmse", {}), 1);
}

TEST(MapRange, MapsWithAScaleOfTheirOwnKeepIt) {
    for (const char* id : {"ssim", "ms_ssim", "flip", "hdr_flip", "cpbd"})
        EXPECT_EQ(highOf(id, {mapOf(0.01f, 0.3f, 50)}), 1) << id;
    EXPECT_EQ(MapRange(findMetric("flip")).display().colourMap, findMetric("flip").mapColours);
}

}  // namespace
}  // namespace lumi::test
