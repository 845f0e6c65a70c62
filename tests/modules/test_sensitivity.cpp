// Nothing is declared in vain: every parameter moves the image or a tap, every signal that reads() names does too.
#include "math/hash.h"
#include "support/module_harness.h"

namespace lumi::test {
namespace {

constexpr Extent2 kExtent{32, 24};

Describe describeOf(Module& module) {
    return [&module](ParameterVisitor& v) { module.describe(v); };
}

std::vector<ParameterValue> choicesOf(const ParameterInfo& info) {
    std::vector<ParameterValue> values;
    switch (info.type) {
        case ParameterType::Toggle: return {true, false};
        case ParameterType::Choice: values.assign(info.options.begin(), info.options.end()); return values;
        case ParameterType::Number:
            for (const double t : {0.0, 0.25, 0.5, 1.0})
                values.emplace_back(static_cast<float>(info.min + t * (info.max - info.min)));
            return values;
        case ParameterType::Integer:
            for (const double t : {0.0, 0.001, 0.5, 1.0})
                values.emplace_back(static_cast<int>(info.min + t * (info.max - info.min)));
            return values;
        case ParameterType::Colour: return {Vec3(0), Vec3(static_cast<float>(info.max))};
        case ParameterType::Vector: return {Vec3(1), Vec3(0, 2, 0)};
        case ParameterType::Text: return {};
    }
    return values;
}

bool isActive(Module& module, const std::string& id) {
    for (const ParameterInfo& info : listParameters(describeOf(module)))
        if (info.id == id) return info.active;
    return false;
}

/// Meets the conditions under which `id` matters, trying switches and choices one after the other.
void activate(Module& module, const std::string& id) {
    for (int depth = 0; depth < 3 && !isActive(module, id); ++depth)
        for (const ParameterInfo& info : listParameters(describeOf(module))) {
            if (info.type != ParameterType::Toggle && info.type != ParameterType::Choice) continue;
            for (const ParameterValue& value : choicesOf(info)) {
                setParameter(describeOf(module), info.id, value);
                if (isActive(module, id)) return;
            }
            setParameter(describeOf(module), info.id, info.value);
        }
}

enum class Others { AtDefault, AtLeast, AtMost };

void setNumbers(Module& module, Others others) {
    if (others == Others::AtDefault) return;
    for (const ParameterInfo& info : listParameters(describeOf(module))) {
        const double value = others == Others::AtLeast ? info.min : info.max;
        if (info.type == ParameterType::Number) setParameter(describeOf(module), info.id, static_cast<float>(value));
        if (info.type == ParameterType::Integer) setParameter(describeOf(module), info.id, static_cast<int>(value));
    }
}

/// Frames with a still camera, two moves and a still one again, lights that grow dim on the way, and 2 samples a pixel
/// so that variances are there.
class Sensitivity : public testing::TestWithParam<const ModuleEntry*> {
protected:
    static void SetUpTestSuite() {
        harness_ = std::make_unique<ModuleHarness>(kExtent, 2);
        for (FrameNumber frame = 0; frame < kFrames; ++frame) {
            harness_->dimLights(isDim(frame));
            frames_.push_back(std::make_shared<Signals>(harness_->trace(frame, shift(frame), shift(frame - 1))));
        }
    }
    static void TearDownTestSuite() {
        harness_.reset();
        frames_.clear();
    }

    static bool isDim(FrameNumber frame) { return frame >= 4; }
    static float shift(FrameNumber frame) { return frame < 3 ? 0.0f : frame == 3 ? 0.03f : 0.15f; }

    /// Everything that the module shows over the frames; `disturbed` replaces the signals of the last but one.
    static std::string play(Module& module, const Signals* disturbed = nullptr) {
        module.resize(kExtent);
        module.forget();
        std::string digests;
        for (FrameNumber frame = 0; frame < kFrames; ++frame) {
            Image out;
            const Changes changes{.cut = frame == 0,
                                  .camera = shift(frame) != shift(frame - 1),
                                  .lights = isDim(frame) != isDim(frame - 1)};
            harness_->dimLights(isDim(frame));
            const bool replaced = disturbed && frame == kFrames - 2;
            EXPECT_EQ(harness_->run(module, {frame, changes, shift(frame), false, shift(frame - 1)},
                                    replaced ? *disturbed : *frames_[static_cast<size_t>(frame)], out),
                      RunResult::Completed);
            digests += digestOf(out, module) + '\n';
        }
        return digests;
    }

