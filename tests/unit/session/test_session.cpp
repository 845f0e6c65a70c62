#include "session/session.h"

#include <gtest/gtest.h>

#include <chrono>
#include <functional>
#include <nlohmann/json.hpp>
#include <thread>

#include "base/files.h"
#include "base/timer.h"
#include "scene/load.h"
#include "session/export.h"
#include "session/replay.h"
#include "support/expect_error.h"
#include "support/session_test.h"
#include "support/temporary_folder.h"

namespace lumi::test {
namespace {

TEST_F(SessionTest, StartsEmptyAndRefusesChanges) {
    EXPECT_FALSE(session.hasScene());
    EXPECT_EQ(session.snapshot(), nullptr);
    expectError(ErrorKind::Usage, [&] { session.setText("path.max-depth", "2"); }, {"no scene"});
    EXPECT_FALSE(session.undo());
}

TEST_F(SessionTest, DrawsProgressively) {
    open();
    EXPECT_TRUE(session.hasScene());
    waitFor("8 samples", [&] { return session.snapshot()->accumulatedSamples >= 8; });
    const auto snapshot = session.snapshot();
    EXPECT_EQ(snapshot->extent, (Extent2{32, 24}));
    ASSERT_EQ(snapshot->panes.size(), 1u);
    EXPECT_EQ(snapshot->panes[0].pixels->extent, snapshot->extent);
    EXPECT_EQ(snapshot->panes[0].module, "accumulate");
    EXPECT_GT(snapshot->rays.total(), 0u);
    EXPECT_GT(snapshot->raysPerSecond, 0);
}

TEST_F(SessionTest, ASnapshotNeverChanges) {
    open();
    const auto snapshot = session.snapshot();
    const Image image = *snapshot->results.at("accumulate"), noisy = (*snapshot->signals)[Signal::Noisy];
    const auto pixels = snapshot->panes[0].pixels->rgba;
    waitFor("more frames", [&] { return session.snapshot()->serial > snapshot->serial + 6; });
    EXPECT_EQ(*snapshot->results.at("accumulate"), image);
    EXPECT_EQ((*snapshot->signals)[Signal::Noisy], noisy);
    EXPECT_EQ(snapshot->panes[0].pixels->rgba, pixels);
}

TEST_F(SessionTest, AChangeIsTakenUpAndBeginsAgain) {
    open();
    waitFor("some samples", [&] { return session.snapshot()->accumulatedSamples >= 5; });
    const uint64_t revision = session.revision();
    session.setText("camera.fov-y-deg", "20");
    EXPECT_GT(session.revision(), revision);
    EXPECT_EQ(session.document().camera().fovYDeg, 20);
    const float halfHeight = std::tan(radians(10));
    waitFor("the new view", [&] { return std::abs(session.snapshot()->camera.halfHeight - halfHeight) < 1e-4f; });
    expectError(ErrorKind::Usage, [&] { session.setText("camera.fov", "20"); }, {"camera.fov"});
}

TEST_F(SessionTest, AChangeAbandonsTheFrameInFlight) {
    open();
    // Frames of some seconds: without abandoning them the changes below would take a minute.
    session.setAll({{"render.width", 640}, {"render.height", 480}, {"render.spp", 64}});
    Timer timer;
    double slowestMs = 0;
    for (int change = 0; change < 6; ++change) {
        std::this_thread::sleep_for(std::chrono::milliseconds(200));
        const uint64_t before = session.abandonedFrames();
        timer.restart();
        session.set("render.seed", 10 + change);
        // Between a preview and the whole frame there is nothing to give up: then once more.
        waitFor("the frame to be given up", [&, again = 0]() mutable {
            if (timer.elapsedMs() > 400) {
                session.set("render.seed", 100 + again++);
                timer.restart();
            }
            return session.abandonedFrames() > before;
        });
        slowestMs = std::max(slowestMs, timer.elapsedMs());
    }
    RecordProperty("slowestAbandonMs", std::to_string(slowestMs));
    std::printf("    slowest abandoned frame: %.1f ms\n", slowestMs);
    // In a stream of changes a frame may go on or a preview take its place, but not for long once the stream ends.
    for (int change = 0; change < 5; ++change) {
        session.set("render.seed", 20 + change);
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    session.setAll({{"render.width", 16}, {"render.height", 12}, {"render.spp", 1}});
    timer.restart();
    waitFor("small frames", [&] {
        const auto snapshot = session.snapshot();
        EXPECT_FALSE(snapshot->extent.width == 640 && !snapshot->preview) << "a frame of seconds was drawn to its end";
        return snapshot->extent.width == 16;
    });
    std::printf("    the last of a stream is seen after %.1f ms\n", timer.elapsedMs());
}

TEST_F(SessionTest, DisplayChangesDoNotRenderAgain) {
    open();
    pause();
    const auto before = session.snapshot();
    session.setText("view.0.exposure", "2");
    waitFor("the brighter picture", [&] { return session.snapshot()->serial > before->serial; });
    const auto after = session.snapshot();
    EXPECT_EQ(after->frame, before->frame);
    EXPECT_EQ(after->signals, before->signals);
    EXPECT_EQ(after->results.at("accumulate"), before->results.at("accumulate"));
    EXPECT_NE(after->panes[0].pixels->rgba, before->panes[0].pixels->rgba);
}

TEST_F(SessionTest, ModuleChangesWhilePausedKeepTheSamples) {
    open({{"camera.jitter", "per-pixel"}});
    pause();
    const auto before = session.snapshot();
    session.setText("view.0.module", "none");
    waitFor("the raw frame", [&] { return session.snapshot()->panes[0].module == "none"; });
    EXPECT_EQ(session.snapshot()->frame, before->frame);
    EXPECT_EQ(*session.snapshot()->results.at("none"), (*before->signals)[Signal::Noisy]);
}

TEST_F(SessionTest, PausedMeansPaused) {
    open();
    pause();
    const FrameNumber frame = shownFrame();
    session.step();
    waitFor("one frame", [&] { return shownFrame() == frame + 1; });
    pause();
    EXPECT_EQ(shownFrame(), frame + 1);
    EXPECT_FALSE(session.rendering());
}

TEST_F(SessionTest, StepBackShowsTheEarlierFrameBitForBit) {
    session.setRendering(false);
    open();
    ASSERT_EQ(shownFrame(), 0);
    std::vector<Image> images{result()};
    for (FrameNumber frame = 1; frame <= 4; ++frame) {
        if (frame == 3) {
            session.setText("camera.fov-y-deg", "30");
        } else {
            session.step();
        }
        waitFor("the next frame", [&] { return shownFrame() == frame; });
        images.push_back(result());
    }
    for (FrameNumber frame = 3; frame >= 0; --frame) {
        session.stepBack();
        waitFor("the frame before", [&] { return shownFrame() == frame; });
        EXPECT_EQ(result(), images[static_cast<size_t>(frame)]) << "frame " << frame;
    }
    session.stepBack();
    waitFor("the message", [&] { return logged("no earlier frame"); });
    for (FrameNumber frame = 1; frame <= 2; ++frame) {
        session.step();
        waitFor("forward again", [&] { return shownFrame() == frame; });
        EXPECT_EQ(result(), images[static_cast<size_t>(frame)]) << "forward to " << frame;
    }
}

TEST_F(SessionTest, RestartBeginsAtFrameZero) {
    open();
    waitFor("some frames", [&] { return shownFrame() >= 4; });
    pause();
    session.restart();
    waitFor("frame 0", [&] { return shownFrame() == 0; });
    EXPECT_EQ(session.snapshot()->accumulatedSamples, 1u);
}

TEST_F(SessionTest, RestsAtTheTarget) {
    open({{"accumulate.limit", "true"}, {"accumulate.max-samples", "6"}});
    waitFor("the target", [&] { return session.snapshot()->accumulatedSamples == 6; });
    EXPECT_EQ(session.snapshot()->targetSamples, 6u);
    waitFor("rest", [&] { return !session.busy(); });
    const uint64_t serial = session.snapshot()->serial;
    EXPECT_EQ(session.snapshot()->accumulatedSamples, 6u);
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    EXPECT_EQ(session.snapshot()->serial, serial) << "it goes on drawing";
    session.setText("accumulate.max-samples", "8");
    waitFor("the new target", [&] { return session.snapshot()->accumulatedSamples == 8; });
}

TEST_F(SessionTest, UndoTakesBackOneEditAtATime) {
    open();
    pause();
    const nlohmann::json start = session.document().changedValues();
    session.setText("path.max-depth", "3");
    session.endEdit();
    for (int i = 1; i <= 10; ++i) session.set("camera.fov-y-deg", 30.0f + static_cast<float>(i));  // a slider dragged
    session.endEdit();
    session.setText("light.lamp.power", "2");
    const nlohmann::json end = session.document().changedValues();
    EXPECT_TRUE(session.undo());
    EXPECT_EQ(session.document().scene()->lights[0].power, 1);
    EXPECT_TRUE(session.undo());
    EXPECT_FALSE(session.document().changedValues().contains("camera.fov-y-deg"));
    EXPECT_EQ(session.document().path().maxDepth, 3);
    EXPECT_TRUE(session.undo());
    EXPECT_EQ(session.document().changedValues(), start);
    EXPECT_FALSE(session.undo());
    while (session.redo()) {
    }
    EXPECT_EQ(session.document().changedValues(), end);
}

TEST_F(SessionTest, AFailedLoadKeepsTheScene) {
    open();
    TemporaryFolder folder;
    writeFileAtomically(folder / "broken.json", std::string_view("{\"version\": 1, \"camras\": {}}"));
    const auto scene = session.document().loadedScene();
    session.open(folder / "broken.json");
    waitFor("the message", [&] { return logged("broken.json"); });
    waitFor("the end of loading", [&] { return !session.loadStatus().loading; });
    EXPECT_EQ(session.document().loadedScene(), scene);
    const uint64_t serial = session.snapshot()->serial;
    waitFor("frames to go on", [&] { return session.snapshot()->serial > serial; });
}

TEST_F(SessionTest, ScenesCanBeLoadedAndCancelledAtWill) {
    open();
    for (int i = 0; i < 20; ++i) {
        session.open(kCornell, {}, {{"render.width", std::to_string(16 + i)}, {"render.height", "8"}});
        if (i % 3 == 0) session.cancelLoading();
        if (i % 4 == 0) session.setText("path.max-depth", "2");
        std::this_thread::sleep_for(std::chrono::milliseconds(i % 5));
    }
    waitFor("the last scene", [&] { return session.snapshot()->extent == Extent2{35, 8}; });
    EXPECT_FALSE(session.loadStatus().loading);
}

TEST_F(SessionTest, BuffersAndValues) {
    open({{"view.0.buffer", "normal"}});
    const auto buffers = session.buffers("accumulate");
    for (const char* name : {"image", "normal", "sampleCount", "objectId"})
        EXPECT_TRUE(std::any_of(buffers.begin(), buffers.end(), [&](const BufferEntry& b) { return b.name == name; }))
            << name;
    const auto snapshot = session.snapshot();
    const std::vector<PixelValue> values = session.inspect(*snapshot, {3, 4});
    const auto normal =
        std::find_if(values.begin(), values.end(), [](const PixelValue& v) { return v.buffer == "normal"; });
    ASSERT_NE(normal, values.end());
    EXPECT_EQ(normal->channels, "XYZ");
    EXPECT_EQ(normal->values[2], (*snapshot->signals)[Signal::Normal].at(2, 3, 4));
    EXPECT_TRUE(session.inspect(*snapshot, {-1, 0}).empty());
    EXPECT_TRUE(session.inspect(*snapshot, {0, 24}).empty());
}

TEST_F(SessionTest, TwoViewsShowTheSameSamples) {
    open();
    session.setText("view.layout", "wipe");
    waitFor("two panes", [&] { return session.snapshot()->panes.size() == 2; });
    const auto snapshot = session.snapshot();
    EXPECT_EQ(snapshot->panes[1].module, "none");
    EXPECT_EQ(*snapshot->results.at("none"), (*snapshot->signals)[Signal::Noisy]);
}

/// What `render --replay` does.
void replayTo(const std::filesystem::path& path, const Replay& replay) {
    MessageLog log;
    Document document(loadScene(kCornell, log));
    document.apply(replay.start);
    FrameEngine engine(log);
    StateLog states(replay.scene);
    const OutputChoice choice = OutputChoice::parse(replay.output, "");
    const std::string instance = document.view(choice.view).module;
    const BufferSelection buffers = BufferSelection::parse(choice.buffers, instance, "");
    for (FrameNumber number = replay.first; number <= replay.last; ++number) {
        if (const auto values = replay.valuesOf(number)) document.apply(*values);
        const auto frame =
            engine.advance({document, number, number == replay.first, buffers.signals, {{instance, buffers.taps}}});
        states.record(*frame, std::make_shared<Document>(document));
        if (number == replay.last) exportView(path, *frame, document, choice, states.json(choice.json()));
    }
}

TEST_F(SessionTest, SavedPicturesReplay) {
    open();
    TemporaryFolder folder;
    waitFor("some samples", [&] { return session.snapshot()->accumulatedSamples >= 4; });
    session.setText("camera.fov-y-deg", "30");
    waitFor("some more", [&] { return session.snapshot()->accumulatedSamples >= 3; });
    session.saveView(0, folder / "shot.png");
    session.saveView(0, folder / "shot.exr");
    session.saveView(0, folder / "shot.gif");
    waitFor("the files", [&] {
        return logged("Saved " + (folder / "shot.png").string()) && logged("Saved " + (folder / "shot.exr").string()) &&
               logged("shot.gif: ");
    });
    for (const char* name : {"shot.png", "shot.exr"}) {
        const Replay replay = readReplay(folder / name);
        EXPECT_EQ(replay.scene.name, "cornell") << name;
        replayTo(folder / (std::string("again-") + name), replay);
        EXPECT_EQ(readFile(folder / name), readFile(folder / (std::string("again-") + name))) << name;
    }
}

TEST_F(SessionTest, TellsWhichSurfaceIsSeen) {
    open({{"camera.jitter", "none"}, {"view.0.buffer", "position"}});
    pause();
    const Pixel pixel{7, 11};
    std::future<std::optional<Vec3>> answer = session.surfaceAt(pixel);
    ASSERT_EQ(answer.wait_for(std::chrono::minutes(4)), std::future_status::ready);
    const std::optional<Vec3> point = answer.get();
    ASSERT_TRUE(point.has_value());
    const Image& position = (*session.snapshot()->signals)[Signal::Position];
    for (int c = 0; c < 3; ++c) EXPECT_NEAR((*point)[c], position.at(c, pixel.x, pixel.y), 1e-4f) << c;
    EXPECT_FALSE(session.surfaceAt({-1, 0}).get().has_value());
}

TEST_F(SessionTest, AResetIsOneStepOfUndo) {
    open();
    session.setAll({{"path.max-depth", 2}, {"camera.fov-y-deg", 30.0f}});
    session.endEdit();
    session.reset({"path.max-depth", "camera.fov-y-deg"});
    EXPECT_EQ(session.document().changedValues().count("camera.fov-y-deg"), 0u);
    EXPECT_TRUE(session.undo());
    EXPECT_EQ(session.document().path().maxDepth, 2);
    EXPECT_EQ(session.document().camera().fovYDeg, 30);
    expectError(ErrorKind::Usage, [&] { session.reset({"path.max-dept"}); }, {"path.max-depth"});
}

TEST_F(SessionTest, PlayingAdvancesTime) {
    open({{"render.fps", "50"}});
    session.setPlaying(true);
    waitFor("time", [&] { return session.snapshot()->time > 0.1f; });
    pause();
    const auto a = session.snapshot();
    session.step();
    waitFor("a frame", [&] { return session.snapshot()->frame == a->frame + 1; });
    EXPECT_NEAR(session.snapshot()->time - a->time, 0.02f, 1e-4f);
    EXPECT_EQ(session.document().time(), session.snapshot()->time);
}

}  // namespace
}  // namespace lumi::test
