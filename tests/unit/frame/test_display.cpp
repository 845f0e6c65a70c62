// The display conversion against its scalar definition, at odd sizes and on every instruction set.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "base/isa.h"
#include "base/parallel.h"
#include "base/timer.h"
#include "frame/colour_maps.h"
#include "frame/display.h"
#include "frame/display_kernels.h"
#include "math/colour.h"
#include "support/test_images.h"

namespace lumi {
namespace {
using test::noiseImage;

const float kNan = std::numeric_limits<float>::quiet_NaN();
const std::vector<uint8_t> kMagenta = {255, 0, 255, 255}, kCyan = {0, 255, 255, 255}, kBlack = {0, 0, 0, 255};

std::vector<uint8_t> pixel(const Image8& image, int x, int y) {
    const auto begin = image.rgba.begin() + (static_cast<std::ptrdiff_t>(y) * image.extent.width + x) * 4;
    return {begin, begin + 4};
}

int levels(uint8_t a, float b) { return std::abs(static_cast<int>(a) - static_cast<int>(b * 255 + 0.5f)); }

std::vector<Isa> machineIsas() {
    std::vector<Isa> list;
    for (const Isa isa : {Isa::Baseline, Isa::V3, Isa::V4})
        if (isa <= detectIsa()) list.push_back(isa);
    return list;
}

DisplaySettings manual(float low, float high) {
    DisplaySettings settings;
    settings.autoRange = false;
    settings.low = low, settings.high = high;
    return settings;
}

/// Values from 2^-20 to 2^20, with a few exact ones.
Image wideImage(Extent2 extent) {
    Image image = noiseImage(extent, 3);
    for (size_t i = 0; i < image.size(); ++i) image.data()[i] = std::exp2(40 * image.data()[i] - 20);
    image.data()[0] = 0;
    return image;
}

TEST(Display, RowsAgreeWithTheScalarCurves) {
    for (const Extent2 extent : {Extent2{257, 89}, Extent2{1, 1}, Extent2{3, 17}}) {
        const Image image = wideImage(extent);
        for (const ToneCurve curve : {ToneCurve::Clamp, ToneCurve::Reinhard, ToneCurve::Aces, ToneCurve::AgX})
            for (const float ev : {0.0f, -3.5f, 2.0f}) {
                DisplaySettings settings;
                settings.curve = curve;
                settings.exposureEv = ev;
                Image8 out;
                const DisplayInfo info = convert(image, "RGB", "none", settings, out);
                EXPECT_FALSE(info.falseColour);
                EXPECT_EQ(info.nonFinite, 0);
                int worst = 0;
                for (int y = 0; y < extent.height; ++y)
                    for (int x = 0; x < extent.width; ++x) {
                        const Vec3 linear(image.at(0, x, y), image.at(1, x, y), image.at(2, x, y));
                        const Vec3 wanted = srgbFromLinear(toneMap(linear * std::exp2(ev), curve));
                        for (int c = 0; c < 3; ++c)
                            worst = std::max(worst, levels(pixel(out, x, y)[static_cast<size_t>(c)], wanted[c]));
                    }
                EXPECT_LE(worst, 1) << "curve " << static_cast<int>(curve) << " at " << ev << " EV";
            }
    }
}

TEST(Display, SrgbEncodingIsWithinHalfALevelOfExact) {
    std::vector<float> linear, encoded;
    for (int i = 0; i <= 200000; ++i) linear.push_back(static_cast<float>(i) / 200000.0f);
    for (int i = 0; i < 2000; ++i) linear.push_back(0.0031308f + 1e-6f * static_cast<float>(i - 1000));
    encoded.resize(linear.size());
    for (const Isa isa : machineIsas()) {
        setIsa(isa);
        displayKernels().encodeSrgb(linear.data(), static_cast<int>(linear.size()), encoded.data());
        double worst = 0;
        for (size_t i = 0; i < linear.size(); ++i) {
            const double x = linear[i];
            const double exact = x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055;
            worst = std::max(worst, std::abs(encoded[i] - exact));
        }
        EXPECT_LT(worst, 0.01 / 255) << isaName(isa);
        EXPECT_EQ(encoded[0], 0);
        EXPECT_NEAR(encoded[200000], 1, 1e-5);
    }
    setIsa(detectIsa());
}

TEST(Display, EightBitColoursSurviveTheRoundTrip) {
    Image image({256, 1}, 3);
    for (int c = 0; c < 3; ++c)
        for (int x = 0; x < 256; ++x) image.at(c, x, 0) = linearFromSrgbTable()[x];
    DisplaySettings settings;
    settings.curve = ToneCurve::Clamp;
    Image8 out;
    convert(image, "RGB", "none", settings, out);
    for (int x = 0; x < 256; ++x) EXPECT_EQ(pixel(out, x, 0)[1], x);
}

TEST(Display, InstructionSetsAndThreadsGiveTheSameBytes) {
    Image image = wideImage({257, 89});
    image.at(1, 5, 5) = kNan;
    const std::pair<const char*, const char*> kinds[] = {{"RGB", "none"},   {"RGB", "viridis"}, {"XYZ", "none"},
                                                         {"XYZ", "signed"}, {"XYZ", "wheel"},   {"XYZ", "cyclic"},
                                                         {"XYZ", "motion"}};
    for (const auto& [channels, map] : kinds)
        for (int curve = 0; curve < 4; ++curve) {
            DisplaySettings settings;
            settings.curve = static_cast<ToneCurve>(curve);
            std::vector<Image8> outs;
            for (const Isa isa : machineIsas())
                for (const int threads : {1, 3}) {
                    setIsa(isa);
                    setThreadCount(threads);
                    convert(image, channels, map, settings, outs.emplace_back());
                }
            for (const Image8& out : outs) EXPECT_EQ(out.rgba, outs.front().rgba) << channels << ' ' << map;
        }
    setThreadCount(0);
    setIsa(detectIsa());
}

TEST(Display, NanIsMagentaAndInfinityCyan) {
    Image image({4, 1}, 3);
    image.at(0, 1, 0) = kNan;
    image.at(1, 1, 0) = kInfinity;
    image.at(2, 2, 0) = kInfinity;
    image.at(2, 3, 0) = -kInfinity;
    for (const auto& [channels, map] :
         {std::pair("RGB", "none"), std::pair("RGB", "magma"), std::pair("XYZ", "none"), std::pair("XYZ", "turbo")}) {
        Image8 out;
        const DisplayInfo info = convert(image, channels, map, {}, out);
        EXPECT_EQ(info.nonFinite, 3) << map;
        EXPECT_EQ(pixel(out, 1, 0), kMagenta) << channels << map;
        EXPECT_EQ(pixel(out, 2, 0), kCyan) << channels << map;
        EXPECT_NE(pixel(out, 0, 0), kMagenta);
    }
    Image8 out;
    convert(image, "XYZ", "wheel", {}, out);
    EXPECT_EQ(pixel(out, 1, 0), kMagenta);
}

/// A code keeps its colour whatever else is in the picture.
TEST(Display, ABuffersOwnRangeIsTheAutomaticOne) {
    Image few({2, 1}, 1), many({2, 1}, 1);
    few.at(0, 0, 0) = many.at(0, 0, 0) = 2;
    few.at(0, 1, 0) = 3;
    many.at(0, 1, 0) = 19;
    Image8 a, b;
    const DisplayInfo info = convert(few, "Y", "turbo", {}, a, ValueRange{0, 20});
    convert(many, "Y", "turbo", {}, b, ValueRange{0, 20});
    EXPECT_EQ(info.high, 20);
    EXPECT_EQ(pixel(a, 0, 0), pixel(b, 0, 0));
    convert(few, "Y", "turbo", {}, a);
    convert(many, "Y", "turbo", {}, b);
    EXPECT_EQ(pixel(a, 0, 0), pixel(b, 0, 0)) << "both are the least";
    EXPECT_EQ(convert(few, "Y", "turbo", manual(0, 4), a, ValueRange{0, 20}).high, 4) << "the user's own";
}

TEST(Display, TheSkysDepthIsBlackAndNotCounted) {
    Image depth({5, 1}, 1);
    for (int x = 0; x < 3; ++x) depth.at(0, x, 0) = static_cast<float>(x + 1);
    depth.at(0, 3, 0) = kInfinity;
    depth.at(0, 4, 0) = kNan;
    Image8 out;
    const DisplayInfo info = convert(depth, "Z", "viridis", {}, out);
    EXPECT_EQ(pixel(out, 3, 0), kBlack);
    EXPECT_EQ(pixel(out, 4, 0), kMagenta);
    EXPECT_EQ(info.nonFinite, 1);
    EXPECT_EQ(info.low, 1);
    EXPECT_EQ(info.high, 3);
    convert(depth, "Y", "viridis", {}, out);
    EXPECT_EQ(pixel(out, 3, 0), kCyan);
}

TEST(Display, ManualRangeReachesTheMapsEnds) {
    Image image({4, 1}, 1);
    for (int x = 0; x < 4; ++x) image.at(0, x, 0) = std::vector<float>{-5, 2, 6, 99}[static_cast<size_t>(x)];
    Image8 out;
    const DisplayInfo info = convert(image, "Y", "magma", manual(2, 6), out);
    EXPECT_TRUE(info.falseColour);
    EXPECT_EQ(info.colourMap, "magma");
    EXPECT_EQ(pixel(out, 0, 0), pixel(out, 1, 0));
    EXPECT_EQ(pixel(out, 2, 0), pixel(out, 3, 0));
    for (int c = 0; c < 3; ++c) {
        EXPECT_LE(levels(pixel(out, 0, 0)[static_cast<size_t>(c)], colourMapValue("magma", 0)[c]), 0);
        EXPECT_LE(levels(pixel(out, 3, 0)[static_cast<size_t>(c)], colourMapValue("magma", 1)[c]), 0);
    }
}

TEST(Display, EveryMapShowsItsOwnColoursAndCyclicOnesWrap) {
    const Extent2 extent{257, 1};
    Image image(extent, 1);
    for (int x = 0; x < extent.width; ++x) image.at(0, x, 0) = static_cast<float>(x) / 256;
    for (const char* map : {"viridis", "turbo", "magma", "gray", "signed", "cyclic"}) {
        Image8 out;
        convert(image, "Y", map, manual(0, 1), out);
        for (int x = 0; x < extent.width; ++x)
            for (size_t c = 0; c < 3; ++c) {
                const Vec3 wanted = colourMapValue(map, image.at(0, x, 0));
                EXPECT_LE(levels(pixel(out, x, 0)[c], wanted[static_cast<int>(c)]), 2) << map << ' ' << x;
            }
    }
    Image8 out, shifted;
    convert(image, "Y", "cyclic", manual(0, 1), out);
    for (int x = 0; x < extent.width; ++x) image.at(0, x, 0) -= 3;
    convert(image, "Y", "cyclic", manual(0, 1), shifted);
    EXPECT_EQ(out.rgba, shifted.rgba);
}

TEST(Display, AutomaticRangeIsThePercentilesOfFiniteValues) {
    Image image({1000, 101}, 1);
    for (int y = 0; y < 101; ++y)
        for (int x = 0; x < 1000; ++x) image.at(0, x, y) = static_cast<float>(y) / 100;
    image.at(0, 0, 0) = kNan, image.at(0, 1, 0) = 1e30f, image.at(0, 2, 0) = -kInfinity;
    Image8 out;
    const DisplayInfo info = convert(image, "Y", "viridis", {}, out);
    EXPECT_NEAR(info.low, 0.01f, 0.011f);
    EXPECT_NEAR(info.high, 0.99f, 0.011f);
    // Symmetric for signed maps; open ranges for constants.
    EXPECT_EQ(convert(image, "Y", "signed", {}, out).low, -convert(image, "Y", "signed", {}, out).high);
    Image constant({3, 3}, 1);
    constant.fill(7);
    EXPECT_EQ(convert(constant, "Y", "viridis", {}, out).high, 7);
    constant.fill(kNan);
    EXPECT_EQ(convert(constant, "Y", "viridis", {}, out).nonFinite, 9);
}

TEST(Display, UnitVectorsShowAsHalfPlusHalf) {
    Image normal({2, 1}, 3);
    normal.at(1, 0, 0) = 1;
    normal.at(2, 1, 0) = -1;
    Image8 out;
    convert(normal, "XYZ", "none", {}, out);
    EXPECT_EQ(pixel(out, 0, 0), (std::vector<uint8_t>{128, 255, 128, 255}));
    EXPECT_EQ(pixel(out, 1, 0), (std::vector<uint8_t>{128, 128, 0, 255}));
    // Positions go far beyond 1: the range follows.
    for (size_t i = 0; i < normal.size(); ++i) normal.data()[i] = 10 * static_cast<float>(i);
    const DisplayInfo info = convert(normal, "XYZ", "none", {}, out);
    EXPECT_GT(info.high, 1);
}

TEST(Display, WheelShowsDirectionAsHue) {
    Image motion({5, 1}, 3);
    motion.at(0, 1, 0) = 4, motion.at(0, 2, 0) = -4, motion.at(1, 3, 0) = 4, motion.at(1, 4, 0) = -4;
    Image8 out;
    convert(motion, "XYZ", "wheel", manual(0, 4), out);
    EXPECT_EQ(pixel(out, 0, 0), kBlack);
    EXPECT_EQ(pixel(out, 1, 0), (std::vector<uint8_t>{255, 64, 64, 255}));
    EXPECT_EQ(pixel(out, 2, 0)[0], 0);
    EXPECT_NE(pixel(out, 3, 0), pixel(out, 4, 0));
}

// Rounding of projections is 1e-4 px at most; the wheel that fits itself does not blow it up into a picture.
TEST(Display, WheelLeavesWhatStandsBlack) {
    Image motion({8, 8}, 3);
    for (size_t i = 0; i < motion.size(); ++i) motion.data()[i] = i % 3 == 0 ? 1e-4f : -3e-5f;
    Image8 out;
    EXPECT_EQ(convert(motion, "XYZ", "motion", {}, out).high, 1);
    EXPECT_EQ(pixel(out, 4, 4), kBlack);
    motion.at(0, 4, 4) = motion.at(0, 3, 3) = 2;
    EXPECT_GT(convert(motion, "XYZ", "motion", {}, out).high, 0.5f);
}

// What is no motion has no least length: the gradients of reciprocal depth are 1e-3.
TEST(Display, WheelFitsWhateverIsNoMotion) {
    Image gradient({8, 8}, 2);
    for (size_t i = 0; i < gradient.size(); ++i) gradient.data()[i] = 1e-3f;
    Image8 out;
    EXPECT_NEAR(convert(gradient, "XY", "wheel", {}, out).high, 1.4142e-3f, 1e-6f);
    EXPECT_NE(pixel(out, 4, 4), kBlack);
}

TEST(Display, ChannelsAloneAreGreyOrMapped) {
    Image image = noiseImage({8, 8}, 3);
    DisplaySettings settings;
    settings.channel = 1;
    settings.curve = ToneCurve::Clamp;
    Image8 out;
    convert(image, "RGB", "none", settings, out);
    const std::vector<uint8_t> grey = pixel(out, 3, 3);
    EXPECT_EQ(grey[0], grey[1]);
    EXPECT_LE(levels(grey[2], srgbFromLinear(image.at(1, 3, 3))), 1);
    EXPECT_EQ(convert(image, "XYZ", "none", settings, out).colourMap, "signed");
    settings.channel = 3;  // beyond the buffer: its last
    convert(image, "RGB", "none", settings, out);
    EXPECT_LE(levels(pixel(out, 3, 3)[0], srgbFromLinear(image.at(2, 3, 3))), 1);
}

TEST(Display, IdsAreSeparatedAndZeroIsBlack) {
    IdImage ids({300, 1}, 1);
    for (int x = 0; x < 300; ++x) ids.at(0, x, 0) = static_cast<uint32_t>(x);
    ids.at(0, 299, 0) = 0xffffffffu;
    Image8 out;
    EXPECT_EQ(convert(ids, {}, out).colourMap, "ids");
    EXPECT_EQ(pixel(out, 0, 0), kBlack);
    for (int x = 1; x < 40; ++x) {
        const auto a = pixel(out, x, 0), b = pixel(out, x + 1, 0);
        int distance = 0;
        for (size_t c = 0; c < 3; ++c) distance += std::abs(a[c] - b[c]);
        EXPECT_GT(distance, 60) << x;
        EXPECT_GT(a[0] + a[1] + a[2], 100) << x;
    }
}

TEST(Display, EmptyImagesGiveEmptyPictures) {
    Image8 out = test::noiseImage8({2, 2});
    convert(Image(), "RGB", "none", {}, out);
    EXPECT_TRUE(out.rgba.empty());
    convert(IdImage(), {}, out);
    EXPECT_TRUE(out.extent.empty());
}

TEST(Display, AFrameTakesMilliseconds) {
    const Image image = wideImage({1280, 720});
    setThreadCount(1);
    Image8 out;
    for (const ToneCurve curve : {ToneCurve::Aces, ToneCurve::AgX}) {
        DisplaySettings settings;
        settings.curve = curve;
        double best = 1e9;
        for (int round = 0; round < 8; ++round) {
            const Timer timer;
            convert(image, "RGB", "none", settings, out);
            best = std::min(best, timer.elapsedMs());
        }
        std::cout << "1280x720, " << (curve == ToneCurve::Aces ? "ACES" : "AgX") << ", one thread, "
                  << isaName(activeIsa()) << ": " << best << " ms\n";
        // The budget is 8 ms; the bound leaves room for sanitizers and busy machines.
        EXPECT_LT(best, 200);
    }
    setThreadCount(0);
}

}  // namespace
}  // namespace lumi
