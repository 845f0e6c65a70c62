#include "session/live_metrics.h"

#include <cmath>
#include <cstdlib>

#include "image/exr.h"
#include "image/png.h"
#include "support/session_test.h"
#include "support/temporary_folder.h"

namespace lumi::test {
namespace {

class LiveMetricsTest : public SessionTest {
protected:
    std::filesystem::path write(const char* name, const Image& image) {
        ExrLayers layers;
        layers.add("", "RGB", image);
        writeExr(folder / name, layers);
        return folder / name;
    }
    void waitForReference() {
        waitFor("the reference", [&] { return !metrics.reference().working; });
    }
    std::shared_ptr<const LiveMeasurement> measured() {
        const auto snapshot = session.snapshot();
        metrics.offer(snapshot);
        waitFor("the measurement", [&] {
            const auto latest = metrics.latest();
            return latest && latest->serial == snapshot->serial;
        });
        return metrics.latest();
    }

    TemporaryFolder folder;
    LiveMetrics metrics{log};
};

TEST_F(LiveMetricsTest, MeasuresEachPaneAgainstAFile) {
    open({{"view.layout", "wipe"}});
    waitFor("some samples", [&] { return session.snapshot()->accumulatedSamples >= 4; });
    pause();
    metrics.choose({"rmse", "ssim"}, "relmse");
    metrics.loadReference(write("reference.exr", result()));
    waitForReference();
    EXPECT_EQ(metrics.reference().name, "reference.exr");
    const auto latest = measured();
    ASSERT_EQ(latest->panes.size(), 2u);
    EXPECT_TRUE(latest->problem.empty());
    EXPECT_EQ(latest->panes[0].module, "accumulate");
    EXPECT_EQ(latest->panes[0].values.at("rmse"), 0);
    EXPECT_EQ(latest->panes[0].values.at("ssim"), 1);
    EXPECT_GT(latest->panes[1].values.at("rmse"), 0);
    ASSERT_NE(latest->panes[1].map, nullptr);
    EXPECT_EQ(latest->panes[1].map->extent, session.snapshot()->extent);
    EXPECT_EQ(latest->panes[0].mapInfo.high, latest->panes[1].mapInfo.high) << "maps share their range";
    EXPECT_NE(latest->panes[0].map->rgba, latest->panes[1].map->rgba);
    ASSERT_NE(metrics.curves(), nullptr);
    EXPECT_EQ(metrics.curves()->size(), 2u);
    metrics.choose({"mae"}, "");
    waitFor("another choice", [&] { return metrics.latest() && metrics.latest()->panes[0].values.count("mae"); });
    metrics.clearReference();
    EXPECT_EQ(metrics.latest(), nullptr);
    EXPECT_FALSE(metrics.reference().present);
}

// A PNG holds the exposure of the scene: it must not be applied to it a second time.
TEST_F(LiveMetricsTest, APictureAsShownIsComparedAsShown) {
    open();
    pause();
    const float exposure = session.document().loadedScene()->render.exposureEv;
    ASSERT_GT(exposure, 0.5f);
    DisplaySettings settings;
    settings.exposureEv = exposure;
    settings.curve = ToneCurve::Clamp;
    Image8 pixels;
    convert(result(), "RGB", "none", settings, pixels);
    writePng(folder / "picture.png", pixels);
    metrics.choose({"rmse"}, "");
    metrics.loadReference(folder / "picture.png");
    waitForReference();
    EXPECT_LT(measured()->panes[0].values.at("rmse"), 1.0 / 255);
    EXPECT_TRUE(metrics.reference().asShown);
}

TEST_F(LiveMetricsTest, AReferenceOfAnotherSizeMeasuresNothing) {
    open();
    metrics.choose({"rmse"}, "");
    metrics.loadReference(write("small.exr", Image({8, 8}, 3)));
    waitForReference();
    EXPECT_FALSE(metrics.fits(*session.snapshot()));
    EXPECT_NE(measured()->problem.find("8 x 8"), std::string::npos);
    metrics.loadReference(folder / "missing.exr");
    waitForReference();
    EXPECT_TRUE(logged("missing.exr"));
    EXPECT_EQ(metrics.reference().name, "small.exr") << "a failure leaves the one before";
}

TEST_F(LiveMetricsTest, ACurveIsOfOneMethodAlone) {
    open();
    waitFor("a sample", [&] { return session.snapshot()->accumulatedSamples >= 1; });
    metrics.choose({"rmse"}, "");
    metrics.loadReference(write("reference.exr", Image(session.snapshot()->extent, 3)));
    waitForReference();
    measured();
    const uint64_t first = metrics.latest()->samples;
    session.setText("view.0.module", "accumulate@b");
    waitFor("more samples than the other had", [&] {
        const auto snapshot = session.snapshot();
        return snapshot->panes[0].module == "accumulate@b" && snapshot->accumulatedSamples > first + 1;
    });
    pause();
    measured();
    ASSERT_EQ(metrics.curves()->at(0).size(), 1u);
    EXPECT_GT(metrics.curves()->at(0)[0].samples, first + 1);
}

TEST_F(LiveMetricsTest, AFailureIsTold) {
    open();
    pause();
    metrics.choose({"no-such-metric"}, "");
    metrics.loadReference(write("reference.exr", Image(session.snapshot()->extent, 3)));
    waitForReference();
    EXPECT_NE(measured()->problem.find("no-such-metric"), std::string::npos);
    metrics.choose({"rmse"}, "");
    waitFor("another measurement", [&] { return metrics.latest()->problem.empty(); });
}

TEST_F(LiveMetricsTest, WhatHasNoValueSaysWhy) {
    open();
    Image broken(session.snapshot()->extent, 3);
    broken.fill(std::nanf(""));
    metrics.choose({"rmse", "flip"}, "");
    metrics.loadReference(write("broken.exr", broken));
    waitForReference();
    const auto pane = measured()->panes[0];
    EXPECT_EQ(pane.nonFinitePixels, broken.extent().area());
    for (const char* id : {"rmse", "flip"}) {
        EXPECT_TRUE(std::isnan(pane.values.at(id))) << id;
        EXPECT_EQ(pane.reasons.at(id), "no pixel of the reference is finite");
    }
}

TEST_F(LiveMetricsTest, MakesWhatIsShownAndKnowsWhenItIsNot) {
    const char* cache = std::getenv("XDG_CACHE_HOME");
    const std::string before = cache ? cache : "";
    setenv("XDG_CACHE_HOME", (folder / "").c_str(), 1);
    // Not as many samples as the reference has: those would be its own.
    open({{"accumulate.limit", "true"}, {"accumulate.max-samples", "16"}});
    metrics.choose({"rmse"}, "");
    metrics.makeReference(session.document(), 32);
    waitForReference();
    EXPECT_EQ(metrics.reference().samples, 32u);
    EXPECT_TRUE(metrics.fits(*session.snapshot()));
    EXPECT_GT(measured()->panes[0].values.at("rmse"), 0);
    session.setText("camera.fov-y-deg", "30");
    waitFor("the new view", [&] { return session.snapshot()->revision == session.revision(); });
    EXPECT_FALSE(metrics.fits(*session.snapshot()));
    EXPECT_NE(measured()->problem.find("camera"), std::string::npos);
    session.undo();
    session.setText("path.max-depth", "2");
    waitFor("other light paths", [&] { return session.snapshot()->revision == session.revision(); });
    EXPECT_FALSE(metrics.fits(*session.snapshot()));
    session.undo();
    session.setText("render.seed", "7");
    waitFor("other samples", [&] { return session.snapshot()->revision == session.revision(); });
    EXPECT_TRUE(metrics.fits(*session.snapshot())) << "of the same image";
    session.undo();
    metrics.makeReference(session.document(), 32);
    waitForReference();
    EXPECT_NE(metrics.reference().name.find("cache"), std::string::npos) << metrics.reference().name;
    metrics.makeReference(session.document(), 65536);
    metrics.cancelReference();
    EXPECT_FALSE(metrics.reference().working);
    EXPECT_EQ(metrics.reference().samples, 32u) << "one that was stopped leaves the one before";
    if (cache) setenv("XDG_CACHE_HOME", before.c_str(), 1);
    else unsetenv("XDG_CACHE_HOME");
}

}  // namespace
}  // namespace lumi::test
