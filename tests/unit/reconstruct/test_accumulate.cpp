#include "reconstruct/accumulate/accumulate.h"

#include <cmath>

#include "math/statistics.h"
#include "support/module_harness.h"

namespace lumi::test {
namespace {

constexpr Extent2 kExtent{24, 16};

Describe describeOf(Module& module) {
    return [&module](ParameterVisitor& v) { module.describe(v); };
}

/// A frame of `samples`: the mean, sum and variance of one pixel's samples everywhere.
Signals frameOf(const std::vector<double>& samples) {
    RunningMoments moments;
    double sum = 0;
    for (const double sample : samples) moments.add(sample), sum += sample;
    Signals signals = constantSignals(kExtent, static_cast<int>(samples.size()), static_cast<float>(moments.mean()));
    signals[Signal::SampleVariance].fill(static_cast<float>(moments.sampleVariance()));
    signals.noisySum().fill(sum);
    return signals;
}

TEST(Accumulate, SamplesInOneFrameEqualFramesOfOne) {
    for (const int spp : {2, 5, 8}) {
        ModuleHarness once(kExtent, spp), each(kExtent, 1);
        AccumulateModule a, b;
        a.resize(kExtent), b.resize(kExtent);
        const Image together = once.image(a, 0, once.trace(0));
        Image single;
        for (FrameNumber frame = 0; frame < spp; ++frame) single = each.image(b, frame, each.trace(frame));
        EXPECT_EQ(together, single) << spp << " samples";
    }
}

TEST(Accumulate, AlignedSplitsGiveTheSameBits) {
    std::vector<Image> images;
    for (const int spp : {1, 4, 16}) {
        ModuleHarness harness(kExtent, spp);
        AccumulateModule module;
        module.resize(kExtent);
        Image image;
        for (FrameNumber frame = 0; frame < 16 / spp; ++frame)
            image = harness.image(module, frame, harness.trace(frame));
        images.push_back(image);
    }
    EXPECT_EQ(images[0], images[1]);
    EXPECT_EQ(images[0], images[2]);
}

TEST(Accumulate, EachChangeBeginsAgain) {
    ModuleHarness harness(kExtent);
    for (const Changes change : {Changes{.cut = true}, Changes{.camera = true}, Changes{.objects = true},
                                 Changes{.lights = true}, Changes{.materials = true}, Changes{.sampling = true}}) {
        AccumulateModule module;
        module.resize(kExtent);
        for (FrameNumber frame = 0; frame < 3; ++frame) harness.image(module, frame, frameOf({0}));
        const Image image = harness.image(module, 3, frameOf({1}), change);
        EXPECT_EQ(image.at(0, 0, 0), 1);
        EXPECT_EQ(module.convergence().samples, 1u);
    }
}

TEST(Accumulate, OnlyCutsBeginAgainIfAskedFor) {
    ModuleHarness harness(kExtent);
    AccumulateModule module;
    module.resize(kExtent);
    setParameter(describeOf(module), "reset", std::string("cut-only"));
    EXPECT_TRUE(module.keepsHistory({.camera = true}));
    harness.image(module, 0, frameOf({0}));
    EXPECT_EQ(harness.image(module, 1, frameOf({1}), {.camera = true}).at(0, 0, 0), 0.5f);
    EXPECT_EQ(harness.image(module, 2, frameOf({1}), {.cut = true}).at(0, 0, 0), 1);
}

TEST(Accumulate, StopsAtTheLimitAndGoesOnWhenItIsLifted) {
    ModuleHarness harness(kExtent);
    AccumulateModule module;
    module.resize(kExtent);
    setParameter(describeOf(module), "limit", true);
    setParameter(describeOf(module), "max-samples", 3);
    const double values[] = {1, 2, 3, 100, 200};
    Image image;
    for (FrameNumber frame = 0; frame < 5; ++frame) {
        image = harness.image(module, frame, frameOf({values[frame]}));
        EXPECT_EQ(module.convergence().done(), frame >= 2) << frame;
    }
    EXPECT_EQ(image.at(0, 3, 3), 2);
    EXPECT_EQ(module.convergence().samples, 3u);
    EXPECT_EQ(module.convergence().target, 3u);
    setParameter(describeOf(module), "limit", false);
    EXPECT_EQ(harness.image(module, 5, frameOf({4})).at(0, 3, 3), 2.5f);
    EXPECT_EQ(module.convergence().target, 0u);
}

TEST(Accumulate, StandardErrorIsThatOfAllSamples) {
    const std::vector<std::vector<double>> frames{{1, 4}, {2, 2}, {7, -1}, {0.5, 3}};
    ModuleHarness harness(kExtent, 2);
    AccumulateModule module;
    module.resize(kExtent);
    RunningMoments all;
    for (size_t frame = 0; frame < frames.size(); ++frame) {
        for (const double sample : frames[frame]) all.add(sample);
        harness.image(module, static_cast<FrameNumber>(frame), frameOf(frames[frame]));
        const float expected = static_cast<float>(std::sqrt(all.meanVariance()));
        EXPECT_NEAR(module.tap("standardError").at(1, 5, 5), expected, 1e-5f * expected) << frame;
        EXPECT_EQ(module.tap("sampleCount").at(0, 5, 5), static_cast<float>(all.count()));
    }
}

TEST(Accumulate, StandardErrorOfSingleSamplesComesFromTheirSpread) {
    ModuleHarness harness(kExtent);
    AccumulateModule module;
    module.resize(kExtent);
    RunningMoments all;
    for (FrameNumber frame = 0; frame < 20; ++frame) {
        const double value = std::sin(static_cast<double>(frame));
        all.add(value);
        harness.image(module, frame, frameOf({value}));
    }
    EXPECT_NEAR(module.tap("standardError").at(0, 0, 0), std::sqrt(all.meanVariance()), 1e-6);
}

TEST(Accumulate, OnlyWantedTapsAreComputed) {
    ModuleHarness harness(kExtent);
    AccumulateModule module;
    module.resize(kExtent);
    harness.image(module, 0, frameOf({1}));
    EXPECT_FALSE(module.tap("sampleCount").empty());
    module.forget();
    EXPECT_TRUE(module.tap("sampleCount").empty());
}

}  // namespace
}  // namespace lumi::test
