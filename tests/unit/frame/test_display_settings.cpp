#include <gtest/gtest.h>

#include "frame/display.h"
#include "frame/signals.h"
#include "support/expect_error.h"

namespace lumi {
namespace {

TEST(DisplaySettings, EveryParameterIsDeclaredAndKeepsItsValue) {
    DisplaySettings settings;
    const Describe describe = [&](ParameterVisitor& v) { settings.describe(v); };
    std::vector<std::string> ids;
    for (const ParameterInfo& info : listParameters(describe)) {
        ids.push_back(info.id);
        EXPECT_EQ(info.redo, Redo::Display) << info.id;
        EXPECT_FALSE(info.help.empty()) << info.id;
    }
    EXPECT_EQ(ids, (std::vector<std::string>{"exposure", "tone-curve", "colour-map", "auto-range", "low", "high",
                                             "channel"}));
    setParameter(describe, "colour-map", std::string("turbo"));
    setParameter(describe, "tone-curve", std::string("agx"));
    setParameter(describe, "exposure", -2.5f);
    setParameter(describe, "low", 3.0f);
    EXPECT_EQ(settings.colourMap, "turbo");
    EXPECT_EQ(settings.curve, ToneCurve::AgX);
    EXPECT_EQ(settings.exposureEv, -2.5f);
    EXPECT_EQ(settings.low, 3.0f);
    EXPECT_EQ(std::get<std::string>(getParameter(describe, "colour-map")), "turbo");
    test::expectError(ErrorKind::Usage, [&] { setParameter(describe, "exposure", 17.0f); }, {"exposure", "-16 to 16"});
    test::expectError(ErrorKind::Usage, [&] { setParameter(describe, "colour-map", std::string("jet")); }, {"viridis"});
}

TEST(DisplaySettings, RangeMattersOnlyWhenItIsManual) {
    DisplaySettings settings;
    const Describe describe = [&](ParameterVisitor& v) { settings.describe(v); };
    const auto lowIsActive = [&] {
        for (const ParameterInfo& info : listParameters(describe))
            if (info.id == "low") return info.active;
        return false;
    };
    EXPECT_FALSE(lowIsActive());
    settings.autoRange = false;
    EXPECT_TRUE(lowIsActive());
}

TEST(Signals, NamesAreUniqueAndFoundAgain) {
    for (int i = 0; i < kSignalCount; ++i) {
        const auto signal = static_cast<Signal>(i);
        EXPECT_EQ(signalByName(signalInfo(signal).name), signal);
        EXPECT_NE(signalInfo(signal).help[0], 0);
    }
    EXPECT_EQ(signalByName("nothing"), Signal::Count);
}

TEST(Signals, ResetAllocatesWhatIsWantedAndOnlyThat) {
    Signals signals;
    signals.reset({7, 5}, {Signal::Noisy, Signal::Depth, Signal::Surface}, 2);
    EXPECT_EQ(signals[Signal::Noisy].channels(), 3);
    EXPECT_EQ(signals[Signal::Depth].channels(), 1);
    EXPECT_EQ(signals.ids(Signal::Surface).channels(), 4);
    EXPECT_EQ(signals.noisySum().channels(), 3);
    EXPECT_TRUE(signals[Signal::Albedo].empty());
    const float* memory = signals[Signal::Depth].data();
    signals.reset({7, 5}, {Signal::Depth}, 1);
    EXPECT_EQ(signals[Signal::Depth].data(), memory);
    EXPECT_TRUE(signals[Signal::Noisy].empty());
    EXPECT_TRUE(signals.noisySum().empty());
    EXPECT_TRUE(signals.ids(Signal::Surface).empty());
    signals.reset({9, 2}, {Signal::Depth}, 1);
    EXPECT_EQ(signals[Signal::Depth].extent(), (Extent2{9, 2}));
    EXPECT_EQ(signals.bytes(), 9u * 2 * sizeof(float));
}

TEST(SignalSet, IsASet) {
    const SignalSet a{Signal::Noisy, Signal::Depth}, b{Signal::Depth};
    EXPECT_TRUE(a.contains(b));
    EXPECT_FALSE(b.contains(a));
    EXPECT_TRUE(a.hasAny(b));
    EXPECT_FALSE(SignalSet{Signal::Noisy}.hasAny(b));
    EXPECT_EQ((b | SignalSet{Signal::Noisy}), a);
    EXPECT_TRUE(SignalSet().empty());
    EXPECT_TRUE(SignalSet::all().contains(a));
}

}  // namespace
}  // namespace lumi