    static constexpr FrameNumber kFrames = 6;
    static std::unique_ptr<ModuleHarness> harness_;
    static std::vector<std::shared_ptr<Signals>> frames_;
};
std::unique_ptr<ModuleHarness> Sensitivity::harness_;
std::vector<std::shared_ptr<Signals>> Sensitivity::frames_;

TEST_P(Sensitivity, EveryParameterMovesTheImage) {
    const auto sample = GetParam()->make();
    for (const ParameterInfo& info : listParameters(describeOf(*sample))) {
        if (info.redo == Redo::Display) continue;
        // Some act only where another number is small or large: a limit of samples that these few frames reach.
        bool moves = false;
        for (const Others others : {Others::AtDefault, Others::AtLeast, Others::AtMost}) {
            std::set<std::string> seen;
            for (const ParameterValue& value : choicesOf(info)) {
                const auto module = GetParam()->make();
                activate(*module, info.id);
                ASSERT_TRUE(isActive(*module, info.id)) << info.id << ": its condition cannot be met";
                setNumbers(*module, others);
                setParameter(describeOf(*module), info.id, value);
                seen.insert(play(*module));
            }
            moves = moves || seen.size() > 1;
        }
        EXPECT_TRUE(moves) << info.id << " changes nothing";
    }
}

enum class Disturbance { Noise, Zero };

void disturb(Signals& signals, Signal signal, Disturbance kind) {
    const auto noise = [](size_t i) { return unitFloat(hashCombine(static_cast<uint32_t>(i), 77)); };
    if (signalInfo(signal).isId) {
        IdImage& ids = signals.ids(signal);
        for (size_t i = 0; i < ids.size(); ++i) ids.data()[i] = 1 + pcgHash(static_cast<uint32_t>(i)) % 7;
        return;
    }
    Image& image = signals[signal];
    if (kind == Disturbance::Zero) return image.fill(0);
    for (size_t i = 0; i < image.size(); ++i) image.data()[i] = 1.5f * image.data()[i] + noise(i);
    if (signal == Signal::Noisy)
        for (size_t i = 0; i < signals.noisySum().size(); ++i) signals.noisySum().data()[i] += noise(i);
}

/// The defaults, and each option of each choice and toggle, since reads() may depend on them.
std::vector<std::pair<std::string, ParameterValue>> settingsThatMayChangeReads(Module& module) {
    std::vector<std::pair<std::string, ParameterValue>> settings{{"", false}};
    for (const ParameterInfo& info : listParameters(describeOf(module))) {
        if (info.type != ParameterType::Choice && info.type != ParameterType::Toggle) continue;
        for (const ParameterValue& value : choicesOf(info))
            if (value != info.value) settings.emplace_back(info.id, value);
    }
    return settings;
}

TEST_P(Sensitivity, EverySignalThatIsReadIsUsed) {
    for (const auto& [id, value] : settingsThatMayChangeReads(*GetParam()->make())) {
        const auto module = GetParam()->make();
        if (!id.empty()) setParameter(describeOf(*module), id, value);
        const std::string before = play(*module);
        for (int i = 0; i < kSignalCount; ++i) {
            const Signal signal = static_cast<Signal>(i);
            if (!module->reads().has(signal)) continue;
            // A tolerance may swallow what only grows.
            bool used = false;
            for (const Disturbance kind : {Disturbance::Noise, Disturbance::Zero}) {
                Signals disturbed = *frames_[kFrames - 2];
                disturb(disturbed, signal, kind);
                used = used || play(*module, &disturbed) != before;
            }
            EXPECT_TRUE(used) << signalInfo(signal).name << " is read in vain; " << id;
        }
    }
}

TEST_P(Sensitivity, WhatIsNotReadMayBeAbsent) {
    const std::vector<std::shared_ptr<Signals>> all = frames_;
    for (const auto& [id, value] : settingsThatMayChangeReads(*GetParam()->make())) {
        const auto module = GetParam()->make();
        if (!id.empty()) setParameter(describeOf(*module), id, value);
        const std::string full = play(*module);
        for (auto& frame : frames_) {
            auto reduced = std::make_shared<Signals>(*frame);
            for (int i = 0; i < kSignalCount; ++i) {
                const Signal signal = static_cast<Signal>(i);
                if (module->reads().has(signal)) continue;
                (*reduced)[signal] = {};
                reduced->ids(signal) = {};
            }
            frame = reduced;
        }
        EXPECT_EQ(play(*module), full) << id;
        frames_ = all;
    }
}

INSTANTIATE_TEST_SUITE_P(All, Sensitivity, testing::ValuesIn(catalogueEntries()), testName);

}  // namespace
}  // namespace lumi::test
