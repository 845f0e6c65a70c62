// The rows that vector code works on: the same bytes on every instruction set, and what single pixels say.
#include <gtest/gtest.h>

#include <cmath>

#include "base/isa.h"
#include "filter/demodulation.h"
#include "filter/taa.h"
#include "filter/temporal.h"
#include "support/random_planes.h"

namespace lumi::test {
namespace {

constexpr Extent2 kExtent{157, 23};

/// A floor of three objects that turns a little, with sky, thin things and numbers that are none.
Signals movingFrame(uint32_t seed) {
    Random random(seed);
    Signals signals;
    signals.reset(kExtent, SignalSet::all(), 1);
    for (int y = 0; y < kExtent.height; ++y)
        for (int x = 0; x < kExtent.width; ++x) {
            const bool sky = y < 2;
            const float z = sky ? 0 : 0.2f + 0.001f * static_cast<float>(x) + 0.01f * static_cast<float>(y);
            const auto set = [&](Signal signal, int c, float value) { signals[signal].at(c, x, y) = value; };
            set(Signal::InverseDepth, 0, z);
            set(Signal::Depth, 0, sky ? kInfinity : 1 / z);
            set(Signal::DepthGradient, 0, sky ? 0 : 0.001f);
            set(Signal::DepthGradient, 1, sky ? 0 : 0.01f);
            // Smooth motion on the left, any on the right.
            const float shift = x < 100 ? 1.25f + 0.002f * static_cast<float>(x) : random.between(-9, 9);
            set(Signal::Motion, 0, shift);
            set(Signal::Motion, 1, x < 100 ? -0.4f : random.between(-3, 3));
            for (int c = 0; c < 3; ++c) {
                set(Signal::ObjectNormal, c, sky ? 0 : c == 2 ? 1.0f : 0.0f);
                set(Signal::Albedo, c, random.between(0.02f, 1));
                set(Signal::SpecularAlbedo, c, random.between(0, 1) < 0.1f ? 1.0f : 0.04f);
                set(Signal::Direct, c, random.between(0, 4));
                set(Signal::Indirect, c, random.between(0, 1));
                set(Signal::Emission, c, 0);
            }
            signals.ids(Signal::ObjectId).at(0, x, y) = sky ? 0 : random.between(0, 1) < 0.1f ? 2 : x < 120 ? 1 : 3;
        }
    signals[Signal::Direct].at(1, 40, 9) = std::nanf("");
    signals[Signal::Motion].at(0, 50, 9) = std::nanf("");
    signals[Signal::Motion].at(1, 51, 9) = kInfinity;
    return signals;
}

struct Results {
    DemodulatedFrame frame;
    TemporalHistory history;
    Image antialiased;
};

Results run(const Signals& first, const Signals& second) {
    Results results;
    TemporalHistory before;
    Image scratch, early, next, unused;
    demodulate(first, results.frame);
    EXPECT_TRUE(filterTemporally(first, {}, {&results.frame.direct, &results.frame.indirect}, nullptr, before, {}));
    EXPECT_TRUE(antialiasTemporally(first, {}, 1, results.frame.direct, nullptr, scratch, early, unused, {}));
    demodulate(second, results.frame);
    EXPECT_TRUE(
        filterTemporally(second, {}, {&results.frame.direct, &results.frame.indirect}, &before, results.history, {}));
    EXPECT_TRUE(
        antialiasTemporally(second, {}, 1, results.frame.direct, &early, scratch, next, results.antialiased, {}));
    return results;
}

TEST(FilterRows, AreTheSameBytesOnEveryInstructionSet) {
    const Signals first = movingFrame(1), second = movingFrame(2);
    const Isa best = detectIsa();
    setIsa(Isa::Baseline);
    const Results expected = run(first, second);
    for (const Isa isa : {Isa::V3, Isa::V4}) {
        if (isa > best) continue;
        setIsa(isa);
        const Results results = run(first, second);
        EXPECT_EQ(results.frame.direct, expected.frame.direct) << isaName(isa);
        EXPECT_EQ(results.frame.dropped, expected.frame.dropped) << isaName(isa);
        EXPECT_EQ(results.history.length, expected.history.length) << isaName(isa);
        for (size_t c = 0; c < 2; ++c) {
            EXPECT_EQ(results.history.components[c].colour, expected.history.components[c].colour) << isaName(isa);
            EXPECT_EQ(results.history.components[c].sampleVariance, expected.history.components[c].sampleVariance)
                << isaName(isa);
        }
        EXPECT_EQ(results.antialiased, expected.antialiased) << isaName(isa);
    }
    setIsa(best);
    EXPECT_EQ(expected.frame.droppedPixels, 1);
}

// Stretches of pixels whose taps follow each other are read in another way than single ones.
TEST(FilterRows, IntegrateWhatSinglePixelsTapsSay) {
    const Signals first = movingFrame(3), second = movingFrame(4);
    DemodulatedFrame frame;
    TemporalHistory before, after;
    const TemporalSettings settings;
    demodulate(first, frame);
    ASSERT_TRUE(filterTemporally(first, settings, {&frame.direct}, nullptr, before, {}));
    demodulate(second, frame);
    ASSERT_TRUE(filterTemporally(second, settings, {&frame.direct}, &before, after, {}));
    const Reprojection reprojection(second, before.surface, settings.reprojection);
    int kept = 0, wide = 0, lost = 0;
    for (int y = 0; y < kExtent.height; ++y)
        for (int x = 0; x < kExtent.width; ++x) {
            const ReprojectedTaps taps = reprojection.taps(x, y);
            float past = 0, sum = 0;
            for (size_t k = 0; k < static_cast<size_t>(taps.count); ++k) {
                past += taps.weight[k] * before.components[0].colour.data()[taps.index[k]];
                sum += taps.weight[k];
            }
            EXPECT_NEAR(sum, taps.count > 0 ? 1 : 0, 1e-6);
            const float sample = frame.direct.at(0, x, y), alpha = taps.count > 0 ? settings.colourAlpha : 1.0f;
            ASSERT_NEAR(after.components[0].colour.at(0, x, y), past + alpha * (sample - past), 1e-4f) << x << ' ' << y;
            const bool sky = second.ids(Signal::ObjectId).at(0, x, y) == 0;
            ASSERT_NEAR(after.length.at(0, x, y), sky ? 0.0f : taps.count > 0 ? 2.0f : 1.0f, 1e-5f) << x << ' ' << y;
            ++(taps.wide ? wide : taps.count > 0 ? kept : lost);
        }
    EXPECT_GT(kept, 1000);
    EXPECT_GT(wide, 10);
    EXPECT_GT(lost, 100);
}

// What is given up of the history (adaptive alpha) makes room for the new sample.
TEST(FilterRows, HistoryCanBeGivenUp) {
    Signals still = movingFrame(5);
    still[Signal::Motion].fill(0);
    DemodulatedFrame frame;
    demodulate(still, frame);
    TemporalHistory before, after;
    Image old(kExtent, 3), loss(kExtent, 1);
    old.fill(1);
    for (int64_t i = 0; i < kExtent.area(); ++i) loss.data()[i] = static_cast<float>(i % 3) * 0.5f;
    TemporalSettings settings;
    settings.colourAlpha = 0.1f;
    ASSERT_TRUE(filterTemporally(still, settings, {&old}, nullptr, before, {}));
    Image now(kExtent, 3);
    now.fill(3);
    ASSERT_TRUE(filterTemporally(still, settings, {&now}, &before, after, {}, {.loss = {&loss}}));
    for (int x = 0; x < kExtent.width; ++x) {
        const float lambda = loss.at(0, x, 12), alpha = 0.1f + 0.9f * lambda;
        ASSERT_NEAR(after.components[0].colour.at(1, x, 12), 1 + 2 * alpha, 1e-5);
        ASSERT_NEAR(after.length.at(0, x, 12), 2 - lambda, 1e-5);
    }
}

}  // namespace
}  // namespace lumi::test
