// Metrics of consecutive frames against closed forms and plain definitions written here.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "base/error.h"
#include "math/colour.h"
#include "measure/lag.h"
#include "measure/temporal.h"

namespace lumi {
namespace {

constexpr Extent2 kExtent{40, 30};

Image noise(uint32_t seed, Extent2 extent = kExtent) {
    std::mt19937 generator(seed);
    std::uniform_real_distribution<float> uniform(0, 1);
    Image image(extent, 3);
    for (size_t i = 0; i < image.size(); ++i) image.data()[i] = uniform(generator);
    return image;
}

/// A smooth picture, seen by a camera that has moved by `shift` pixels.
Image picture(float shiftX, float shiftY) {
    Image image(kExtent, 3);
    for (int c = 0; c < 3; ++c)
        for (int y = 0; y < kExtent.height; ++y)
            for (int x = 0; x < kExtent.width; ++x)
                image.at(c, x, y) =
                    0.4f + 0.004f * (static_cast<float>(x) + shiftX) + 0.003f * (static_cast<float>(y) + shiftY);
    return image;
}

double shown(const Image& image, int x, int y) {
    const Vec3 c(image.at(0, x, y), image.at(1, x, y), image.at(2, x, y));
    return luminance(srgbFromLinear(glm::clamp(c, 0.0f, 1.0f)));
}

TEST(Temporal, IsTheMeanAbsoluteDifferenceOfLuminances) {
    const Image a = noise(1), b = noise(2);
    double sum = 0;
    for (int y = 0; y < kExtent.height; ++y)
        for (int x = 0; x < kExtent.width; ++x) sum += std::abs(shown(a, x, y) - shown(b, x, y));
    const Measurement result = measureTemporal({a, b}, true);
    EXPECT_NEAR(result.value, sum / static_cast<double>(kExtent.area()), 1e-6);
    EXPECT_NEAR(result.map.at(0, 7, 9), std::abs(shown(a, 7, 9) - shown(b, 7, 9)), 1e-6);
    EXPECT_EQ(measureTemporal({a, a}, false).value, 0);
    EXPECT_EQ(measureTemporal({b, a}, false).value, result.value);

    Image mask(kExtent, 1);
    mask.at(0, 3, 4) = 1;
    TemporalPair masked{a, b};
    masked.mask = &mask;
    EXPECT_NEAR(measureTemporal(masked, false).value, std::abs(shown(a, 3, 4) - shown(b, 3, 4)), 1e-6);
}

TEST(Temporal, BrokenPixelsAreCountedAndLeftOut) {
    Image a = noise(1);
    const Image b = noise(2);
    const Measurement whole = measureTemporal({a, b}, true);
    a.at(1, 5, 6) = std::nanf("");
    const Measurement result = measureTemporal({a, b}, false);
    const double n = static_cast<double>(kExtent.area());
    EXPECT_NEAR(result.value, (whole.value * n - whole.map.at(0, 5, 6)) / (n - 1), 1e-7);
    EXPECT_EQ(result.details[0].second, 1);
}

TEST(Reprojected, MovementOfTheCameraIsNoFlicker) {
    const Image now = picture(2.5f, -1.25f), before = picture(0, 0);
    Image motion(kExtent, 3);
    for (int y = 0; y < kExtent.height; ++y)
        for (int x = 0; x < kExtent.width; ++x) motion.at(0, x, y) = 2.5f, motion.at(1, x, y) = -1.25f;
    TemporalPair pair{now, before};
    pair.motion = &motion;
    const Measurement result = measureReprojectedTemporal(pair, false);
    EXPECT_GT(measureTemporal(pair, false).value, 0.003);
    EXPECT_LT(result.value, 1e-5);
    // 37 of 40 columns have a previous pixel inside, and 28 of 30 rows.
    EXPECT_NEAR(result.details[1].second, 37.0 * 28 / (40 * 30), 1e-9);
}

TEST(Reprojected, EqualsBilinearLookupsWrittenOut) {
    const Image now = noise(3), before = noise(4);
    Image motion(kExtent, 2);
    for (size_t i = 0; i < motion.size(); ++i) motion.data()[i] = 3 * std::sin(static_cast<float>(i));
    double sum = 0;
    int count = 0;
    for (int y = 0; y < kExtent.height; ++y)
        for (int x = 0; x < kExtent.width; ++x) {
            const double px = static_cast<float>(x) + motion.at(0, x, y),
                         py = static_cast<float>(y) + motion.at(1, x, y);
            if (px < 0 || py < 0 || px > kExtent.width - 1 || py > kExtent.height - 1) continue;
            const int l = std::min(static_cast<int>(px), kExtent.width - 2),
                      t = std::min(static_cast<int>(py), kExtent.height - 2);
            const double fx = px - l, fy = py - t;
            const double earlier = (1 - fy) * ((1 - fx) * shown(before, l, t) + fx * shown(before, l + 1, t)) +
                                   fy * ((1 - fx) * shown(before, l, t + 1) + fx * shown(before, l + 1, t + 1));
            sum += std::abs(shown(now, x, y) - earlier);
            ++count;
        }
    TemporalPair pair{now, before};
    pair.motion = &motion;
    EXPECT_NEAR(measureReprojectedTemporal(pair, false).value, sum / count, 1e-5);
}

TEST(Reprojected, UncoveredPointsDoNotCount) {
    const Image now = noise(5);
    Image before = noise(5);
    Image motion(kExtent, 3), depth(kExtent, 1), previousDepth(kExtent, 1);
    depth.fill(4);
    previousDepth.fill(4);
    for (int y = 0; y < kExtent.height; ++y)
        for (int x = 10; x < 20; ++x) {  // something near hid these
            for (int c = 0; c < 3; ++c) before.at(c, x, y) = 0;
            previousDepth.at(0, x, y) = 2;
        }
    TemporalPair pair{now, before};
    pair.motion = &motion;
    EXPECT_GT(measureReprojectedTemporal(pair, false).value, 0.05);
    pair.depth = &depth, pair.previousDepth = &previousDepth;
    const Measurement result = measureReprojectedTemporal(pair, true);
    EXPECT_EQ(result.value, 0);
    EXPECT_EQ(result.details[1].second, 0.75);
    // A point that came nearer was farther away before: motion's third channel says so.
    for (int y = 0; y < kExtent.height; ++y)
        for (int x = 10; x < 20; ++x) motion.at(2, x, y) = -2;
    EXPECT_EQ(measureReprojectedTemporal(pair, false).details[1].second, 1);
    depth.fill(kInfinity);
    EXPECT_EQ(measureReprojectedTemporal(pair, false).details[1].second, 0) << "the sky was no surface";
}

/// The pair with everything that the reprojected error looks at.
struct Moving {
    Image now = noise(30), before = noise(31), motion{kExtent, 3}, depth{kExtent, 1}, previousDepth{kExtent, 1},
          mask{kExtent, 1};
    Moving() {
        for (int64_t i = 0; i < kExtent.area(); ++i) motion.data()[i] = 1;
        depth.fill(3), previousDepth.fill(3), mask.fill(1);
    }
    TemporalPair pair() const {
        TemporalPair pair{now, before};
        pair.motion = &motion, pair.depth = &depth, pair.previousDepth = &previousDepth, pair.mask = &mask;
        return pair;
    }
};

TEST(SequenceMetrics, AreAsSymmetricAsDeclared) {
    const Moving moving;
    TemporalPair pair = moving.pair(), swapped{moving.before, moving.now};
    swapped.motion = pair.motion;
    for (const SequenceMetric& metric : sequenceMetricCatalog()) EXPECT_FALSE(metric.symmetric) << metric.id;
    // It judges the image's own frames: with another sequence in its place, the number is another.
    EXPECT_EQ(measureTemporal(pair, false).value, measureTemporal(swapped, false).value)
        << "backwards it is the same flicker";
    EXPECT_NE(measureTemporal(pair, false).value, measureTemporal({moving.now, moving.now}, false).value);
    EXPECT_NE(measureReprojectedTemporal(pair, false).value, measureReprojectedTemporal(swapped, false).value);
    LagMeter rising(moving.before, moving.now), falling(moving.now, moving.before);
    rising.add(moving.now), falling.add(moving.now);
    EXPECT_NEAR(rising.curve()[0], 1, 1e-9);
    EXPECT_NEAR(falling.curve()[0], 0, 1e-9);
}

TEST(SequenceMetrics, FramesThatAreTheSameGiveExactlyNothing) {
    Moving moving;
    moving.before = moving.now;
    moving.motion.fill(0);
    EXPECT_EQ(measureTemporal(moving.pair(), false).value, 0);
    EXPECT_EQ(measureReprojectedTemporal(moving.pair(), false).value, 0);
}

TEST(SequenceMetrics, BrokenPixelsOfEitherFrameCountForNothing) {
    Moving moving;
    const float nan = std::nanf("");
    moving.now.at(2, 5, 5) = nan, moving.before.at(0, 9, 8) = kInfinity;
    Moving without = moving;
    for (int c = 0; c < 3; ++c) without.now.at(c, 5, 5) = without.before.at(c, 9, 8) = 0.3f;
    without.mask.at(0, 5, 5) = without.mask.at(0, 9, 8) = 0;
    const Measurement seen = measureTemporal(moving.pair(), true);
    EXPECT_EQ(seen.value, measureTemporal(without.pair(), false).value);
    EXPECT_EQ(seen.details[0].second, 2);
    EXPECT_EQ(seen.map.at(0, 5, 5), 0);
    without.mask.at(0, 9, 8) = 1, without.mask.at(0, 8, 8) = 0;  // followed by one pixel to the right
    const Measurement followed = measureReprojectedTemporal(moving.pair(), true);
    EXPECT_EQ(followed.value, measureReprojectedTemporal(without.pair(), false).value);
    EXPECT_EQ(followed.details[0].second, 2);
    moving.motion.at(0, 12, 12) = nan;
    without.mask.at(0, 12, 12) = 0;
    EXPECT_EQ(measureReprojectedTemporal(moving.pair(), false).value,
              measureReprojectedTemporal(without.pair(), false).value);
}

TEST(SequenceMetrics, NothingThatCountsIsNoValueAndSaysWhy) {
    Moving moving;
    moving.motion.fill(1000);
    EXPECT_EQ(measureReprojectedTemporal(moving.pair(), false).reason, "no point was seen in the frame before");
    moving.mask.fill(0);
    for (const Measurement& seen :
         {measureTemporal(moving.pair(), true), measureReprojectedTemporal(moving.pair(), true)}) {
        EXPECT_TRUE(std::isnan(seen.value));
        EXPECT_EQ(seen.reason, "the mask leaves no pixel");
    }
    moving.mask.fill(1), moving.now.fill(std::nanf(""));
    EXPECT_EQ(measureTemporal(moving.pair(), false).reason, "no pixel is finite in both frames");
    LagMeter meter(moving.before, noise(1));
    meter.add(moving.now);
    EXPECT_EQ(meter.lag(0).reason, "no pixel that the step changes is finite");
    EXPECT_EQ(meter.lag(0).nonFinitePixels, kExtent.area());
}

TEST(SequenceMetrics, OtherSizesAreRefused) {
    const Moving moving;
    const Image small({kExtent.width - 1, kExtent.height}, 3);
    EXPECT_THROW(measureTemporal({moving.now, small}, false), Error);
    TemporalPair pair = moving.pair();
    for (const Image* TemporalPair::*member :
         {&TemporalPair::motion, &TemporalPair::depth, &TemporalPair::previousDepth, &TemporalPair::mask}) {
        TemporalPair other = pair;
        other.*member = &small;
        EXPECT_THROW(measureReprojectedTemporal(other, false), Error);
    }
}

/// References of a light that goes from `low` to `high` at frame `step`, and an output that follows with weight 0.3.
Lag followed(int frames, int step, float low, float high, const Image* mask = nullptr, int missing = -1) {
    LagSequence sequence;
    float seen = low;
    for (int n = 0; n < frames; ++n) {
        Image reference = noise(50), output = noise(51);
        const float light = n < step ? low : high;
        seen += 0.3f * (light - seen);
        for (size_t i = 0; i < reference.size(); ++i) {
            output.data()[i] = seen * reference.data()[i];
            reference.data()[i] *= light * (1 + 0.001f * static_cast<float>(n % 2));  // a reference has noise too
        }
        for (int c = 0; c < 3; ++c) output.at(c, 4, 4) = 1e6f;
        if (n != missing) sequence.add(n, output, reference, mask);
    }
    return sequence.result();
}

TEST(LagSequence, FindsTheStepWhateverItsBrightness) {
    Image mask(kExtent, 1);
    mask.fill(1);
    mask.at(0, 4, 4) = 0;
    for (const auto& [low, high] : {std::pair{0.001f, 0.002f}, {30.0f, 90.0f}, {2.0f, 0.5f}}) {
        const Lag lag = followed(14, 3, low, high, &mask);
        EXPECT_EQ(lag.stepFrame, 3) << low;
        EXPECT_EQ(lag.value, 6) << low;  // 1 - 0.7^7 = 0.918
        EXPECT_NEAR(lag.curve[2], 1 - std::pow(0.7, 3), 0.01) << low;
        EXPECT_EQ(lag.curve.size(), 11u);
    }
}

TEST(LagSequence, SaysWhyThereIsNoLag) {
    EXPECT_EQ(followed(1, 0, 1, 1).reason, "there is one frame only");
    EXPECT_EQ(followed(8, 20, 1, 2).reason, "the reference's light makes no step");
    EXPECT_EQ(followed(8, 3, 1, 2, nullptr, 5).reason, "frame 5 is missing");
    Image mask(kExtent, 1);
    mask.fill(1);
    mask.at(0, 4, 4) = 0;
    EXPECT_EQ(followed(5, 3, 1, 2, &mask).reason, "not reached within 2 frames");
    mask.fill(0);
    EXPECT_EQ(followed(8, 3, 1, 2, &mask).reason, "the reference's light makes no step");
}

TEST(Lag, AnExponentialMeanFollowsItsFormula) {
    const Image before = noise(6), after = noise(7);
    LagMeter meter(before, after);
    Image output = before;
    for (int n = 0; n < 15; ++n) {
        for (size_t i = 0; i < output.size(); ++i) output.data()[i] += 0.2f * (after.data()[i] - output.data()[i]);
        meter.add(output);
        EXPECT_NEAR(meter.curve().back(), 1 - std::pow(0.8, n + 1), 1e-5);
    }
    EXPECT_EQ(meter.lag(3).value, 10);  // 1 - 0.8^11 = 0.914
    EXPECT_EQ(meter.lag(3).stepFrame, 3);
    const Image map = meter.map();
    EXPECT_EQ(map.at(0, 11, 12), 10);
}

TEST(Lag, NoiseAveragesOutAndNothingIsFoundWhereNothingHappens) {
    const Image dark(kExtent, 3);
    Image light(kExtent, 3);
    light.fill(0.5f);
    LagMeter meter(dark, light), still(light, light);
    for (uint32_t n = 0; n < 4; ++n) {
        Image output = noise(20 + n);  // of mean 0.5
        meter.add(n < 2 ? dark : output);
        still.add(light);
    }
    EXPECT_EQ(meter.curve()[1], 0);
    EXPECT_NEAR(meter.curve()[2], 1, 0.03);
    EXPECT_EQ(meter.lag(0).value, 2);
    EXPECT_FALSE(still.changes());
    EXPECT_TRUE(std::isnan(still.lag(0).value));
    EXPECT_EQ(still.lag(0).reason, "the step changes nothing that counts");
    Image mask(kExtent, 1);
    mask.at(0, 1, 1) = 1;
    LagMeter masked(dark, light, &mask);
    Image output(kExtent, 3);
    for (int c = 0; c < 3; ++c) output.at(c, 1, 1) = 0.25f, output.at(c, 2, 2) = 100;
    masked.add(output);
    EXPECT_NEAR(masked.curve()[0], 0.5, 1e-6);
}

}  // namespace
}  // namespace lumi
