// What we write reads back bit for bit, and damaged files are refused by name.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "base/files.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "image/exr.h"
#include "support/expect_error.h"
#include "support/temporary_folder.h"
#include "support/test_images.h"

namespace lumi {
namespace {
using test::expectError;
using test::noiseImage;

IdImage someIds(Extent2 extent, int channels) {
    IdImage ids(extent, channels);
    for (size_t i = 0; i < ids.size(); ++i) ids.data()[i] = pcgHash(static_cast<uint32_t>(i));
    return ids;
}

ExrLayers someLayers(Extent2 extent) {
    ExrLayers layers;
    layers.add("", "RGBA", noiseImage(extent, 4, 100));
    layers.add("", "Z", noiseImage(extent, 1, 10, 2));
    layers.add("albedo", "RGB", noiseImage(extent, 3, 1, 3), ExrType::Half);
    layers.add("motion", "XYZ", noiseImage(extent, 3, 20, 4));
    layers.add("svgf-historyLength", "Y", noiseImage(extent, 1, 32, 5));
    layers.addIds("objectId", "I", someIds(extent, 1));
    layers.addIds("surface", "IPUV", someIds(extent, 4));
    layers.strings[kStateKey] = R"({"scene":"cornell","note":"ä\n"})";
    layers.strings["empty"] = "";
    layers.worldToCamera = Mat4(1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16);
    layers.worldToNdc = Mat4(2);
    layers.pixelAspect = 1.5f;
    return layers;
}

TEST(Exr, ChannelsKeepTheirNamesTypesAndBits) {
    const ExrLayers written = someLayers({257, 89});
    const ExrLayers read = decodeExr(encodeExr(written), "memory.exr");
    ASSERT_EQ(read.extent, written.extent);
    std::vector<std::string> names;
    for (const auto& [name, channel] : read.channels) names.push_back(name);
    EXPECT_EQ(names, (std::vector<std::string>{"A", "B", "G", "R", "Z", "albedo.B", "albedo.G", "albedo.R", "motion.X",
                                               "motion.Y", "motion.Z", "objectId", "surface.I", "surface.P",
                                               "surface.U", "surface.V", "svgf-historyLength.Y"}));
    for (const auto& [name, channel] : written.channels) {
        const ExrChannel& back = read.channels.at(name);
        EXPECT_EQ(back.type, channel.type) << name;
        EXPECT_EQ(back.ids, channel.ids) << name;
        if (channel.type == ExrType::Float) {
            EXPECT_EQ(back.floats, channel.floats) << name;
        }
        for (size_t i = 0; i < channel.floats.size(); ++i)
            ASSERT_NEAR(back.floats[i], channel.floats[i], 0.0005f * std::abs(channel.floats[i]) + 1e-7f) << name;
    }
}

TEST(Exr, AttributesComeBack) {
    const ExrLayers written = someLayers({3, 2});
    const ExrLayers read = decodeExr(encodeExr(written), "memory.exr");
    EXPECT_EQ(read.strings, written.strings);
    ASSERT_TRUE(read.worldToCamera && read.worldToNdc);
    EXPECT_EQ(*read.worldToCamera, *written.worldToCamera);
    EXPECT_EQ(*read.worldToNdc, *written.worldToNdc);
    EXPECT_EQ(read.pixelAspect, 1.5f);
}

TEST(Exr, SpecialValuesSurvive) {
    Image image({4, 1}, 1);
    image.at(0, 0, 0) = kInfinity;
    image.at(0, 1, 0) = -kInfinity;
    image.at(0, 2, 0) = std::numeric_limits<float>::quiet_NaN();
    image.at(0, 3, 0) = 1e-40f;
    ExrLayers layers;
    layers.add("depth", "Z", image);
    const Image back = decodeExr(encodeExr(layers), "memory.exr").image("depth", "Z");
    EXPECT_EQ(std::memcmp(back.data(), image.data(), image.bytes()), 0);
}

TEST(Exr, HalfStoresColoursOnly) {
    const ExrLayers read = decodeExr(encodeExr(someLayers({5, 5}), true), "memory.exr");
    for (const char* name : {"R", "G", "B", "A", "albedo.G"})
        EXPECT_EQ(read.channels.at(name).type, ExrType::Half) << name;
    for (const char* name : {"Z", "motion.X", "svgf-historyLength.Y"})
        EXPECT_EQ(read.channels.at(name).type, ExrType::Float) << name;
    EXPECT_EQ(read.channels.at("objectId").type, ExrType::Uint);
}

TEST(Exr, HalfKeepsFiniteValuesFinite) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const std::vector<float> given{65504, -65504, 65505, -1e6f, 3e38f, kInfinity, -kInfinity, nan, 1.5f, 0};
    Image image({10, 1}, 3);
    for (int c = 0; c < 3; ++c)
        for (int x = 0; x < 10; ++x) image.at(c, x, 0) = c == 1 ? given[static_cast<size_t>(x)] : 0.25f;
    ExrLayers layers;
    layers.add("", "RGB", image);
    layers.add("", "Z", noiseImage({10, 1}, 1, 1e6f));
    size_t clamped = 7;
    const std::vector<float> read = decodeExr(encodeExr(layers, true, &clamped), "memory.exr").channels.at("G").floats;
    EXPECT_EQ(clamped, 3u);
    const std::vector<float> expected{65504, -65504, 65504, -65504, 65504, kInfinity, -kInfinity, nan, 1.5f, 0};
    for (size_t i = 0; i < expected.size(); ++i) {
        if (std::isnan(expected[i])) EXPECT_TRUE(std::isnan(read[i]));
        else EXPECT_EQ(read[i], expected[i]) << given[i];
    }
    EXPECT_EQ(decodeExr(encodeExr(layers, false, &clamped), "memory.exr").channels.at("G").floats[4], 3e38f);
    EXPECT_EQ(clamped, 0u);
}

TEST(Exr, BytesDoNotDependOnThreadsOrTime) {
    const ExrLayers layers = someLayers({123, 77});
    std::vector<std::string> digests;
    for (const int threads : {1, 2, 8}) {
        setThreadCount(threads);
        digests.push_back(digest(encodeExr(layers)));
    }
    setThreadCount(0);
    EXPECT_EQ(digests[0], digests[1]);
    EXPECT_EQ(digests[0], digests[2]);
}

TEST(Exr, OnePixelAndFilesOnDisk) {
    const test::TemporaryFolder folder;
    const ExrLayers layers = someLayers({1, 1});
    writeExr(folder / "new/one.exr", layers);
    EXPECT_EQ(readExr(folder / "new/one.exr").image("", "RGB"), layers.image("", "RGB"));
}

TEST(Exr, MissingLayersAreEmptyImages) {
    const ExrLayers layers = someLayers({2, 2});
    EXPECT_TRUE(layers.image("normal", "XYZ").empty());
    EXPECT_EQ(layers.image("objectId", "I").at(0, 1, 0), static_cast<float>(pcgHash(1)));
}

TEST(Exr, MissingFilesAreRefusedByName) {
    expectError(ErrorKind::BadInput, [] { readExr("/no/such/file.exr"); }, {"/no/such/file.exr"});
    const std::vector<uint8_t> garbage(5000, 0x5a);
    expectError(ErrorKind::BadInput, [&] { decodeExr(garbage, "garbage.exr"); }, {"garbage.exr"});
    expectError(ErrorKind::BadInput, [&] { decodeExr({}, "nothing.exr"); }, {"nothing.exr"});
}

TEST(Exr, EveryTruncationIsRefused) {
    const std::vector<uint8_t> whole = encodeExr(someLayers({33, 40}));
    for (size_t size = 0; size < whole.size(); size += 1 + size / 10)
        expectError(ErrorKind::BadInput, [&] { decodeExr(std::span(whole).first(size), "cut.exr"); }, {"cut.exr"});
}

TEST(Exr, FlippedBytesNeverCrash) {
    const std::vector<uint8_t> whole = encodeExr(someLayers({17, 20}));
    for (uint32_t round = 0; round < 400; ++round) {
        std::vector<uint8_t> damaged = whole;
        for (uint32_t k = 0; k < 3; ++k) {
            // Half of the damage goes to the header, where it matters most.
            const size_t reach = round % 2 ? damaged.size() : 1200;
            damaged[hashCombine(round, k) % reach] = static_cast<uint8_t>(hashCombine(round, k + 10));
        }
        try {
            decodeExr(damaged, "damaged.exr");
        } catch (const Error& error) {
            EXPECT_NE(std::string(error.what()).find("damaged.exr"), std::string::npos) << error.what();
        }
    }
}

/// Overwrites the four ints of a window attribute.
std::vector<uint8_t> withWindow(std::vector<uint8_t> bytes, const std::string& attribute, int32_t maxX, int32_t maxY) {
    const std::string key = attribute + std::string("\0box2i\0\x10\0\0\0", 11);
    const auto found = std::search(bytes.begin(), bytes.end(), key.begin(), key.end());
    EXPECT_NE(found, bytes.end());
    const int32_t window[4] = {0, 0, maxX, maxY};
    std::memcpy(&*found + key.size(), window, sizeof window);
    return bytes;
}

TEST(Exr, AbsurdSizesAreRefusedBeforeAllocation) {
    ExrLayers layers;
    layers.add("", "RGB", noiseImage({4, 4}, 3));
    const std::vector<uint8_t> bytes = encodeExr(layers);
    const uint64_t before = peakResidentBytes();
    for (const char* window : {"dataWindow", "displayWindow"})
        for (const auto& [x, y] :
             {std::pair(60000, 60000), std::pair(2000000000, 3), std::pair(3, 2000000000), std::pair(-5, 3)})
            expectError(ErrorKind::BadInput, [&] { decodeExr(withWindow(bytes, window, x, y), "huge.exr"); },
                        {"huge.exr"});
    EXPECT_LT(peakResidentBytes() - before, uint64_t(64) << 20);
}

TEST(Exr, TheMemoryLimitIsKept) {
    ExrLayers layers;
    layers.add("", "RGB", Image({2000, 1000}, 3));
    const std::vector<uint8_t> bytes = encodeExr(layers);
    const uint64_t limit = memoryLimit();
    setMemoryLimit(residentBytes() + (uint64_t(8) << 20));
    expectError(ErrorKind::Resources, [&] { decodeExr(bytes, "large.exr"); }, {"large.exr", "2000x1000"});
    setMemoryLimit(limit);
}

}  // namespace
}  // namespace lumi
