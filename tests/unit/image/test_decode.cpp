#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "base/error.h"
#include "base/files.h"
#include "image/decode.h"
#include "image/hdr.h"
#include "image/png.h"
#include "support/expect_error.h"
#include "support/temporary_folder.h"
#include "support/test_images.h"

namespace lumi {
namespace {
using test::expectError;

/// 24-bit BMP of 2x1: blue-ish (1,2,3) and (4,5,6).
std::vector<uint8_t> smallBmp() {
    std::vector<uint8_t> bytes = {'B', 'M', 62, 0, 0, 0, 0, 0, 0, 0, 54, 0, 0, 0,  40,
                                  0,   0,   0,  2, 0, 0, 0, 1, 0, 0, 0,  1, 0, 24, 0};
    bytes.resize(54);
    bytes.insert(bytes.end(), {3, 2, 1, 6, 5, 4, 0, 0});
    return bytes;
}

TEST(Decode, KnowsFormatsByTheirContents) {
    const Image8 bmp = decodeImage8(smallBmp(), "small.bmp");
    EXPECT_EQ(bmp.extent, (Extent2{2, 1}));
    EXPECT_EQ(bmp.rgba, (std::vector<uint8_t>{1, 2, 3, 255, 4, 5, 6, 255}));
    EXPECT_EQ(encodedExtent(smallBmp(), "small.bmp"), (Extent2{2, 1}));
}

TEST(Decode, JpegTablesThatOverflowAreRefused) {
    // A comment, then a table whose 16 counts add up to 257; the size of the segment lies.
    std::vector<uint8_t> jpeg = {0xFF, 0xD8, 0xFF, 0xFE, 0, 4, 0xFF, 0xC4, 0xFF, 0xFF, 0xC4, 0, 19, 0x11};
    for (int i = 0; i < 16; ++i) jpeg.push_back(i < 2 ? 128 : i == 2);
    jpeg.resize(400);
    for (const bool overflows : {true, false}) {
        jpeg[16] = overflows;
        try {
            decodeImage8(jpeg, "a.jpg");
            ADD_FAILURE() << "no image";
        } catch (const Error& error) {
            EXPECT_EQ(std::string(error.what()).find("257") != std::string::npos, overflows) << error.what();
        }
    }
}

TEST(Decode, DamageIsRefusedByName) {
    const std::vector<uint8_t> garbage(1000, 0x77);
    expectError(ErrorKind::BadInput, [&] { decodeImage8(garbage, "image 3"); }, {"image 3"});
    expectError(ErrorKind::BadInput, [&] { decodeImage8({}, "image 4"); }, {"image 4"});
    const std::vector<uint8_t> png = encodePng(test::noiseImage8({30, 30}));
    expectError(ErrorKind::BadInput, [&] { decodeImage8(std::span(png).first(png.size() / 2), "cut"); }, {"cut"});
}

TEST(Decode, SizesThatAreRefusedAreSaid) {
    const auto expectRefused = [](uint32_t width, uint32_t height, const std::initializer_list<std::string>& parts) {
        std::vector<uint8_t> png = encodePng(test::noiseImage8({30, 30}));
        for (size_t byte = 0; byte < 4; ++byte) {
            png[16 + byte] = static_cast<uint8_t>(width >> (24 - 8 * byte));
            png[20 + byte] = static_cast<uint8_t>(height >> (24 - 8 * byte));
        }
        expectError(
            ErrorKind::BadInput, [&] { decodeImage8(png, "big.png"); }, parts);
    };
    expectRefused(40000, 1, {"big.png", "expected 1 to 32768 a side, found 40000x1"});
    expectRefused(uint32_t(1) << 30, 1, {"found 1073741824x1"});
    expectRefused(0, 1, {"found 0x1"});
    expectRefused(30000, 30000, {"image is too large", "expected at most ", " pixels, found 30000x30000"});

    std::vector<uint8_t> bmp = smallBmp();
    bmp[19] = 0x9c, bmp[18] = 0x40;
    expectError(ErrorKind::BadInput, [&] { decodeImage8(bmp, "big.bmp"); }, {"found 40000x1"});
}

TEST(Decode, JpegsOpen) {
    const char* assets = std::getenv("LUMISCOPE_ASSETS");
    const std::filesystem::path folder = assets ? assets : LUMISCOPE_SOURCE_DIR "/../shared/assets";
    if (!std::filesystem::exists(folder / "gltf/Sponza")) GTEST_SKIP() << "no shared assets at " << folder;
    int opened = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder / "gltf/Sponza")) {
        if (lowerExtension(entry.path()) != ".jpg" || opened == 3) continue;
        const Image8 image = decodeImage8(readFile(entry.path()), entry.path().string());
        EXPECT_EQ(image.rgba.size(), static_cast<size_t>(image.extent.area()) * 4);
        ++opened;
    }
    EXPECT_GT(opened, 0);
}

TEST(LoadImage, UnknownExtensionsAreRefused) {
    const test::TemporaryFolder folder;
    writeFileAtomically(folder / "notes.txt", "hello");
    expectError(ErrorKind::BadInput, [&] { loadImage(folder / "notes.txt"); }, {"notes.txt", ".exr"});
}

}  // namespace
}  // namespace lumi
