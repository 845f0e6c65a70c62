// Input that breaks filters, on every module of the catalogue: numbers that are none, no light, nothing but sky,
// another size in mid-sequence, parameters at their ends. And what must not be changed: light without noise.
#include <limits>

#include "math/hash.h"
#include "support/module_harness.h"

namespace lumi::test {
namespace {

class Degenerate : public testing::TestWithParam<const ModuleEntry*> {
protected:
    std::unique_ptr<Module> make(Extent2 extent) const {
        auto module = GetParam()->make();
        module->resize(extent);
        return module;
    }
    static constexpr std::initializer_list<const char*> kFilters{"svgf", "asvgf", "eaw", "sbf", "aaf", "temporal"};
    bool isOneOf(std::initializer_list<const char*> ids) const {
        return std::any_of(ids.begin(), ids.end(), [&](const char* id) { return std::string(id) == GetParam()->id; });
    }
};

/// Pixels but p whose values differ.
int countDifferent(const Image& a, const Image& b, Pixel p) {
    int count = 0;
    for (int y = 0; y < a.height(); ++y)
        for (int x = 0; x < a.width(); ++x) {
            if (Pixel{x, y} == p) continue;
            bool same = true;
            for (int c = 0; c < a.channels(); ++c) same = same && a.at(c, x, y) == b.at(c, x, y);
            count += !same;
        }
    return count;
}

TEST_P(Degenerate, ADroppedPixelIsCountedAndShownAndHarmsNoOther) {
    const Extent2 extent{31, 19};
    const Pixel at{12, 7};
    ModuleHarness harness(extent);
    const auto frameWith = [&](FrameNumber frame, float value) {
        Signals signals = harness.trace(frame);
        if (frame == 2)
            for (const Signal signal : {Signal::Noisy, Signal::Direct, Signal::Indirect, Signal::Emission})
                signals[signal].at(1, at.x, at.y) = value;
        return signals;
    };
    for (const float bad : {std::numeric_limits<float>::quiet_NaN(), kInfinity, -kInfinity}) {
        const auto module = make(extent), clean = make(extent);
        const auto taps = module->taps();
        const bool counts = std::any_of(taps.begin(), taps.end(), [](const Tap& tap) { return tap.name == "dropped"; });
        EXPECT_TRUE(counts || !isOneOf({"svgf", "eaw", "temporal", "taa", "asvgf", "aaf", "sbf"}));
        for (FrameNumber frame = 0; frame < 6; ++frame) {
            const Image image = harness.image(*module, frame, frameWith(frame, bad));
            EXPECT_LE(countNonFinite(image), isOneOf({"none", "accumulate"}) ? 1 : 0) << "frame " << frame;
            // What is dropped counts as 0, but where it was filled in: no other pixel is other than if it had been.
            if (!isOneOf(kFilters)) {
                EXPECT_EQ(countDifferent(image, harness.image(*clean, frame, frameWith(frame, 0)), at), 0)
                    << "frame " << frame;
            }
            if (!counts) continue;
            const Image& dropped = module->tap("dropped");
            ASSERT_EQ(dropped.extent(), extent);
            double count = 0;
            for (size_t i = 0; i < dropped.size(); ++i) count += dropped.data()[i];
            EXPECT_EQ(count, frame == 2 ? 1 : 0) << "frame " << frame;
            EXPECT_EQ(dropped.at(0, at.x, at.y), frame == 2 ? 1 : 0);
            EXPECT_EQ(module->droppedPixels(), frame == 2 ? 1 : 0);
        }
    }
}

// Under light that is the same everywhere a sample that is no number leaves no trace, neither then nor in later frames;
// with history or, in the first frame, without.
TEST_P(Degenerate, ADroppedSampleIsNoDarkOne) {
    if (!isOneOf(kFilters)) GTEST_SKIP() << "fills nothing in";
    const Extent2 extent{31, 19};
    ModuleHarness harness(extent);
    for (const FrameNumber at : {0, 2}) {
        const auto module = make(extent);
        for (FrameNumber frame = 0; frame < 5; ++frame) {
            Signals signals = constantSignals(extent, 1, 0.625f);
            signals[Signal::Emission].fill(0.25f);
            if (frame == at)
                for (const Signal signal : {Signal::Noisy, Signal::Direct, Signal::Indirect, Signal::Emission})
                    signals[signal].at(1, 12, 7) = std::numeric_limits<float>::quiet_NaN();
            const Image image = harness.image(*module, frame, signals);
            for (size_t i = 0; i < image.size(); ++i) ASSERT_NEAR(image.data()[i], 0.875f, 2e-6f) << "frame " << frame;
        }
    }
}

// A caustic's sample may be any number; squares of it are none any more.
TEST_P(Degenerate, AHugeSampleLeavesNumbers) {
    const Extent2 extent{31, 19};
    ModuleHarness harness(extent);
    const auto module = make(extent);
    for (FrameNumber frame = 0; frame < 6; ++frame) {
        Signals signals = harness.trace(frame);
        if (frame == 2)
            for (const Signal signal : {Signal::Noisy, Signal::Direct, Signal::Indirect})
                signals[signal].at(1, 12, 7) = 1e20f;
        EXPECT_EQ(countNonFinite(harness.image(*module, frame, signals)), 0) << "frame " << frame;
        for (const Tap& tap : module->taps()) {
            const Image& image = module->tap(tap.name);
            int64_t nans = 0;
            for (size_t i = 0; i < image.size(); ++i) nans += std::isnan(image.data()[i]);
            EXPECT_EQ(nans, 0) << tap.name << " frame " << frame;
        }
    }
}

TEST_P(Degenerate, WithoutLightItIsBlack) {
    const Extent2 extent{23, 17};
    ModuleHarness harness(extent);
    harness.dimLights(true, 0);
    const auto module = make(extent);
    for (FrameNumber frame = 0; frame < 6; ++frame) {
        const Image image = harness.image(*module, frame, harness.trace(frame));
        for (size_t i = 0; i < image.size(); ++i) ASSERT_EQ(image.data()[i], 0) << "frame " << frame;
    }
}

/// Nothing but sky, of one colour a column.
Signals sky(Extent2 extent) {
    Signals signals = constantSignals(extent, 1, 0);
    for (const Signal signal : {Signal::Normal, Signal::GeometricNormal, Signal::ObjectNormal, Signal::InverseDepth,
                                Signal::Direct, Signal::DirectDiffuse})
        signals[signal].fill(0);
    signals[Signal::Depth].fill(kInfinity);
    for (const Signal id : {Signal::ObjectId, Signal::MaterialId}) signals.ids(id).fill(0);
    for (int64_t i = 0; i < extent.area(); ++i) {
        signals.ids(Signal::Surface).plane(0).data[i] = kNoInstance;
        for (int c = 0; c < 3; ++c) {
            const float value = 0.1f * static_cast<float>(1 + i % extent.width);
            signals[Signal::Emission].plane(c).data[i] = signals[Signal::Noisy].plane(c).data[i] = value;
            signals.noisySum().plane(c).data[i] = value;
        }
    }
    return signals;
}

TEST_P(Degenerate, SkyPassesAround) {
    const Extent2 extent{13, 7};
    ModuleHarness harness(extent);
    const auto module = make(extent);
    if (tracesItself(*module)) GTEST_SKIP() << "sees the scene, not the signals";
    const auto describe = [&](ParameterVisitor& v) { module->describe(v); };
    for (const ParameterInfo& info : listParameters(describe))
        if (info.id == "taa") setParameter(describe, "taa", false);  // it blurs by design
        else if (info.id == "clip") setParameter(describe, "clip", false);
    const Signals signals = sky(extent);
    for (FrameNumber frame = 0; frame < 4; ++frame) {
        const Image image = harness.image(*module, frame, signals);
        for (int x = 0; x < extent.width; ++x)
            ASSERT_NEAR(image.at(1, x, 3), 0.1f * static_cast<float>(1 + x), 1e-5f) << "frame " << frame;
    }
}

TEST_P(Degenerate, AnotherSizeInMidSequenceIsAFreshStart) {
    ModuleHarness large({33, 21}), small({14, 25});
    const auto resized = make({33, 21}), fresh = make({14, 25});
    for (FrameNumber frame = 0; frame < 3; ++frame) large.image(*resized, frame, large.trace(frame));
    resized->resize({14, 25});
    for (FrameNumber frame = 3; frame < 6; ++frame) {
        const Signals signals = small.trace(frame);
        const Changes changes{.cut = frame == 3};
        const Image a = small.image(*resized, frame, signals, changes),
                    b = small.image(*fresh, frame, signals, changes);
        ASSERT_EQ(digestOf(a, *resized), digestOf(b, *fresh)) << "frame " << frame;
    }
}

TEST_P(Degenerate, EveryParameterAtEitherEndGivesNumbers) {
    const Extent2 extent{19, 13};
    ModuleHarness harness(extent);
    std::vector<std::shared_ptr<Signals>> frames;
    const auto shift = [](FrameNumber frame) { return 0.04f * static_cast<float>(frame); };
    for (FrameNumber frame = 0; frame < 4; ++frame)
        frames.push_back(
            std::make_shared<Signals>(harness.trace(frame, shift(frame), frame > 0 ? shift(frame - 1) : 0)));
    const auto sample = GetParam()->make();
    for (const ParameterInfo& info : listParameters([&](ParameterVisitor& v) { sample->describe(v); })) {
        std::vector<ParameterValue> ends;
        if (info.type == ParameterType::Number) ends = {static_cast<float>(info.min), static_cast<float>(info.max)};
        if (info.type == ParameterType::Integer)
            ends = {static_cast<int>(info.min), static_cast<int>(std::min(info.max, 1e6))};
        for (const ParameterValue& end : ends) {
            const auto module = make(extent);
            const auto describe = [&](ParameterVisitor& v) { module->describe(v); };
            for (const ParameterInfo& other : listParameters(describe))
                if (other.type == ParameterType::Toggle) setParameter(describe, other.id, true);
            setParameter(describe, info.id, end);
            for (FrameNumber frame = 0; frame < 4; ++frame) {
                Image image;
                const Changes changes{.cut = frame == 0, .camera = frame > 0};
                ASSERT_EQ(harness.run(*module, {frame, changes, shift(frame), false},
                                      *frames[static_cast<size_t>(frame)], image),
                          RunResult::Completed);
                ASSERT_EQ(countNonFinite(image), 0) << info.id << " frame " << frame;
            }
        }
    }
}

// A static converged input passes through the filter: no noise, all history valid. Antialiasing is off: it clips still
// detail that stands out of its neighbourhood.
TEST_P(Degenerate, LightWithoutNoisePasses) {
    if (isOneOf({"eaw", "sbf", "taa"})) GTEST_SKIP() << "blurs whatever it is given";
    const Extent2 extent{48, 32};
    ModuleHarness harness(extent);
    const auto module = make(extent);
    if (tracesItself(*module)) GTEST_SKIP() << "sees the scene, not the signals";
    const auto describe = [&](ParameterVisitor& v) { module->describe(v); };
    for (const ParameterInfo& info : listParameters(describe)) {
        if (info.id == "taa") setParameter(describe, "taa", false);
        if (info.id == "gradient-strength")
            setParameter(describe, info.id, 0.0f);  // the light is not that of the scene
    }
    Signals signals = constantSignals(extent, 1, 0);
    for (int y = 0; y < extent.height; ++y)
        for (int x = 0; x < extent.width; ++x)
            for (int c = 0; c < 3; ++c) {
                const float value = 0.5f + unitFloat(hashCombine(static_cast<uint32_t>(x), static_cast<uint32_t>(y),
                                                                 static_cast<uint32_t>(c)));
                for (const Signal signal : {Signal::Noisy, Signal::Direct, Signal::DirectDiffuse})
                    signals[signal].at(c, x, y) = value;
                signals.noisySum().at(c, x, y) = value;
            }
    const auto luminanceOf = [](const Image& image, int x, int y) {
        return luminance(Vec3(image.at(0, x, y), image.at(1, x, y), image.at(2, x, y)));
    };
    Image image;
    for (FrameNumber frame = 0; frame < 120; ++frame) image = harness.image(*module, frame, signals);
    for (int y = 0; y < extent.height; ++y)
        for (int x = 0; x < extent.width; ++x) {
            const float expected = luminanceOf(signals[Signal::Direct], x, y);
            ASSERT_NEAR(luminanceOf(image, x, y), expected, 1e-3f * expected) << x << ' ' << y;
        }
}

INSTANTIATE_TEST_SUITE_P(All, Degenerate, testing::ValuesIn(catalogueEntries()), testName);

}  // namespace
}  // namespace lumi::test
