// Reprojection and temporal integration [Schied17, sec. 4.1, 4.2] against closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "filter/taa.h"
#include "filter/temporal.h"
#include "frame/history.h"
#include "support/random_planes.h"

namespace lumi::test {
namespace {

constexpr Extent2 kExtent{24, 16};

/// A wall two metres away that has moved by `motion` pixels, all of one object.
Signals wall(Vec2 motion = Vec2(0)) {
    Signals signals;
    signals.reset(kExtent, SignalSet::all(), 1);
    signals[Signal::Depth].fill(2);
    signals[Signal::InverseDepth].fill(0.5f);
    signals[Signal::DepthGradient].fill(0);
    signals[Signal::ObjectNormal].fill(0);
    signals[Signal::Motion].fill(0);
    signals.ids(Signal::ObjectId).fill(1);
    for (int64_t i = 0; i < kExtent.area(); ++i) {
        signals[Signal::ObjectNormal].plane(2).data[i] = 1;
        signals[Signal::Motion].plane(0).data[i] = motion.x;
        signals[Signal::Motion].plane(1).data[i] = motion.y;
    }
    return signals;
}

ReprojectedTaps tapsAt(const Signals& signals, const Signals& before, int x, int y,
                       ReprojectionSettings settings = {}) {
    SurfaceRecord record;
    record.reset(before.extent());
    record.copyRows(before, 0, before.extent().height);
    return Reprojection(signals, record, settings).taps(x, y);
}

TEST(Reprojection, TapsAreBilinear) {
    const Signals signals = wall({-1.75f, 0.5f});
    const ReprojectedTaps taps = tapsAt(signals, wall(), 10, 5);
    ASSERT_EQ(taps.count, 4);
    EXPECT_EQ(taps.index[0], 5 * kExtent.width + 8);
    const float expected[4] = {0.375f, 0.125f, 0.375f, 0.125f};
    for (size_t k = 0; k < 4; ++k) EXPECT_FLOAT_EQ(taps.weight[k], expected[k]);
    EXPECT_EQ(verdictValue(taps, false), 1);
}

// PAPER: "its weight is uniformly redistributed over consistent taps", which renormalising is not.
TEST(Reprojection, ARefusedTapsWeightIsSpreadUniformly) {
    const Signals signals = wall({0.25f, 0.25f});
    Signals before = wall();
    before.ids(Signal::ObjectId).at(0, 11, 6) = 7;
    const ReprojectedTaps taps = tapsAt(signals, before, 10, 5);
    ASSERT_EQ(taps.count, 3);
    const float lost = 0.0625f / 3;
    EXPECT_FLOAT_EQ(taps.weight[0], 0.5625f + lost);
    EXPECT_FLOAT_EQ(taps.weight[1], 0.1875f + lost);
    EXPECT_FLOAT_EQ(taps.weight[2], 0.1875f + lost);
    EXPECT_EQ(taps.refusals[3], kTapOtherObject);
    EXPECT_EQ(verdictValue(taps, false), 2);
}

TEST(Reprojection, EachTestRefuses) {
    const Signals signals = wall();
    const auto refusalOf = [&](const Signals& before) {
        const ReprojectedTaps taps = tapsAt(signals, before, 4, 4, {.wideFallback = false});
        EXPECT_EQ(taps.count, taps.refusals[0] == kTapKept ? 1 : 0);
        return taps.refusals[0];
    };
    Signals deeper = wall(), turned = wall(), bad = wall();
    deeper[Signal::InverseDepth].at(0, 4, 4) = 0.6f;
    turned[Signal::ObjectNormal].at(2, 4, 4) = std::cos(radians(40.0f));
    turned[Signal::ObjectNormal].at(0, 4, 4) = std::sin(radians(40.0f));
    bad[Signal::InverseDepth].at(0, 4, 4) = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(refusalOf(wall()), kTapKept);
    EXPECT_EQ(refusalOf(deeper), kTapDepth);
    EXPECT_EQ(refusalOf(turned), kTapNormal);
    EXPECT_EQ(refusalOf(bad), kTapDepth);
    const ReprojectedTaps outside = tapsAt(wall({-30, 0}), wall(), 4, 4);
    EXPECT_EQ(outside.count, 0);
    EXPECT_EQ(verdictValue(outside, false), 4.0f + float(kTapOffScreen));
}

TEST(Reprojection, MasksTellWhichTapsWereRefusedAndWhy) {
    const Signals signals = wall({0.25f, 0.25f});
    Signals before = wall();
    before.ids(Signal::ObjectId).at(0, 11, 6) = 7;
    before[Signal::InverseDepth].at(0, 10, 5) = before[Signal::InverseDepth].at(0, 11, 6) = 0.6f;
    EXPECT_EQ(refusalMasks(tapsAt(signals, before, 10, 5).refusals), (std::array<float, 4>{8, 1 + 8, 0, 0}));
    EXPECT_EQ(refusalMasks(tapsAt(wall({-0.5f, 0}), wall(), 0, 5).refusals), (std::array<float, 4>{0, 0, 0, 1}))
        << "those below have no weight";
}

TEST(Reprojection, TheWideFallbackFindsThinGeometry) {
    const Signals signals = wall();
    Signals before = wall();
    before.ids(Signal::ObjectId).fill(2);
    before.ids(Signal::ObjectId).at(0, 5, 3) = 1;
    const ReprojectedTaps taps = tapsAt(signals, before, 4, 4);
    ASSERT_EQ(taps.count, 1);
    EXPECT_TRUE(taps.wide);
    EXPECT_EQ(taps.index[0], 3 * kExtent.width + 5);
    EXPECT_EQ(taps.weight[0], 1);
    EXPECT_EQ(tapsAt(signals, before, 4, 4, {.wideFallback = false}).count, 0);
}

// A surface that comes closer is the same surface: its motion vector says by how much.
TEST(Reprojection, DepthFollowsTheMotionVector) {
    Signals signals = wall();
    signals[Signal::Depth].fill(1);
    signals[Signal::InverseDepth].fill(1);
    signals[Signal::Motion].plane(2).data[4 * kExtent.width + 4] = 1;
    EXPECT_EQ(tapsAt(signals, wall(), 4, 4, {.wideFallback = false}).count, 1);
    EXPECT_EQ(tapsAt(signals, wall(), 5, 4, {.wideFallback = false}).count, 0);
}

// Exponential averages in closed form: colour, mean and variance of a known sequence.
TEST(TemporalFilter, IntegratesColourAndMoments) {
    const TemporalSettings settings{.colourAlpha = 0.25f, .momentsAlpha = 0.5f, .reprojection = {}};
    const Signals signals = wall();
    FrameHistory<TemporalHistory> history;
    double colour = 0, first = 0, second = 0;
    Random random(3);
    for (int frame = 0; frame < 12; ++frame) {
        const float value = random.between(0, 3);
        Image sample(kExtent, 3);
        sample.fill(value);
        auto [previous, next] = history.begin(frame, frame == 0);
        ASSERT_TRUE(filterTemporally(signals, settings, {&sample}, previous, next, {}));
        history.commit();
        colour = frame == 0 ? value : colour + 0.25 * (value - colour);
        first = frame == 0 ? value : 0.5 * value + 0.5 * first;
        second = frame == 0 ? double(value) * value : 0.5 * value * value + 0.5 * second;
        const TemporalComponent& result = history.current().components[0];
        EXPECT_NEAR(result.colour.at(1, 7, 7), colour, 1e-5);
        EXPECT_NEAR(result.mean.at(0, 7, 7), first, 1e-5);
        EXPECT_NEAR(result.sampleVariance.at(0, 7, 7), second - first * first, 2e-5);
        EXPECT_EQ(history.current().length.at(0, 7, 7), static_cast<float>(frame + 1));
    }
}

/// What is no measurement counts nothing, and is not counted; without a history it is all there is.
TEST(TemporalFilter, ADroppedSampleLeavesTheHistoryAsItIs) {
    const Signals signals = wall();
    FrameHistory<TemporalHistory> history;
    Image sample(kExtent, 3), dropped(kExtent, 1);
    dropped.at(0, 7, 7) = 1;
    for (int frame = 0; frame < 3; ++frame) {
        sample.fill(static_cast<float>(frame + 1));
        auto [previous, next] = history.begin(frame, frame == 0);
        ASSERT_TRUE(
            filterTemporally(signals, {}, {&sample}, previous, next, {}, {.dropped = frame == 1 ? nullptr : &dropped}));
        history.commit();
        const TemporalHistory& now = history.current();
        const float colour = now.components[0].colour.at(0, 7, 7), beside = now.components[0].colour.at(0, 8, 7);
        if (frame < 2) {
            EXPECT_EQ(colour, beside);
            continue;
        }
        EXPECT_FLOAT_EQ(colour, 1.2f);
        EXPECT_FLOAT_EQ(beside, 1.2f + 0.2f * 1.8f);
        EXPECT_FLOAT_EQ(now.components[0].mean.at(0, 7, 7), 1.2f);
        EXPECT_EQ(now.length.at(0, 7, 7), 2);
        EXPECT_EQ(now.length.at(0, 8, 7), 3);
    }
}

TEST(TemporalFilter, WarmUpIsTheArithmeticMean) {
    const TemporalSettings settings{
        .colourAlpha = 0.01f, .momentsAlpha = 0.01f, .arithmeticWarmUp = true, .reprojection = {}};
    const Signals signals = wall();
    FrameHistory<TemporalHistory> history;
    double sum = 0;
    for (int frame = 0; frame < 9; ++frame) {
        Image sample(kExtent, 3);
        sample.fill(static_cast<float>(frame * frame));
        auto [previous, next] = history.begin(frame, frame == 0);
        ASSERT_TRUE(filterTemporally(signals, settings, {&sample}, previous, next, {}));
        history.commit();
        sum += frame * frame;
        EXPECT_NEAR(history.current().components[0].colour.at(0, 3, 3), sum / (frame + 1), 1e-4);
    }
}

TEST(FrameHistory, IsATransaction) {
    FrameHistory<int> history;
    const auto commit = [&](int64_t frame, int value) {
        auto step = history.begin(frame, false);
        step.next = value;
        history.commit();
        return step.previous ? *step.previous : -1;
    };
    EXPECT_EQ(history.begin(0, false).previous, nullptr);
    EXPECT_EQ(commit(0, 10), -1);
    EXPECT_EQ(commit(1, 11), 10);
    EXPECT_EQ(commit(1, 12), 10);       // the same number again: from the same history
    history.begin(1, false).next = 99;  // begun and left
    history.begin(2, false).next = 98;
    EXPECT_EQ(history.current(), 12);
    EXPECT_EQ(commit(2, 13), 12);
    EXPECT_EQ(history.previous(), 12);
    EXPECT_EQ(history.begin(3, true).previous, nullptr);
}

// A still, constant picture passes; a history outside the neighbourhood's colours is clipped to them.
TEST(Taa, PassesWhatIsStillAndClipsWhatIsStale) {
    const Signals signals = wall();
    Image colour(kExtent, 3), scratch, next, out;
    colour.fill(0.7f);
    Image stale(kExtent, 3);
    stale.fill(0);
    for (int64_t i = 0; i < kExtent.area(); ++i) stale.data()[i] = 0.9f;  // compressed luma of radiance 9
    ASSERT_TRUE(antialiasTemporally(signals, {}, 1, colour, &stale, scratch, next, out, {}));
    EXPECT_NEAR(out.at(1, 9, 9), 0.7f, 1e-5);
    TaaSettings unclipped;
    unclipped.clip = false;
    ASSERT_TRUE(antialiasTemporally(signals, unclipped, 1, colour, &stale, scratch, next, out, {}));
    EXPECT_GT(out.at(1, 9, 9), 3);
}

// Lights a thousand times as strong at a thousandth of the exposure are the same picture.
TEST(Taa, TheUnitOfRadianceIsNothingToIt) {
    const Signals signals = wall({0.25f, 0});
    Image colour(kExtent, 3), scaled(kExtent, 3);
    for (size_t i = 0; i < colour.size(); ++i) {
        colour.data()[i] = 0.1f + 3 * static_cast<float>(i % 7);
        scaled.data()[i] = 1024 * colour.data()[i];
    }
    Image scratch, early, earlyScaled, next, nextScaled, out, outScaled;
    ASSERT_TRUE(antialiasTemporally(signals, {}, 2, colour, nullptr, scratch, early, out, {}));
    ASSERT_TRUE(antialiasTemporally(signals, {}, 0x1p-9f, scaled, nullptr, scratch, earlyScaled, outScaled, {}));
    ASSERT_TRUE(antialiasTemporally(signals, {}, 2, colour, &early, scratch, next, out, {}));
    ASSERT_TRUE(antialiasTemporally(signals, {}, 0x1p-9f, scaled, &earlyScaled, scratch, nextScaled, outScaled, {}));
    for (size_t i = 0; i < out.size(); ++i) ASSERT_EQ(outScaled.data()[i], 1024 * out.data()[i]);
}

// Catmull-Rom reproduces a quadratic's slope: a ramp shifted by half a pixel stays a ramp.
TEST(Taa, HistoryIsReadBetweenPixels) {
    for (const TaaSettings::History filter : {TaaSettings::History::Bilinear, TaaSettings::History::CatmullRom}) {
        const Signals signals = wall({0.5f, 0});
        Image colour(kExtent, 3), history(kExtent, 3), scratch, next, out;
        for (int64_t i = 0; i < kExtent.area(); ++i) history.data()[i] = 0.01f * static_cast<float>(i % kExtent.width);
        const TaaSettings settings{.alpha = 0.01f, .clip = false, .history = filter};
        ASSERT_TRUE(antialiasTemporally(signals, settings, 1, colour, &history, scratch, next, out, {}));
        EXPECT_NEAR(next.at(0, 10, 8), 0.99f * 0.105f, 1e-5);
    }
}

}  // namespace
}  // namespace lumi::test
