#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "image/hdr.h"
#include "support/expect_error.h"

namespace lumi {
namespace {
using test::expectError;

std::vector<uint8_t> hdrFile(const std::string& header, const std::string& resolution,
                             const std::vector<uint8_t>& data) {
    const std::string text = "#?RADIANCE\n" + header + "FORMAT=32-bit_rle_rgbe\n\n" + resolution + '\n';
    std::vector<uint8_t> bytes(text.begin(), text.end());
    bytes.insert(bytes.end(), data.begin(), data.end());
    return bytes;
}

// 2x3 flat pixels; the red mantissa counts them, exponent 136 makes it the value.
const std::vector<uint8_t> kFlat = {10, 1, 2, 136, 11, 1, 2, 136, 12, 1, 2, 136,
                                    13, 1, 2, 136, 14, 1, 2, 136, 15, 1, 2, 136};

TEST(Hdr, FlatPixelsInEveryOrientation) {
    const auto reds = [](const std::string& resolution) {
        const Image image = decodeHdr(hdrFile("", resolution, kFlat), "flat.hdr");
        std::vector<float> values(image.data(), image.data() + image.extent().area());
        EXPECT_EQ(image.at(1, 0, 0), 1.0f);
        EXPECT_EQ(image.at(2, 0, 0), 2.0f);
        return values;
    };
    EXPECT_EQ(reds("-Y 3 +X 2"), (std::vector<float>{10, 11, 12, 13, 14, 15}));
    EXPECT_EQ(reds("+Y 3 +X 2"), (std::vector<float>{14, 15, 12, 13, 10, 11}));
    EXPECT_EQ(reds("-Y 3 -X 2"), (std::vector<float>{11, 10, 13, 12, 15, 14}));
    // Columns are stored: 3 columns of 2.
    EXPECT_EQ(reds("+X 3 -Y 2"), (std::vector<float>{10, 12, 14, 11, 13, 15}));
}

TEST(Hdr, ExponentsExposureAndBlack) {
    const Image image =
        decodeHdr(hdrFile("EXPOSURE=2\nEXPOSURE=2\n", "-Y 1 +X 2", {128, 64, 0, 129, 255, 255, 255, 0}), "x.hdr");
    EXPECT_EQ(image.at(0, 0, 0), 0.25f);  // 128 * 2^-7 / 4
    EXPECT_EQ(image.at(1, 0, 0), 0.125f);
    EXPECT_EQ(image.at(0, 1, 0), 0.0f);
}

TEST(Hdr, RunsAreExpanded) {
    std::vector<uint8_t> data = {2, 2, 0, 10};
    for (const uint8_t value : {uint8_t(7), uint8_t(8), uint8_t(9)}) data.insert(data.end(), {128 + 10, value});
    data.insert(data.end(), {4, 136, 136, 137, 137, 128 + 6, 136});
    const Image image = decodeHdr(hdrFile("", "-Y 1 +X 10", data), "runs.hdr");
    for (int x = 0; x < 10; ++x) {
        const float factor = x == 2 || x == 3 ? 2.0f : 1.0f;
        EXPECT_EQ(image.at(0, x, 0), 7 * factor);
        EXPECT_EQ(image.at(2, x, 0), 9 * factor);
    }
    // The older scheme: repeat the last pixel three times.
    const Image old = decodeHdr(hdrFile("", "-Y 1 +X 4", {5, 6, 7, 136, 1, 1, 1, 3}), "old.hdr");
    EXPECT_EQ(old.at(0, 3, 0), 5.0f);
}

TEST(Hdr, DamageIsRefusedByName) {
    const std::vector<uint8_t> whole = hdrFile("", "-Y 3 +X 2", kFlat);
    for (size_t size = 0; size < whole.size(); ++size)
        expectError(ErrorKind::BadInput, [&] { decodeHdr(std::span(whole).first(size), "cut.hdr"); }, {"cut.hdr"});
    for (const char* resolution :
         {"-Y 0 +X 2", "-Y 3 +X -2", "-Y 60000 +X 60000", "-Y 3 +Y 2", "hello", "-Y 99999999 +X 2"})
        expectError(ErrorKind::BadInput, [&] { decodeHdr(hdrFile("", resolution, kFlat), "bad.hdr"); }, {"bad.hdr"});
    // Runs beyond the line, and a line that says it is longer.
    expectError(ErrorKind::BadInput,
                [] {
                    decodeHdr(hdrFile("", "-Y 1 +X 8", {2, 2, 0, 8, 255, 1}), "run.hdr");
                },
                {"run.hdr"});
    expectError(ErrorKind::BadInput,
                [] {
                    decodeHdr(hdrFile("", "-Y 1 +X 8", {2, 2, 0, 9, 136, 1}), "run.hdr");
                },
                {"run.hdr"});
}

TEST(Hdr, EnvironmentMapsOpen) {
    const char* assets = std::getenv("LUMISCOPE_ASSETS");
    const std::filesystem::path folder = assets ? assets : LUMISCOPE_SOURCE_DIR "/../shared/assets";
    const std::filesystem::path path = folder / "env/venice_sunset_1k.hdr";
    if (!std::filesystem::exists(path)) GTEST_SKIP() << "no shared assets at " << folder;
    const Image image = loadImage(path);
    EXPECT_EQ(image.extent(), (Extent2{1024, 512}));
    double sum = 0;
    for (size_t i = 0; i < image.size(); ++i) sum += image.data()[i];
    EXPECT_GT(sum / static_cast<double>(image.size()), 0.1);
    EXPECT_LT(sum / static_cast<double>(image.size()), 10.0);
}

}  // namespace
}  // namespace lumi
