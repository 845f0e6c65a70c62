#include "session/frame_engine.h"

#include "session/ray_rate.h"
#include "support/expect_error.h"
#include "support/probe_module.h"
#include "support/tiny_scene.h"

namespace lumi::test {
namespace {

struct Engine {
    MessageLog log;
    FrameEngine engine{log};
    FrameOutput draw(const Document& document, FrameNumber frame, bool cut = false) {
        std::optional<FrameOutput> output = engine.advance({document, frame, cut, {}, {}});
        EXPECT_TRUE(output.has_value());
        return std::move(*output);
    }
};

TEST(FrameEngine, TheFirstFrameIsACutAndTheNextIsNot) {
    Engine e;
    const Document document(tinyScene());
    EXPECT_TRUE(e.draw(document, 0).changes.cut);
    EXPECT_FALSE(e.draw(document, 1).changes.any());
    EXPECT_TRUE(e.draw(document, 5).changes.cut) << "a gap in the numbers";
    EXPECT_TRUE(e.draw(document, 6, true).changes.cut) << "asked for";
}

TEST(FrameEngine, ASceneWhoseBuildingWasStoppedIsBuiltTheNextTime) {
    Engine stopped, straight;
    const Document document(tinyScene());
    std::stop_source source;
    source.request_stop();
    EXPECT_FALSE(stopped.engine.advance({document, 0, true, {}, {}}, {}, source.get_token()));
    EXPECT_FALSE(stopped.engine.preview(document, {8, 6}, {}, source.get_token()));
    expectError(ErrorKind::Interrupted, [&] { stopped.engine.checkSignals(document, {}, source.get_token()); }, {});
    // A change stops the frame alone: its scene is there for the next.
    EXPECT_FALSE(stopped.engine.advance({document, 0, true, {}, {}}, source.get_token()));
    const FrameOutput next = stopped.draw(document, 0, true), fresh = straight.draw(document, 0, true);
    EXPECT_TRUE(*next.results.at("accumulate") == *fresh.results.at("accumulate"));
    EXPECT_TRUE(stopped.engine.preview(document, {8, 6}).has_value());
}

TEST(FrameEngine, ChecksACameraThatMovesWhileItsShutterIsOpen) {
    Document document(movingScene());
    for (const bool open : {false, true}) {
        document.setText("camera.shutter", open ? "0.5" : "0");
        Engine e;
        const std::vector<FrameCheck> checks = e.engine.checkSignals(document, {}, {});
        ASSERT_EQ(checks.size(), 2u);
        for (const FrameCheck& check : checks)
            for (const ContractFinding& finding : check.findings) EXPECT_TRUE(finding.holds()) << finding.text();
        EXPECT_EQ(checks[1].what.find("under an open shutter") != std::string::npos, open) << checks[1].what;
    }
}

TEST(FrameEngine, ChangesAreTold) {
    const auto changesAfter = [](const char* id, const char* text) {
        Engine e;
        Document document(tinyScene());
        e.draw(document, 0);
        document.setText(id, text);
        return e.draw(document, 1).changes;
    };
    EXPECT_TRUE(changesAfter("camera.eye", "0,2,5.1").camera);
    EXPECT_TRUE(changesAfter("camera.aperture", "0.1").camera);
    EXPECT_TRUE(changesAfter("light.lamp.power", "2").lights);
    EXPECT_TRUE(changesAfter("environment.scale", "2").lights);
    EXPECT_TRUE(changesAfter("material.floor-paint.roughness", "0.2").materials);
    EXPECT_FALSE(changesAfter("material.floor-paint.roughness", "0.2").lights);
    EXPECT_TRUE(changesAfter("material.floor-paint.emission", "1,1,1").lights);
    EXPECT_TRUE(changesAfter("path.max-depth", "2").sampling);
    EXPECT_TRUE(changesAfter("render.seed", "2").sampling);
    EXPECT_TRUE(changesAfter("render.spp", "2").sampling);
    EXPECT_TRUE(changesAfter("render.width", "17").cut);
    EXPECT_TRUE(changesAfter("camera.select", "side-view").cut);
    EXPECT_TRUE(changesAfter("camera.eye", "0,2,500").cut) << "a teleport";
    EXPECT_TRUE(changesAfter("time", "3").cut) << "a jump in time";
    EXPECT_FALSE(changesAfter("time", "0.016").cut);
    EXPECT_TRUE(changesAfter("view.0.module", "none").sampling) << "it prefers another jitter";
    EXPECT_FALSE(changesAfter("view.0.exposure", "3").any());
    EXPECT_FALSE(changesAfter("accumulate.limit", "true").any());
}

TEST(FrameEngine, AnotherShutterIsAnotherMean) {
    Engine e;
    Document document(movingScene());
    document.setText("camera.shutter", "0.9");
    e.draw(document, 0);
    EXPECT_EQ(e.draw(document, 1).convergence.at("accumulate").samples, 2u);
    document.setText("render.fps", "4");
    const FrameOutput after = e.draw(document, 2);
    EXPECT_TRUE(after.changes.sampling);
    EXPECT_EQ(after.convergence.at("accumulate").samples, 1u)
        << "the samples before saw the shutter open for another time";
    document.setText("camera.shutter", "0");
    e.draw(document, 3), e.draw(document, 4);
    document.setText("render.fps", "60");
    EXPECT_FALSE(e.draw(document, 5).changes.any()) << "a shutter that does not open";
}

TEST(FrameEngine, MethodsThatDoWithoutTheLensSaySo) {
    for (const std::string module : {"stable", "supersampling", "martin2002", "svgf"}) {
        Engine e;
        Document document(tinyScene());
        document.setText("view.0.module", module);
        e.draw(document, 0);
        EXPECT_TRUE(e.log.warnings().empty()) << module;
        document.setText("camera.aperture", "0.1");
        e.draw(document, 1), e.draw(document, 2);
        document.setText("camera.shutter", "0.5");
        e.draw(document, 3);
        const std::string after = ": it sees through a pinhole, at the instant when the shutter opens";
        const std::vector<std::string> told{module + ": does without camera.aperture" + after,
                                            module + ": does without camera.aperture and camera.shutter" + after};
        EXPECT_EQ(e.log.warnings(), module == "svgf" ? std::vector<std::string>() : told);
    }
}

TEST(FrameEngine, AFrameOfTheSameNumberReplacesTheLast) {
    Engine replaced, straight;
    Document document(tinyScene()), other = document;
    other.setText("camera.eye", "0,2,5.2");
    replaced.draw(document, 0);
    replaced.draw(other, 1);
    const FrameOutput a = replaced.draw(document, 1);
    straight.draw(document, 0);
    const FrameOutput b = straight.draw(document, 1);
    EXPECT_FALSE(a.changes.any());
    EXPECT_EQ(*a.results.at("accumulate"), *b.results.at("accumulate"));
    EXPECT_EQ(a.convergence.at("accumulate").samples, 2u);
    EXPECT_EQ(*replaced.draw(document, 2).results.at("accumulate"),
              *straight.draw(document, 2).results.at("accumulate"));
}

TEST(FrameEngine, AReplacedFrameKeepsItsSamplesWhereOnlyAModuleChanged) {
    Engine e;
    Document document(tinyScene());
    document.setText("camera.jitter", "per-pixel");
    e.draw(document, 0);
    const FrameOutput before = e.draw(document, 1);
    document.setText("view.0.module", "none");
    const FrameOutput after = e.draw(document, 1);
    EXPECT_EQ((*before.signals)[Signal::Noisy], *after.results.at("none"));
    document.setText("view.0.module", "accumulate");
    EXPECT_EQ(*e.draw(document, 1).results.at("accumulate"), *before.results.at("accumulate"));
}

TEST(FrameEngine, AStoppedFrameChangesNothing) {
    Engine stopped, straight;
    Document document(tinyScene()), other = document;
    other.setText("render.width", "33");
    other.setText("view.0.module", "none");
    stopped.draw(document, 0);
    straight.draw(document, 0);
    std::stop_source stop;
    stop.request_stop();
    EXPECT_FALSE(stopped.engine.advance({other, 1, false, {}, {}}, stop.get_token()).has_value());
    EXPECT_EQ(*stopped.draw(document, 1).results.at("accumulate"),
              *straight.draw(document, 1).results.at("accumulate"));
}

/// Two views: the mean, then a module that can be told to stop.
Document meanAndProbe() {
    Document document(tinyScene());
    document.setText("view.layout", "wipe");
    document.setText("view.1.module", "probe");
    return document;
}

TEST(FrameEngine, AFrameThatTheSecondModuleStopsCanBeDrawnAgain) {
    Engine stopped, straight;
    const Document document = meanAndProbe();
    Document other = document;
    other.setText("camera.eye", "0,2,5.1");
    for (FrameNumber frame = 0; frame < 3; ++frame) stopped.draw(document, frame), straight.draw(document, frame);
    EXPECT_TRUE(stopped.engine.canRepeat(2));
    ProbeModule::stops = true;
    EXPECT_FALSE(stopped.engine.advance({other, 3, false, {}, {}}).has_value());
    ProbeModule::stops = false;
    EXPECT_FALSE(stopped.engine.canRepeat(2)) << "the mean has gone on";
    EXPECT_TRUE(straight.engine.canRepeat(2));
    for (FrameNumber frame = 3; frame < 5; ++frame) {
        const FrameOutput a = stopped.draw(document, frame), b = straight.draw(document, frame);
        EXPECT_EQ(*a.results.at("accumulate"), *b.results.at("accumulate")) << frame;
        EXPECT_EQ(a.convergence.at("accumulate").samples, static_cast<uint64_t>(frame) + 1);
    }
    EXPECT_TRUE(stopped.engine.canRepeat(4));
}

TEST(FrameEngine, ModulesAlwaysTraceTheirFramesScene) {
    Engine e;
    Document document = meanAndProbe(), other = document;
    other.setText("material.floor-paint.roughness", "0.1");
    e.draw(document, 0);
    e.draw(document, 1);
    std::stop_source stop;
    stop.request_stop();
    EXPECT_FALSE(e.engine.advance({other, 2, false, {}, {}}, stop.get_token()).has_value());
    ProbeModule::wrongScenes = 0;
    document.setText("probe.again", "true");
    e.draw(document, 1);
    EXPECT_EQ(ProbeModule::wrongScenes, 0);
}

TEST(FrameEngine, WhatIsAskedForDoesNotChangeTheImage) {
    Engine plain, full;
    const Document document(tinyScene());
    for (FrameNumber frame = 0; frame < 3; ++frame) {
        const FrameOutput a = plain.draw(document, frame);
        const auto b =
            full.engine.advance({document, frame, false, SignalSet::all(), {{"accumulate", {"standardError"}}}});
        ASSERT_TRUE(b.has_value());
        EXPECT_EQ(*a.results.at("accumulate"), *b->results.at("accumulate"));
        EXPECT_TRUE(b->signals->available().contains(SignalSet::all()));
        EXPECT_TRUE(b->taps.count("accumulate-standardError"));
    }
}

// A depth that is stored beside a module which places its own rays costs no paths, and its rays are not the module's.
TEST(FrameEngine, GeometryAloneIsTracedWithoutLight) {
    Engine only, lit;
    Document document(tinyScene());
    document.setText("view.0.module", "stable");
    const auto a = only.engine.advance({document, 0, false, {Signal::Depth, Signal::Normal}, {}});
    const auto b = lit.engine.advance({document, 0, false, {Signal::Depth, Signal::Normal, Signal::Noisy}, {}});
    ASSERT_TRUE(a && b);
    for (const Signal signal : {Signal::Depth, Signal::Normal}) EXPECT_EQ((*a->signals)[signal], (*b->signals)[signal]);
    EXPECT_FALSE(a->signals->available().has(Signal::Noisy));
    EXPECT_GT(a->rays.cameraRays, 0u);
    EXPECT_EQ(a->rays.bounceRays + a->rays.shadowRays, 0u);
    EXPECT_GT(b->rays.bounceRays + b->rays.shadowRays, 0u);
    EXPECT_EQ(*a->results.at("stable"), *b->results.at("stable"));
    for (const auto* frame : {&*a, &*b}) EXPECT_EQ(rayRate(*frame).rays, frame->runRays.at("stable").total());
    EXPECT_GT(rayRate(*a).perSecond(), 0);

    document.setText("view.0.module", "accumulate");
    const FrameOutput reading = only.draw(document, 1);
    EXPECT_EQ(rayRate(reading).rays, reading.rays.total());
}

TEST(FrameEngine, BothViewsSeeTheSameSamples) {
    Engine e;
    Document document(tinyScene());
    document.setText("view.layout", "side-by-side");
    const FrameOutput frame = e.draw(document, 0);
    EXPECT_EQ(frame.results.size(), 2u);
    EXPECT_EQ(*frame.results.at("accumulate"), *frame.results.at("none"));
}

TEST(FrameEngine, InstancesBeyondTheViewsRunOnTheSameSamples) {
    Engine e, alone;
    Document document(tinyScene());
    document.setText("view.0.module", "accumulate");
    document.setText("accumulate@b.limit", "true");
    document.setText("accumulate@b.max-samples", "1");
    for (FrameNumber number = 0; number < 3; ++number) {
        FrameRequest request{document, number, number == 0, {}, {}};
        request.instances = {"none", "accumulate@b", "accumulate"};
        const FrameOutput frame = *e.engine.advance(request);
        ASSERT_EQ(frame.results.size(), 3u);
        EXPECT_EQ(*frame.results.at("none"), (*frame.signals)[Signal::Noisy]);
        EXPECT_EQ(frame.runMs.size(), 3u);
        EXPECT_EQ(frame.convergence.at("accumulate").samples, static_cast<uint64_t>(number + 1));
        EXPECT_EQ(frame.convergence.at("accumulate@b").samples, 1u) << "its own parameters";
        // What runs beside it does not change a module's image.
        EXPECT_EQ(*frame.results.at("accumulate"), *alone.draw(document, number).results.at("accumulate"));
    }
}

TEST(FrameEngine, AHiddenModuleBeginsAgainWhenItComesBack) {
    Engine e;
    Document shown(tinyScene()), hidden = shown;
    hidden.setText("view.0.module", "none");
    e.draw(shown, 0);
    e.draw(hidden, 1);
    e.draw(hidden, 2);
    EXPECT_EQ(e.draw(shown, 3).convergence.at("accumulate").samples, 1u);
    EXPECT_EQ(e.draw(shown, 4).convergence.at("accumulate").samples, 2u);
}

TEST(FrameEngine, RestsWhenEveryModuleHasConverged) {
    Engine e;
    Document document(tinyScene());
    document.setText("accumulate.limit", "true");
    document.setText("accumulate.max-samples", "2");
    EXPECT_FALSE(e.draw(document, 0).rests());
    EXPECT_TRUE(e.draw(document, 1).rests());
    document.setText("view.layout", "wipe");
    EXPECT_FALSE(e.draw(document, 2).rests()) << "the raw frame never rests";
}

TEST(FrameEngine, HistoryIsToldToBeDropped) {
    Engine e;
    Document document(tinyScene());
    EXPECT_TRUE(e.draw(document, 0).historyDropped);
    EXPECT_FALSE(e.draw(document, 1).historyDropped);
    document.setText("camera.eye", "0,2,5.1");
    EXPECT_TRUE(e.draw(document, 2).historyDropped);
    document.setText("accumulate.reset", "cut-only");
    EXPECT_TRUE(e.draw(document, 3).historyDropped) << "its history no longer fits";
    document.setText("camera.eye", "0,2,5.2");
    EXPECT_FALSE(e.draw(document, 4).historyDropped);
}

TEST(FrameEngine, MotionIsZeroOnACutAndNotAfterAMove) {
    Engine e;
    Document document(tinyScene());
    const auto motionOf = [&](FrameNumber frame) {
        const auto output = e.engine.advance({document, frame, false, {Signal::Motion}, {}});
        float largest = 0;
        const Image& motion = (*output->signals)[Signal::Motion];
        for (int y = 8; y < motion.height(); ++y)
            for (int x = 0; x < motion.width(); ++x) largest = std::max(largest, std::abs(motion.at(0, x, y)));
        return largest;
    };
    EXPECT_EQ(motionOf(0), 0);
    document.setText("camera.eye", "0.1,2,5");
    EXPECT_GT(motionOf(1), 0.05f);
    EXPECT_EQ(motionOf(2), 0) << "it stands still again";
}

}  // namespace
}  // namespace lumi::test
