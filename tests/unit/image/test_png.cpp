#include <gtest/gtest.h>

#include "base/files.h"
#include "image/decode.h"
#include "image/exr.h"
#include "image/hdr.h"
#include "image/png.h"
#include "math/colour.h"
#include "support/expect_error.h"
#include "support/temporary_folder.h"
#include "support/test_images.h"

namespace lumi {
namespace {
using test::expectError;
using test::noiseImage8;

/// Builds a PNG chunk by chunk, with pixels in one stored deflate block.
class PngMaker {
public:
    void chunk(const std::string& type, const std::vector<uint8_t>& data) {
        append32(static_cast<uint32_t>(data.size()));
        const size_t begin = bytes_.size();
        bytes_.insert(bytes_.end(), type.begin(), type.end());
        bytes_.insert(bytes_.end(), data.begin(), data.end());
        uint32_t crc = ~0u;
        for (size_t i = begin; i < bytes_.size(); ++i) {
            crc ^= bytes_[i];
            for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ (crc & 1 ? 0xedb88320u : 0u);
        }
        append32(~crc);
    }
    void pixels(const std::vector<uint8_t>& rows) {
        const auto size = static_cast<uint8_t>(rows.size());
        std::vector<uint8_t> data = {0x78, 0x01, 0x01, size, 0, static_cast<uint8_t>(~size), 0xff};
        data.insert(data.end(), rows.begin(), rows.end());
        uint32_t a = 1, b = 0;
        for (const uint8_t byte : rows) a = (a + byte) % 65521, b = (b + a) % 65521;
        for (const uint32_t half : {b, a})
            for (const int shift : {8, 0}) data.push_back(static_cast<uint8_t>(half >> shift));
        chunk("IDAT", data);
    }
    const std::vector<uint8_t>& bytes() const { return bytes_; }

private:
    void append32(uint32_t value) {
        for (int shift = 24; shift >= 0; shift -= 8) bytes_.push_back(static_cast<uint8_t>(value >> shift));
    }
    std::vector<uint8_t> bytes_ = {0x89, 'P', 'N', 'G', 13, 10, 26, 10};
};

TEST(Png, SixteenBitsAndGreysAreRead) {
    PngMaker maker;
    maker.chunk("IHDR", {0, 0, 0, 2, 0, 0, 0, 1, 16, 0, 0, 0, 0});
    maker.pixels({0, 0x12, 0x34, 0xff, 0xff});
    maker.chunk("IEND", {});
    const Png png = decodePng(maker.bytes(), "grey16.png");
    EXPECT_EQ(png.bitDepth, 16);
    EXPECT_EQ(png.rgba, (std::vector<uint16_t>{0x1234, 0x1234, 0x1234, 0xffff, 0xffff, 0xffff, 0xffff, 0xffff}));
}

TEST(Png, AbsurdSizesAreRefusedBeforeAllocation) {
    for (const uint8_t high : {uint8_t(0), uint8_t(0x7f)}) {
        PngMaker maker;
        maker.chunk("IHDR", {high, 0, 0x80, 0, high, 0, 0x80, 0, 8, 6, 0, 0, 0});
        maker.pixels({0, 1, 2, 3, 4});
        expectError(ErrorKind::BadInput, [&] { decodePng(maker.bytes(), "huge.png"); }, {"huge.png"});
        expectError(ErrorKind::BadInput, [&] { decodeImage8(maker.bytes(), "huge.png"); }, {"huge.png"});
    }
}

TEST(Png, PixelsAndTextsComeBack) {
    const Image8 image = noiseImage8({257, 89});
    const PngTexts texts = {
        {kStateKey, "{\"ä\": \"" + std::string(5000, 'x') + "\"}"}, {"Software", "short\nlines"}, {"Empty", ""}};
    const Png read = decodePng(encodePng(image, texts, PngAlpha::Keep), "memory.png");
    EXPECT_EQ(read.extent, image.extent);
    EXPECT_EQ(read.image8().rgba, image.rgba);
    EXPECT_EQ(read.texts, texts);
    EXPECT_EQ(read.bitDepth, 8);
    EXPECT_TRUE(read.alpha);
}

TEST(Png, DroppedAlphaIsOpaque) {
    const Image8 image = noiseImage8({5, 3});
    const Png read = decodePng(encodePng(image), "memory.png");
    EXPECT_FALSE(read.alpha);
    for (size_t i = 0; i < image.rgba.size(); ++i)
        EXPECT_EQ(read.rgba[i], i % 4 == 3 ? 65535 : image.rgba[i] * 257) << i;
}

TEST(Png, BytesAreTheSameEveryTimeAndStbAgrees) {
    const Image8 image = noiseImage8({64, 31});
    const std::vector<uint8_t> bytes = encodePng(image, {{kStateKey, "{}"}}, PngAlpha::Keep);
    EXPECT_EQ(bytes, encodePng(image, {{kStateKey, "{}"}}, PngAlpha::Keep));
    EXPECT_EQ(decodeImage8(bytes, "memory.png").rgba, image.rgba);
}

TEST(Png, FilesOnDiskAndTheirTextsAlone) {
    const test::TemporaryFolder folder;
    const Image8 image = noiseImage8({1, 1});
    writePng(folder / "one.png", image, {{kStateKey, "state"}});
    EXPECT_EQ(readPngTexts(folder / "one.png").at(kStateKey), "state");
    const Image linear = loadImage(folder / "one.png");
    for (int c = 0; c < 3; ++c)
        EXPECT_EQ(linear.at(c, 0, 0), linearFromSrgb(image.rgba[static_cast<size_t>(c)] / 255.0f));
}

TEST(Png, DamageIsRefusedByName) {
    const std::vector<uint8_t> whole = encodePng(noiseImage8({40, 30}), {{kStateKey, "text"}});
    for (size_t size = 0; size + 12 < whole.size(); size += 1 + size / 8) {
        expectError(ErrorKind::BadInput, [&] { decodePng(std::span(whole).first(size), "cut.png"); }, {"cut.png"});
    }
    expectError(ErrorKind::BadInput, [] { readPng("/no/such.png"); }, {"/no/such.png"});
    for (uint32_t round = 0; round < 300; ++round) {
        std::vector<uint8_t> damaged = whole;
        damaged[8 + hashCombine(round, 1) % (damaged.size() - 8)] ^=
            static_cast<uint8_t>(1 + hashCombine(round, 2) % 255);
        try {
            decodePng(damaged, "damaged.png");
        } catch (const Error& error) {
            EXPECT_NE(std::string(error.what()).find("damaged.png"), std::string::npos) << error.what();
        }
    }
}

}  // namespace
}  // namespace lumi
