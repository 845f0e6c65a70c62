// Which taps made a pixel: the parts of every stage sum to 1 and, applied to the buffers, give the buffers that follow.
#include <map>

#include "filter/reprojection.h"
#include "support/module_harness.h"

namespace lumi::test {
namespace {

constexpr Extent2 kExtent{64, 48};

struct Asked {
    Lineage lineage;
    std::map<std::string, Image> before, now;  ///< taps of the frame before, and of this one
};

/// `dims`: the lights go down in the last frame.
Asked ask(const char* id, Pixel pixel, bool dims = false) {
    ModuleHarness harness(kExtent);
    const auto module = findModule(id).make();
    module->resize(kExtent);
    Asked asked;
    for (FrameNumber frame = 0; frame < 4; ++frame) {
        const float shift = 0.02f * static_cast<float>(frame);
        Image image;
        if (dims && frame == 3) harness.dimLights(true);
        harness.inspected = frame == 3 ? std::optional(pixel) : std::nullopt;
        EXPECT_EQ(harness.run(*module, {frame, {.cut = frame == 0, .camera = frame > 0}, shift, false},
                              harness.trace(frame, shift, frame > 0 ? shift - 0.02f : 0), image),
                  RunResult::Completed);
        asked.before = asked.now;
        for (const Tap& tap : module->taps()) asked.now[tap.name] = module->tap(tap.name);
    }
    asked.lineage = module->lineage();
    return asked;
}

/// Green of the weighted sum of a stage's pixels in `image`; what the rows' parts sum to.
double sumOver(const Lineage& lineage, const std::string& stage, const Image& image, double& parts) {
    double sum = 0;
    parts = 0;
    for (const Lineage::Row& row : lineage.rows) {
        if (row.stage != stage) continue;
        parts += row.weight;
        if (row.weight > 0) sum += row.weight * image.at(1, row.at.x, row.at.y);
    }
    return sum;
}

TEST(LineageOf, SvgfGivesEachLevel) {
    for (const Pixel pixel : {Pixel{20, 30}, Pixel{40, 25}, Pixel{32, 44}}) {
        const Asked asked = ask("svgf", pixel);
        ASSERT_EQ(asked.lineage.pixel, pixel);
        for (const std::string component : {"direct", "indirect"})
            for (int level = 1; level <= 5; ++level) {
                double parts = 0;
                const std::string before = component + "Level" + std::to_string(level - 1),
                                  after = component + "Level" + std::to_string(level);
                const double sum =
                    sumOver(asked.lineage, component + ", level " + std::to_string(level), asked.now.at(before), parts);
                EXPECT_NEAR(parts, 1, 1e-5);
                EXPECT_NEAR(sum, asked.now.at(after).at(1, pixel.x, pixel.y), 1e-3) << after;
            }
        // History: this frame's sample, and the first level's output of the frame before.
        double sum = 0, parts = 0;
        for (const Lineage::Row& row : asked.lineage.rows) {
            if (row.stage != "history" || row.weight == 0) continue;
            const bool sample = row.verdict.find("sample") != std::string::npos;
            const Image& from = sample ? asked.now.at("demodulatedDirect") : asked.before.at("directLevel1");
            sum += row.weight * from.at(1, row.at.x, row.at.y);
            parts += row.weight;
        }
        EXPECT_NEAR(parts, 1, 1e-5);
        EXPECT_NEAR(sum, asked.now.at("directLevel0").at(1, pixel.x, pixel.y), 1e-4);
    }
}

// Lambda takes from the history what it gives to the sample, of each component by itself.
TEST(LineageOf, AsvgfTellsWhatItGaveUp) {
    int gaveUp = 0;
    for (const Pixel pixel : {Pixel{20, 30}, Pixel{40, 25}, Pixel{32, 44}})
        for (const std::string component : {"direct", "indirect"}) {
            const Asked asked = ask("asvgf", pixel, true);
            const float lambda = asked.now.at(component + "Loss").at(0, pixel.x, pixel.y);
            double sum = 0, parts = 0, sample = 0;
            for (const Lineage::Row& row : asked.lineage.rows) {
                if (row.stage != component + ", history") continue;
                const bool isSample = row.verdict.find("sample") != std::string::npos;
                if (isSample) sample = row.weight;
                const std::string upper = component == "direct" ? "demodulatedDirect" : "demodulatedIndirect";
                const Image& from = isSample ? asked.now.at(upper) : asked.before.at(component + "Level1");
                if (row.weight > 0) sum += row.weight * from.at(1, row.at.x, row.at.y);
                parts += row.weight;
            }
            EXPECT_NEAR(parts, 1, 1e-5);
            EXPECT_NEAR(sum, asked.now.at(component + "Level0").at(1, pixel.x, pixel.y), 1e-4);
            EXPECT_GE(sample, lambda);
            gaveUp += lambda > 0.5f;
        }
    EXPECT_GT(gaveUp, 0);
}

TEST(LineageOf, EawGivesEachLevel) {
    const Pixel pixel{25, 28};
    const Asked asked = ask("eaw", pixel);
    for (int level = 1; level <= 5; ++level) {
        double parts = 0;
        const double sum = sumOver(asked.lineage, "level " + std::to_string(level),
                                   asked.now.at("level" + std::to_string(level - 1)), parts);
        EXPECT_NEAR(parts, 1, 1e-5);
        EXPECT_NEAR(sum, asked.now.at("level" + std::to_string(level)).at(1, pixel.x, pixel.y), 1e-3);
    }
}

// What is lost and what is not there are different things.
TEST(LineageOf, TheSkyIsNotOffTheScreen) {
    ModuleHarness harness(kExtent);
    const auto module = findModule("temporal").make();
    module->resize(kExtent);
    harness.inspected = Pixel{3, 3};
    for (FrameNumber frame = 0; frame < 2; ++frame) {
        Signals signals = harness.trace(frame);
        signals.ids(Signal::ObjectId).at(0, 3, 3) = 0;
        harness.image(*module, frame, signals);
    }
    ASSERT_EQ(module->lineage().rows.size(), 1u);
    EXPECT_NE(module->lineage().rows[0].verdict.find("sky"), std::string::npos);
    EXPECT_EQ(module->tap("reprojection").at(0, 3, 3), 0);
    EXPECT_EQ(module->tap("refusals").at(3, 3, 3), 0);
}

TEST(LineageOf, WithoutAccumulationTheVerdictSaysSo) {
    ModuleHarness harness(kExtent);
    for (const char* id : {"eaw", "sbf", "aaf"}) {
        const auto module = findModule(id).make();
        module->resize(kExtent);
        setParameter([&](ParameterVisitor& v) { module->describe(v); }, "temporal", false);
        harness.image(*module, 0, harness.trace(0));
        const Image& verdict = module->tap("reprojection");
        for (size_t i = 0; i < verdict.size(); ++i) ASSERT_EQ(verdict.data()[i], kVerdictUnused) << id;
    }
}

TEST(LineageOf, NobodyAskedNobodyAnswers) {
    EXPECT_TRUE(ask("svgf", {-1, 3}).lineage.rows.empty());
    EXPECT_TRUE(ask("temporal", {64, 3}).lineage.rows.empty());
    const Lineage lineage = ask("temporal", {32, 44}).lineage;
    EXPECT_GE(lineage.rows.size(), 5u);
}

}  // namespace
}  // namespace lumi::test
