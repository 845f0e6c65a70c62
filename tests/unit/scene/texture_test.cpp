#include "scene/texture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "math/colour.h"
#include "math/hash.h"

namespace lumi {
namespace {

/// Texture of one row of grey values.
Texture row(std::vector<uint8_t> greys, bool srgb = false) {
    auto image = std::make_shared<TextureImage>();
    image->srgb = srgb;
    TextureImage::Level level{{static_cast<int>(greys.size()), 1}, {}, {}};
    for (const uint8_t grey : greys) level.bytes.insert(level.bytes.end(), {grey, grey, grey, 255});
    image->levels.push_back(level);
    buildMips(*image);
    Texture texture;
    texture.image = image;
    return texture;
}

float byte(float value) { return value / 255; }

TEST(Texture, NoneIsWhite) {
    EXPECT_EQ(Texture().sample({0.3f, 0.7f}), Vec4(1));
    EXPECT_EQ(Texture().sampleAlpha({0.3f, 0.7f}), 1);
}

TEST(Texture, LinearFilterBlendsTexelCentres) {
    Texture texture = row({0, 100, 200, 100});
    EXPECT_NEAR(texture.sample({0.375f, 0.5f}).x, byte(100), 1e-6f);
    EXPECT_NEAR(texture.sample({0.5f, 0.5f}).x, byte(150), 1e-6f);
    EXPECT_NEAR(texture.sample({0.4375f, 0.5f}).x, byte(125), 1e-6f);
}

TEST(Texture, WrapModes) {
    Texture texture = row({0, 40, 80, 200});
    // Between the last and the first texel.
    EXPECT_NEAR(texture.sample({0, 0}).x, byte(100), 1e-6f);
    EXPECT_NEAR(texture.sample({1.375f, 0}).x, byte(40), 1e-6f);
    EXPECT_NEAR(texture.sample({-0.625f, 0}).x, byte(40), 1e-6f);
    texture.wrapU = Wrap::ClampToEdge;
    EXPECT_NEAR(texture.sample({-3, 0}).x, 0, 1e-6f);
    EXPECT_NEAR(texture.sample({5, 0}).x, byte(200), 1e-6f);
    texture.wrapU = Wrap::MirroredRepeat;
    EXPECT_NEAR(texture.sample({1.125f, 0}).x, byte(200), 1e-6f);
    EXPECT_NEAR(texture.sample({-0.375f, 0}).x, byte(40), 1e-6f);
    EXPECT_NEAR(texture.sample({2.375f, 0}).x, byte(40), 1e-6f);
    EXPECT_NEAR(texture.sample({0, 0}).x, 0, 1e-6f);
}

TEST(Texture, NearestFilterTakesTheTexel) {
    Texture texture = row({0, 40, 80, 200});
    texture.filter = TextureFilter::Nearest;
    EXPECT_NEAR(texture.sample({0.26f, 0}).x, byte(40), 1e-6f);
    EXPECT_NEAR(texture.sample({0.499f, 0}).x, byte(40), 1e-6f);
    EXPECT_NEAR(texture.sample({0.999999f, 0}).x, byte(200), 1e-6f);
    EXPECT_NEAR(texture.sample({1.0f, 0}).x, 0, 1e-6f);
    texture.wrapU = Wrap::ClampToEdge;
    EXPECT_NEAR(texture.sample({1.0f, 0}).x, byte(200), 1e-6f);
}

TEST(Texture, SrgbIsDecodedBeforeFiltering) {
    const Texture texture = row({0, 255}, true);
    EXPECT_NEAR(texture.sample({0.5f, 0}).x, 0.5f, 1e-6f);
    EXPECT_NEAR(row({188, 188}, true).sample({0.5f, 0}).x, linearFromSrgb(188.0f / 255), 1e-6f);
    EXPECT_EQ(texture.sample({0.5f, 0}).w, 1);
}

TEST(Texture, MipsAreMeansInLinearLight) {
    const Texture plain = row({0, 100, 200, 100});
    ASSERT_EQ(plain.image->levels.size(), 3u);
    EXPECT_EQ(plain.image->levels[1].bytes[0], 50);
    EXPECT_EQ(plain.image->levels[1].bytes[4], 150);
    EXPECT_EQ(plain.image->levels[2].bytes[0], 100);
    const Texture encoded = row({0, 255}, true);
    EXPECT_NEAR(encoded.image->levels[1].bytes[0], srgbFromLinear(0.5f) * 255, 1);
    for (int code = 0; code < 256; ++code) {
        const Texture uniform = row({static_cast<uint8_t>(code), static_cast<uint8_t>(code)}, true);
        EXPECT_EQ(uniform.image->levels[1].bytes[0], code) << "a uniform image stays what it is";
    }
}

TEST(Texture, OddExtentsHalveDownToOneTexel) {
    auto image = std::make_shared<TextureImage>();
    image->levels.push_back({{5, 3}, std::vector<uint8_t>(60, 90), {}});
    buildMips(*image);
    ASSERT_EQ(image->levels.size(), 3u);
    EXPECT_EQ(image->levels[1].extent, (Extent2{2, 1}));
    EXPECT_EQ(image->levels[2].extent, (Extent2{1, 1}));
    EXPECT_EQ(image->levels[2].bytes[0], 90);
}

enum class Format { Linear, Srgb, Float };

/// Random texels; those of the last row and column are bright, which levels that lose them cannot hide.
TextureImage randomImage(Extent2 extent, Format format) {
    TextureImage image;
    image.srgb = format == Format::Srgb;
    TextureImage::Level level{extent, {}, {}};
    for (int y = 0; y < extent.height; ++y)
        for (int x = 0; x < extent.width; ++x)
            for (int c = 0; c < 4; ++c) {
                const uint32_t hash = pcgHash(static_cast<uint32_t>(4 * (y * extent.width + x) + c));
                const bool last = x == extent.width - 1 || y == extent.height - 1;
                const auto code = static_cast<uint8_t>(last ? 255 - hash % 16 : hash % 128);
                if (format == Format::Float) level.floats.push_back(20 * byte(code));
                else level.bytes.push_back(code);
            }
    image.levels.push_back(level);
    buildMips(image);
    return image;
}

/// Linear, of one channel.
double meanOf(const TextureImage& image, const TextureImage::Level& level, size_t channel) {
    double sum = 0;
    for (size_t i = channel; i < 4 * static_cast<size_t>(level.extent.area()); i += 4) {
        if (!level.floats.empty()) sum += level.floats[i];
        else sum += image.srgb && channel < 3 ? linearFromSrgb(byte(level.bytes[i])) : byte(level.bytes[i]);
    }
    return sum / static_cast<double>(level.extent.area());
}

TEST(Texture, EveryLevelHasTheMeanOfTheOneAbove) {
    for (const Format format : {Format::Linear, Format::Srgb, Format::Float})
        for (int height = 1; height <= 33; ++height)
            for (int width = 1; width <= 33; ++width) {
                const TextureImage image = randomImage({width, height}, format);
                for (size_t k = 1; k < image.levels.size(); ++k)
                    for (size_t c = 0; c < 4; ++c) {
                        // Half a code, which of sRGB is widest at white.
                        const bool encoded = format == Format::Srgb && c < 3;
                        const double rounding = format == Format::Float ? 2e-5 : encoded ? 0.0046 : 0.5001 / 255;
                        ASSERT_NEAR(meanOf(image, image.levels[k], c), meanOf(image, image.levels[k - 1], c), rounding)
                            << width << 'x' << height << ", level " << k << ", channel " << c;
                    }
            }
}

TEST(Texture, HalfBlackHalfWhiteIsGreyFromAfar) {
    std::vector<uint8_t> greys(1000, 0);
    std::fill(greys.begin() + 500, greys.end(), uint8_t(255));
    EXPECT_NEAR(row(greys).sample({0.3f, 0.5f}, 1e6f).x, 0.5f, 2.5f / 255);
    EXPECT_NEAR(row(greys, true).sample({0.3f, 0.5f}, 1e6f).x, 0.5f, 0.02f);
}

TEST(Texture, OddLevelsOfOneColourKeepIt) {
    for (const bool srgb : {false, true})
        for (int code = 0; code < 256; ++code) {
            const Texture texture = row(std::vector<uint8_t>(7, static_cast<uint8_t>(code)), srgb);
            for (const TextureImage::Level& level : texture.image->levels)
                for (size_t i = 0; i < level.bytes.size(); ++i) ASSERT_EQ(level.bytes[i], i % 4 == 3 ? 255 : code);
        }
}

TEST(Texture, FloatImagesKeepTheirRange) {
    auto image = std::make_shared<TextureImage>();
    image->levels.push_back({{2, 1}, {}, {0, 0, 0, 1, 1000, 500, 2, 1}});
    buildMips(*image);
    Texture texture;
    texture.image = image;
    EXPECT_EQ(image->levels[1].floats, (std::vector<float>{500, 250, 1, 1}));
    EXPECT_NEAR(texture.sample({0.75f, 0}).x, 1000, 1e-3f);
    EXPECT_EQ(image->byteCount(), 12 * sizeof(float));
}

TEST(Texture, FootprintChoosesTheLevelAndBlendsBetweenTwo) {
    auto image = std::make_shared<TextureImage>();
    image->levels = {{{4, 4}, std::vector<uint8_t>(64, 0), {}},
                     {{2, 2}, std::vector<uint8_t>(16, 100), {}},
                     {{1, 1}, std::vector<uint8_t>(4, 200), {}}};
    Texture texture;
    texture.image = image;
    EXPECT_NEAR(texture.sample({0.1f, 0.1f}, 0.25f).x, 0, 1e-6f);
    EXPECT_NEAR(texture.sample({0.1f, 0.1f}, 0.5f).x, byte(100), 1e-6f);
    EXPECT_NEAR(texture.sample({0.1f, 0.1f}, 0.375f).x, byte(50), 1e-6f);
    EXPECT_NEAR(texture.sample({0.1f, 0.1f}, 1).x, byte(200), 1e-6f);
    EXPECT_NEAR(texture.sample({0.1f, 0.1f}, 1e30f).x, byte(200), 1e-6f);
    EXPECT_NEAR(texture.sample({0.1f, 0.1f}, kInfinity).x, byte(200), 1e-6f);
}

TEST(Texture, TheNearestLevelIsOneOfTheTwoThatAreBlended) {
    auto image = std::make_shared<TextureImage>();
    image->levels.push_back({{8, 8}, std::vector<uint8_t>(256), {}});
    for (size_t i = 0; i < 256; ++i) image->levels[0].bytes[i] = static_cast<uint8_t>(i * 37);
    buildMips(*image);
    Texture texture;
    texture.image = image;
    for (const float width : {0.0f, 0.125f, 0.25f, 0.5f, 1.0f, 8.0f})  // whole levels
        for (const float u : {0.1f, 0.45f, 0.8f}) {
            texture.prefetch({u, 0}, width);
            EXPECT_EQ(texture.sampleNearestLevel({u, 0}, width), texture.sample({u, 0}, width)) << width;
        }
    EXPECT_EQ(texture.sampleNearestLevel({0.1f, 0}, 0.3f), texture.sample({0.1f, 0}, 0.25f));
    EXPECT_EQ(texture.sampleNearestLevel({0.1f, 0}, 0.45f), texture.sample({0.1f, 0}, 0.5f));
    EXPECT_EQ(texture.sampleNearestLevel({NAN, 0}, 0.3f), texture.sample({NAN, 0}, 0.3f));
    EXPECT_EQ(Texture().sampleNearestLevel({0.1f, 0}, 0.3f), Vec4(1));
}

TEST(Texture, CoordinatesThatAreNotFiniteGiveTheFirstTexel) {
    const Texture texture = row({30, 40, 80, 200});
    for (const float bad : {std::nanf(""), kInfinity, -kInfinity}) {
        EXPECT_NEAR(texture.sample({bad, 0}).x, byte(30), 1e-6f);
        EXPECT_EQ(texture.sampleAlpha({0, bad}), 1);
    }
    EXPECT_TRUE(std::isfinite(texture.sample({1e30f, -1e30f}).x));
    EXPECT_TRUE(std::isfinite(texture.sample({0.5f, 0.5f}, std::nanf("")).x));
}

TEST(Texture, AlphaAgreesWithTheFullLookup) {
    auto image = std::make_shared<TextureImage>();
    image->srgb = true;
    TextureImage::Level level{{3, 2}, {}, {}};
    for (int i = 0; i < 24; ++i) level.bytes.push_back(static_cast<uint8_t>(37 * i));
    image->levels.push_back(level);
    Texture texture;
    texture.image = image;
    for (const Wrap wrap : {Wrap::Repeat, Wrap::MirroredRepeat, Wrap::ClampToEdge})
        for (float u = -1.5f; u < 2; u += 0.17f) {
            texture.wrapU = texture.wrapV = wrap;
            EXPECT_NEAR(texture.sampleAlpha({u, 1.3f * u}), texture.sample({u, 1.3f * u}).w, 1e-6f);
        }
}

TEST(Texture, TransformScalesThenTurnsThenShifts) {
    Texture texture;
    texture.scale = {2, 3};
    texture.offset = {0.25f, 0.5f};
    EXPECT_EQ(texture.transformed({0.5f, 0.5f}), Vec2(1.25f, 2.0f));
    // A quarter turn counter-clockwise as the texture is seen, v down: u goes to -v.
    texture.rotation = kPi / 2;
    const Vec2 turned = texture.transformed({0.5f, 0});
    EXPECT_NEAR(turned.x, 0.25f, 1e-6f);
    EXPECT_NEAR(turned.y, -0.5f, 1e-6f);
}

}  // namespace
}  // namespace lumi
