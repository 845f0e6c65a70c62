// What light is divided by before it is filtered, and that multiplying gives it back.
#include "filter/demodulation.h"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "frame/stored_albedo.h"

namespace lumi::test {
namespace {

struct Lobes {
    float diffuse, specular;
};

/// A row of pixels under equal light, as the signals store them: a pixel a pair of albedos.
Signals rowOf(const std::vector<Lobes>& pixels, float light) {
    Signals signals;
    signals.reset({static_cast<int>(pixels.size()), 1}, demodulationSignals(), 1);
    for (int x = 0; x < signals.extent().width; ++x)
        for (int c = 0; c < 3; ++c) {
            const Lobes& lobes = pixels[static_cast<size_t>(x)];
            signals[Signal::Albedo].at(c, x, 0) = storedAlbedo(lobes.diffuse);
            signals[Signal::SpecularAlbedo].at(c, x, 0) = storedAlbedo(lobes.specular);
            signals[Signal::Direct].at(c, x, 0) = (lobes.diffuse + lobes.specular) * light;
            signals[Signal::Indirect].at(c, x, 0) = 0.5f * (lobes.diffuse + lobes.specular) * light;
            signals[Signal::Emission].at(c, x, 0) = 0;
        }
    return signals;
}

/// Light that a filter spreads from pixel to pixel must not jump by more than a factor of two where a dark texture or
/// metal passes the albedo below which the signals store it undivided.
TEST(Demodulation, GivesTheLightWhateverTheAlbedo) {
    const std::vector<Lobes> lit{{0, 0.0101f}, {0.0101f, 0}, {0.0101f, 0.0101f}, {0.5f, 0.04f},
                                 {1, 0},       {0, 1},       {0.3f, 0},          {0.96f, 0.04f}};
    DemodulatedFrame frame;
    demodulate(rowOf(lit, 2), frame);
    for (int x = 0; x < frame.direct.width(); ++x) {
        EXPECT_NEAR(frame.direct.at(1, x, 0), 2, 1e-5) << x;
        EXPECT_NEAR(frame.indirect.at(1, x, 0), 1, 1e-5) << x;
    }
    const std::vector<Lobes> dark{{0, 0.0099f}, {0.0099f, 0}, {0.0099f, 0.0099f}, {0.0099f, 0.0101f}, {0.006f, 0.003f}};
    demodulate(rowOf(dark, 2), frame);
    for (int x = 0; x < frame.direct.width(); ++x) {
        EXPECT_GT(frame.direct.at(1, x, 0), 1.5f) << x;
        EXPECT_LT(frame.direct.at(1, x, 0), 4.01f) << x;
    }
}

/// The neighbours that see a surface and were not dropped themselves.
TEST(Demodulation, WhatWasDroppedIsFilledFromItsNeighbours) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    Signals signals = rowOf({{0.5f, 0}, {0.25f, 0}, {1, 0}, {0, 0}, {0.5f, 0}, {0.5f, 0}}, 2);
    signals[Signal::Direct].at(0, 1, 0) = nan;          // between 2 and 2
    signals[Signal::Direct].at(2, 0, 0) *= 3;           // of one neighbour the blue is 6
    signals[Signal::Indirect].at(1, 4, 0) = kInfinity;  // between the sky and 1
    signals[Signal::Emission].at(1, 5, 0) = nan;        // its light is a measurement
    DemodulatedFrame frame;
    demodulate(signals, frame);
    EXPECT_EQ(frame.droppedPixels, 3);
    fillDropped(signals, frame);
    EXPECT_FLOAT_EQ(frame.direct.at(0, 1, 0), 2);
    EXPECT_FLOAT_EQ(frame.direct.at(2, 1, 0), 4);
    EXPECT_FLOAT_EQ(frame.indirect.at(1, 1, 0), 1) << "this part was a number";
    EXPECT_FLOAT_EQ(frame.indirect.at(1, 4, 0), 0) << "one neighbour is sky, the other was dropped too";
    EXPECT_FLOAT_EQ(frame.direct.at(0, 5, 0), 2);
    EXPECT_EQ(frame.dropped.at(0, 1, 0), 1) << "it stays counted";
}

TEST(Demodulation, MultipliesToWhatItDivided) {
    const std::vector<Lobes> pixels{{0, 0}, {0, 0.0099f}, {0.005f, 0.5f}, {1, 0}, {0, 1}, {0.4f, 0.04f}};
    const Signals signals = rowOf(pixels, 3);
    DemodulatedFrame frame;
    Image out;
    demodulate(signals, frame);
    remodulate(frame, frame.direct, &frame.indirect, out);
    for (int x = 0; x < out.width(); ++x) {
        const Lobes& lobes = pixels[static_cast<size_t>(x)];
        EXPECT_NEAR(out.at(2, x, 0), 4.5f * (lobes.diffuse + lobes.specular), 1e-5) << x;
    }
}

}  // namespace
}  // namespace lumi::test
