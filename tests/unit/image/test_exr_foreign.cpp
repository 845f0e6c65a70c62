// Files as other tools write them: channel names, windows, parts, tiles, subsampling.
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfMultiPartOutputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfOutputPart.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfTileDescription.h>
#include <OpenEXR/ImfTiledOutputFile.h>
#include <gtest/gtest.h>

#include <vector>

#include "image/exr.h"
#include "image/hdr.h"
#include "support/expect_error.h"
#include "support/temporary_folder.h"
#include "support/test_images.h"

namespace lumi {
namespace {

TEST(ExrNames, OtherToolsNamesAreOurs) {
    const std::pair<const char*, const char*> table[] = {{"Noisy Image.R", "noisy.R"},
                                                         {"Combined.R", "R"},
                                                         {"Beauty.A", "A"},
                                                         {"Composite.Combined.B", "B"},
                                                         {"ViewLayer.Combined.G", "G"},
                                                         {"Albedo.R", "albedo.R"},
                                                         {"Denoising Albedo.G", "albedo.G"},
                                                         {"ViewLayer.Denoising Albedo.B", "albedo.B"},
                                                         {"VisibleDiffuse.R", "albedo.R"},
                                                         {"DiffCol.R", "albedo.R"},
                                                         {"Ns.X", "normal.X"},
                                                         {"N.X", "normal.X"},
                                                         {"N.R", "normal.X"},
                                                         {"N.B", "normal.Z"},
                                                         {"Denoising Normal.Y", "normal.Y"},
                                                         {"Denoising Depth.Z", "depth.Z"},
                                                         {"dd.y", "depth.Z"},
                                                         {"P.X", "position.X"},
                                                         {"worldPosition.Z", "position.Z"},
                                                         {"Vector.X", "motion.X"},
                                                         {"Vector.W", "motion.W"},
                                                         {"mvec.R", "motion.X"},
                                                         {"Variance.G", "sampleVariance.G"},
                                                         {"RelativeVariance.R", "relativeVariance.R"},
                                                         {"id", "objectId"},
                                                         {".R", "R"},
                                                         {"R", "R"},
                                                         {"Z", "Z"},
                                                         {"normal.X", "normal.X"},
                                                         {"objectId", "objectId"},
                                                         {"svgf-historyLength.Y", "svgf-historyLength.Y"},
                                                         {"some.other.Q", "some.other.Q"}};
    for (const auto& [theirs, ours] : table) EXPECT_EQ(canonicalChannel(theirs), ours) << theirs;
}

TEST(ExrNames, ShadingNormalsWinOverGeometricOnesAndOurNamesOverBoth) {
    ExrLayers layers;
    layers.add("N", "XYZ", test::noiseImage({2, 2}, 3, 1, 1));
    const Image shading = test::noiseImage({2, 2}, 3, 1, 2), ours = test::noiseImage({2, 2}, 3, 1, 3);
    layers.add("Ns", "XYZ", shading);
    EXPECT_EQ(layers.image("normal", "XYZ"), shading);
    layers.add("normal", "XYZ", ours);
    EXPECT_EQ(layers.image("normal", "XYZ"), ours);
}

/// Values of a channel: 100 * channel + 10 * y + x over the data window's own pixels.
std::vector<float> ramp(const Imath::Box2i& window, float base) {
    std::vector<float> values;
    for (int y = window.min.y; y <= window.max.y; ++y)
        for (int x = window.min.x; x <= window.max.x; ++x) values.push_back(base + 10.0f * y + x);
    return values;
}

TEST(ExrForeign, DataWindowIsPlacedInTheDisplayWindow) {
    const test::TemporaryFolder folder;
    const Imath::Box2i display({0, 0}, {5, 3}), data({-2, 1}, {3, 7});
    Imf::Header header(display, data);
    header.channels().insert("Y", Imf::Channel(Imf::FLOAT));
    std::vector<float> values = ramp(data, 0);
    Imf::FrameBuffer buffer;
    buffer.insert("Y", Imf::Slice::Make(Imf::FLOAT, values.data(), data));
    {
        Imf::OutputFile file((folder / "window.exr").c_str(), header);
        file.setFrameBuffer(buffer);
        file.writePixels(7);
    }
    const ExrLayers layers = readExr(folder / "window.exr");
    ASSERT_EQ(layers.extent, (Extent2{6, 4}));
    const Image image = layers.image("", "Y");
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 6; ++x)
            EXPECT_EQ(image.at(0, x, y), y >= 1 && x <= 3 ? 10.0f * y + x : 0.0f) << x << ' ' << y;
    EXPECT_EQ(loadImage(folder / "window.exr").channels(), 3);
}

TEST(ExrForeign, PartsBecomeLayers) {
    const test::TemporaryFolder folder;
    const Imath::Box2i window({0, 0}, {3, 2});
    std::vector<Imf::Header> headers;
    for (const char* name : {"rgb", "albedo", "depth"}) {
        Imf::Header header(window, window);
        header.setName(name);
        header.setType(Imf::SCANLINEIMAGE);
        const std::vector<const char*> channels =
            std::string(name) == "depth" ? std::vector<const char*>{"Z"} : std::vector<const char*>{"R", "G", "B"};
        for (const char* channel : channels) header.channels().insert(channel, Imf::Channel(Imf::FLOAT));
        headers.push_back(header);
    }
    {
        Imf::MultiPartOutputFile file((folder / "parts.exr").c_str(), headers.data(), 3);
        for (int part = 0; part < 3; ++part) {
            std::vector<float> values = ramp(window, 100.0f * static_cast<float>(part));
            Imf::FrameBuffer buffer;
            for (auto c = headers[size_t(part)].channels().begin(); c != headers[size_t(part)].channels().end(); ++c)
                buffer.insert(c.name(), Imf::Slice::Make(Imf::FLOAT, values.data(), window));
            Imf::OutputPart output(file, part);
            output.setFrameBuffer(buffer);
            output.writePixels(3);
        }
    }
    const ExrLayers layers = readExr(folder / "parts.exr");
    EXPECT_EQ(layers.image("", "RGB").at(1, 2, 1), 12.0f);
    EXPECT_EQ(layers.image("albedo", "RGB").at(2, 2, 1), 112.0f);
    EXPECT_EQ(layers.image("depth", "Z").at(0, 2, 1), 212.0f);
}

TEST(ExrForeign, TilesAndSubsampledChannelsAreRead) {
    const test::TemporaryFolder folder;
    const Imath::Box2i window({0, 0}, {36, 20});
    std::vector<float> values = ramp(window, 0);
    Imf::FrameBuffer buffer;
    buffer.insert("Y", Imf::Slice::Make(Imf::FLOAT, values.data(), window));
    Imf::Header tiled(window, window);
    tiled.channels().insert("Y", Imf::Channel(Imf::FLOAT));
    tiled.setTileDescription(Imf::TileDescription(16, 8, Imf::ONE_LEVEL));
    {
        Imf::TiledOutputFile file((folder / "tiled.exr").c_str(), tiled);
        file.setFrameBuffer(buffer);
        file.writeTiles(0, file.numXTiles() - 1, 0, file.numYTiles() - 1);
    }
    EXPECT_EQ(readExr(folder / "tiled.exr").channels.at("Y").floats, values);

    const Imath::Box2i even({0, 0}, {3, 3});
    Imf::Header sub(even, even);
    sub.channels().insert("RY", Imf::Channel(Imf::FLOAT, 2, 2));
    std::vector<float> quarter = {1, 2, 3, 4};
    Imf::FrameBuffer quarters;
    quarters.insert("RY", Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(quarter.data()), 4, 8, 2, 2));
    {
        Imf::OutputFile file((folder / "sub.exr").c_str(), sub);
        file.setFrameBuffer(quarters);
        file.writePixels(4);
    }
    EXPECT_EQ(readExr(folder / "sub.exr").channels.at("RY").floats,
              (std::vector<float>{1, 1, 2, 2, 1, 1, 2, 2, 3, 3, 4, 4, 3, 3, 4, 4}));
}

TEST(ExrForeign, FilesWithoutPictureAreRefusedAsPictures) {
    const test::TemporaryFolder folder;
    ExrLayers layers;
    layers.add("depth", "Z", Image({2, 2}, 1));
    writeExr(folder / "depth.exr", layers);
    test::expectError(ErrorKind::BadInput, [&] { loadImage(folder / "depth.exr"); }, {"depth.exr", "depth.Z"});
}

}  // namespace
}  // namespace lumi
