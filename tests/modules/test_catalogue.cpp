// What every module promises (reconstruct/module.h), on every module of the catalogue.
#include <cmath>
#include <limits>

#include "base/parallel.h"
#include "math/hash.h"
#include "support/module_harness.h"

namespace lumi::test {
namespace {

class Catalogue : public testing::TestWithParam<const ModuleEntry*> {
protected:
    std::unique_ptr<Module> make(Extent2 extent) const {
        auto module = GetParam()->make();
        module->resize(extent);
        return module;
    }
};

TEST_P(Catalogue, OddSizesGiveFiniteImagesOfThatSize) {
    for (const Extent2 extent : {Extent2{1, 1}, Extent2{3, 1}, Extent2{257, 89}}) {
        ModuleHarness harness(extent);
        const auto module = make(extent);
        for (FrameNumber frame = 0; frame < 3; ++frame) {
            const Image image = harness.image(*module, frame, harness.trace(frame));
            ASSERT_EQ(image.extent(), extent);
            ASSERT_EQ(image.channels(), 3);
            EXPECT_EQ(countNonFinite(image), 0);
        }
    }
}

TEST_P(Catalogue, ASizeMayGrowAndShrink) {
    const auto module = make({8, 8});
    for (const Extent2 extent : {Extent2{8, 8}, Extent2{33, 17}, Extent2{5, 9}}) {
        ModuleHarness harness(extent);
        module->resize(extent);
        EXPECT_EQ(harness.image(*module, 0, harness.trace(0)).extent(), extent);
    }
}

TEST_P(Catalogue, ConstantInGivesConstantOut) {
    const Extent2 extent{37, 23};
    ModuleHarness harness(extent, 4);
    const auto module = make(extent);
    if (tracesItself(*module)) GTEST_SKIP() << "sees the scene, not the signals";
    const Signals signals = constantSignals(extent, 4, 0.625f);
    for (FrameNumber frame = 0; frame < 5; ++frame) {
        const Image image = harness.image(*module, frame, signals);
        for (size_t i = 0; i < image.size(); ++i) ASSERT_NEAR(image.data()[i], 0.625f, 1e-6f) << "frame " << frame;
    }
}

// A value that is no number may stay in its own pixel, and reaches no other.
TEST_P(Catalogue, NotANumberStaysInItsPixel) {
    const Extent2 extent{31, 19};
    ModuleHarness harness(extent);
    for (const float bad : {std::numeric_limits<float>::quiet_NaN(), kInfinity}) {
        const auto module = make(extent);
        for (FrameNumber frame = 0; frame < 3; ++frame) {
            Signals signals = harness.trace(frame);
            for (int i = 0; i < kSignalCount && frame == 1; ++i) {
                const Signal signal = static_cast<Signal>(i);
                if (!signalInfo(signal).isId)
                    for (int c = 0; c < signals[signal].channels(); ++c) signals[signal].at(c, 12, 7) = bad;
            }
            if (frame == 1)
                for (int c = 0; c < 3; ++c) signals.noisySum().at(c, 12, 7) = bad;
            EXPECT_LE(countNonFinite(harness.image(*module, frame, signals)), 1) << "frame " << frame;
        }
    }
}

TEST_P(Catalogue, ForgettingEqualsAFreshInstance) {
    const Extent2 extent{41, 29};
    ModuleHarness harness(extent);
    const auto used = make(extent), fresh = make(extent);
    for (FrameNumber frame = 0; frame < 4; ++frame)
        harness.image(*used, frame, harness.trace(frame, 0.1f * static_cast<float>(frame)));
    used->forget();
    for (FrameNumber frame = 7; frame < 10; ++frame) {
        const Signals signals = harness.trace(frame);
        const Changes changes{.cut = frame == 7};
        const Image a = harness.image(*used, frame, signals, changes),
                    b = harness.image(*fresh, frame, signals, changes);
        EXPECT_EQ(digestOf(a, *used), digestOf(b, *fresh)) << "frame " << frame;
    }
}

TEST_P(Catalogue, TheNumberOfThreadsDoesNotMatter) {
    const Extent2 extent{130, 67};
    ModuleHarness harness(extent);
    std::vector<std::string> digests;
    for (const int threads : {1, 2, 8}) {
        setThreadCount(threads);
        const auto module = make(extent);
        std::string all;
        for (FrameNumber frame = 0; frame < 3; ++frame) {
            const Image image = harness.image(*module, frame, harness.trace(frame));
            all += digestOf(image, *module);
        }
        digests.push_back(all);
    }
    setThreadCount(0);
    EXPECT_EQ(digests[0], digests[1]);
    EXPECT_EQ(digests[0], digests[2]);
}

TEST_P(Catalogue, TheSameFrameAgainReplacesIt) {
    const Extent2 extent{41, 29};
    ModuleHarness harness(extent);
    const auto replaced = make(extent), straight = make(extent);
    const Signals first = harness.trace(0), wrong = harness.trace(5, 0.3f), second = harness.trace(1),
                  third = harness.trace(2);
    harness.image(*replaced, 0, first);
    harness.image(*replaced, 1, wrong, {.camera = true});
    harness.image(*replaced, 1, wrong);
    const Image a = harness.image(*replaced, 1, second);
    harness.image(*straight, 0, first);
    const Image b = harness.image(*straight, 1, second);
    EXPECT_EQ(digestOf(a, *replaced), digestOf(b, *straight));
    const Image c = harness.image(*replaced, 2, third), d = harness.image(*straight, 2, third);
    EXPECT_EQ(digestOf(c, *replaced), digestOf(d, *straight));
}

TEST_P(Catalogue, AStoppedRunChangesNothing) {
    const Extent2 extent{41, 29};
    ModuleHarness harness(extent);
    const auto stopped = make(extent), straight = make(extent);
    const Signals first = harness.trace(0), second = harness.trace(1);
    harness.image(*stopped, 0, first);
    Image unused;
    EXPECT_EQ(harness.run(*stopped, {1, {.cut = true}, 0, true}, harness.trace(9), unused), RunResult::Stopped);
    harness.image(*straight, 0, first);
    const Image a = harness.image(*stopped, 1, second), b = harness.image(*straight, 1, second);
    EXPECT_EQ(digestOf(a, *stopped), digestOf(b, *straight));
}

// What converges has an error of 1/sqrt(n): 64 frames of independent noise of one amplitude.
TEST_P(Catalogue, AStaticViewConverges) {
    const Extent2 extent{64, 64};
    ModuleHarness harness(extent);
    const auto module = make(extent);
    if (tracesItself(*module)) GTEST_SKIP() << "sees the scene, not the signals";
    double firstError = 0, lastError = 0;
    for (FrameNumber frame = 0; frame < 64; ++frame) {
        Signals signals = constantSignals(extent, 1, 0);
        for (size_t i = 0; i < signals[Signal::Noisy].size(); ++i) {
            const float value = unitFloat(hashCombine(static_cast<uint32_t>(i), static_cast<uint32_t>(frame)));
            signals[Signal::Noisy].data()[i] = signals[Signal::DirectDiffuse].data()[i] =
                signals[Signal::Direct].data()[i] = value;
            signals.noisySum().data()[i] = value;
        }
        const Image image = harness.image(*module, frame, signals);
        double squares = 0;
        for (size_t i = 0; i < image.size(); ++i) squares += std::pow(image.data()[i] - 0.5, 2);
        lastError = std::sqrt(squares / static_cast<double>(image.size()));
        if (frame == 0) firstError = lastError;
    }
    if (module->convergence().samples == 0) GTEST_SKIP() << "does not converge, nor says so";
    EXPECT_EQ(module->convergence().samples, 64u);
    EXPECT_NEAR(firstError, std::sqrt(1.0 / 12), 0.005);
    EXPECT_NEAR(lastError, std::sqrt(1.0 / 12 / 64), 0.001);
}

std::vector<std::string> togglesOf(Module& module) {
    std::vector<std::string> ids;
    for (const ParameterInfo& info : listParameters([&](ParameterVisitor& v) { module.describe(v); }))
        if (info.type == ParameterType::Toggle) ids.push_back(info.id);
    return ids;
}

void flip(Module& module, const std::string& id) {
    const Describe describe = [&](ParameterVisitor& v) { module.describe(v); };
    for (const ParameterInfo& info : listParameters(describe))
        if (info.id == id) setParameter(describe, id, !std::get<bool>(info.value));
}

// A stage that was off for a frame has no history to ask, and none to build on.
TEST_P(Catalogue, SwitchesMayBeFlippedBetweenFramesWhileAPixelIsAskedAbout) {
    const Extent2 extent{19, 13};
    ModuleHarness harness(extent);
    harness.inspected = Pixel{9, 6};
    for (const std::string& id : togglesOf(*make(extent))) {
        const auto module = make(extent);
        for (FrameNumber frame = 0; frame < 6; ++frame) {
            if (frame > 1) flip(*module, id);
            EXPECT_EQ(countNonFinite(harness.image(*module, frame, harness.trace(frame))), 0)
                << id << ", frame " << frame;
        }
    }
}

// Where a method says that no history reaches a frame a replay begins there: with any two switches flipped the frame is
// that of a fresh instance.
TEST_P(Catalogue, WhereNoHistoryIsKeptAFreshInstanceGivesTheFrame) {
    const Extent2 extent{19, 13};
    ModuleHarness harness(extent);
    const std::vector<std::string> toggles = togglesOf(*make(extent));
    for (size_t i = 0; i < toggles.size(); ++i)
        for (size_t j = i; j < toggles.size(); ++j) {
            const auto used = make(extent), fresh = make(extent);
            for (Module* module : {used.get(), fresh.get()}) {
                flip(*module, toggles[i]);
                if (j != i) flip(*module, toggles[j]);
            }
            if (used->keepsHistory({})) continue;
            for (FrameNumber frame = 0; frame < 2; ++frame) harness.image(*used, frame, harness.trace(frame));
            const Signals signals = harness.trace(2);
            const Image a = harness.image(*used, 2, signals), b = harness.image(*fresh, 2, signals, {.cut = true});
            EXPECT_EQ(digestOf(a, *used), digestOf(b, *fresh)) << toggles[i] << " and " << toggles[j];
        }
}

TEST_P(Catalogue, TapsAreDeclaredAndWritten) {
    const Extent2 extent{16, 8};
    ModuleHarness harness(extent, 2);
    const auto module = make(extent);
    harness.image(*module, 0, harness.trace(0));
    for (const Tap& tap : module->taps()) {
        EXPECT_EQ(module->tap(tap.name).extent(), extent) << tap.name;
        EXPECT_EQ(module->tap(tap.name).channels(), static_cast<int>(std::string(tap.channels).size())) << tap.name;
        EXPECT_EQ(tap.name.find_first_of("-. "), std::string::npos) << tap.name;
        if (tap.range) {
            EXPECT_LT(tap.range->low, tap.range->high) << tap.name;
        }
        EXPECT_STRNE(tap.help, "") << tap.name;
    }
    EXPECT_TRUE(module->tap("noSuchTap").empty());
}

INSTANTIATE_TEST_SUITE_P(All, Catalogue, testing::ValuesIn(catalogueEntries()), testName);

}  // namespace
}  // namespace lumi::test
