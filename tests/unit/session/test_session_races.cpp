// What happens when two things that a user asks for meet in the middle of a frame.
#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>

#include "image/exr.h"
#include "session/replay.h"
#include "support/probe_module.h"
#include "support/session_test.h"
#include "support/temporary_folder.h"

namespace lumi::test {
namespace {

class SessionRaces : public SessionTest {
protected:
    ~SessionRaces() override { ProbeModule::holds = false; }

    void openWithProbe() {
        open({{"view.0.module", "probe"}});
        waitFor("some frames", [&] { return shownFrame() >= 4; });
    }
    /// The frame that is drawn next stays in its module until release().
    void hold() {
        ProbeModule::holds = true;
        waitFor("the frame to be held", [] { return ProbeModule::isHeld.load(); });
    }
    void release() { ProbeModule::holds = false; }
    void loadMeanwhile(const std::string& width) {
        session.open(kCornell, {}, {{"render.width", width}, {"render.height", "8"}, {"view.0.module", "probe"}});
        waitFor("the scene", [&] { return !session.loadStatus().loading; });
    }
    Replay state() { return parseReplay(session.stateJson(), "state"); }
};

TEST_F(SessionRaces, AFrameOfASceneThatIsGoneIsDropped) {
    openWithProbe();
    hold();
    session.setRendering(false);
    loadMeanwhile("20");
    release();
    waitFor("the new scene", [&] { return session.snapshot()->extent.width == 20; });
    EXPECT_EQ(shownFrame(), 0);
    session.stepBack();
    waitFor("the message", [&] { return logged("no earlier frame"); });
    EXPECT_EQ(state().start.at("render.width"), 20);
}

TEST_F(SessionRaces, ASceneThatArrivesDuringAStepBackStays) {
    openWithProbe();
    pause();
    ProbeModule::holds = true;
    session.stepBack();
    waitFor("the replay", [] { return ProbeModule::isHeld.load(); });
    loadMeanwhile("20");
    release();
    waitFor("the new scene", [&] { return session.snapshot()->extent.width == 20; });
    EXPECT_EQ(session.document().render().width, 20);
    EXPECT_EQ(state().start.at("render.width"), 20);
    EXPECT_EQ(state().last, 0);
}

TEST_F(SessionRaces, ASceneThatArrivesDuringASaveLeavesTheFileWhole) {
    TemporaryFolder folder;
    openWithProbe();
    pause();
    const FrameNumber saved = shownFrame();
    ProbeModule::holds = true;
    session.saveView(0, folder / "shot.exr");
    waitFor("the save", [] { return ProbeModule::isHeld.load(); });
    loadMeanwhile("20");
    release();
    waitFor("the file", [&] { return logged("Saved "); });
    EXPECT_EQ(readReplay(folder / "shot.exr").last, saved);
}

TEST_F(SessionRaces, AnEditDuringAStepBackIsKept) {
    openWithProbe();
    pause();
    const uint64_t abandoned = session.abandonedFrames();
    ProbeModule::holds = true;
    session.stepBack();
    waitFor("the replay", [] { return ProbeModule::isHeld.load(); });
    session.setText("path.max-depth", "2");
    release();
    waitFor("a frame with it", [&] { return session.snapshot()->revision == session.revision(); });
    EXPECT_EQ(session.document().path().maxDepth, 2);
    EXPECT_GT(session.abandonedFrames(), abandoned);
}

TEST_F(SessionRaces, APixelPinnedDuringAStepBackLeavesItAlone) {
    openWithProbe();
    pause();
    const FrameNumber before = shownFrame();
    const uint64_t abandoned = session.abandonedFrames();
    ProbeModule::holds = true;
    session.stepBack();
    waitFor("the replay", [] { return ProbeModule::isHeld.load(); });
    session.setInspectedPixel(Pixel{3, 4});
    session.setInspecting(true);
    release();
    waitFor("the end of it", [&] { return !session.busy(); });
    EXPECT_EQ(shownFrame(), before - 1);
    EXPECT_EQ(session.abandonedFrames(), abandoned);
    EXPECT_EQ(state().last, before - 1);
    const auto snapshot = session.snapshot();
    EXPECT_EQ(snapshot->lineages.count("probe"), 1u) << "and what was asked for is told of the frame stepped back to";
    EXPECT_TRUE(snapshot->signals->available().has(Signal::Position));
}

TEST_F(SessionRaces, AFrameSteppedBackToTellsOfThePinnedPixel) {
    openWithProbe();
    pause();
    session.setInspectedPixel(Pixel{3, 4});
    session.setInspecting(true);
    waitFor("the frame with it", [&] { return !session.busy(); });
    EXPECT_TRUE(session.snapshot()->signals->available().has(Signal::Position))
        << "drawn again, though rendering is paused";
    const FrameNumber before = shownFrame();
    session.stepBack();
    waitFor("the frame before", [&] { return !session.busy(); });
    EXPECT_EQ(shownFrame(), before - 1);
    EXPECT_EQ(session.snapshot()->lineages.count("probe"), 1u);
    EXPECT_TRUE(session.snapshot()->signals->available().has(Signal::Position));
}

TEST_F(SessionRaces, WhatAStepBackTakesBackCanBeUndone) {
    openWithProbe();
    pause();
    const int depth = session.document().path().maxDepth;
    session.setText("path.max-depth", "2");
    session.endEdit();
    waitFor("a frame with it", [&] { return !session.busy(); });
    session.stepBack();
    waitFor("the frame before", [&] { return !session.busy(); });
    EXPECT_EQ(session.document().path().maxDepth, depth);
    EXPECT_TRUE(session.undo());
    EXPECT_EQ(session.document().path().maxDepth, 2);
    EXPECT_TRUE(session.redo());
    EXPECT_EQ(session.document().path().maxDepth, depth);
    waitFor("the frames", [&] { return !session.busy(); });
    const FrameNumber frame = shownFrame();
    session.step();
    waitFor("a frame", [&] { return shownFrame() == frame + 1; });
    session.stepBack();
    waitFor("the frame before", [&] { return !session.busy(); });
    EXPECT_TRUE(session.undo());
    EXPECT_EQ(session.document().path().maxDepth, 2) << "a step back over no edit is no step of undo";
}

/// Files in a folder, by name.
std::vector<std::string> namesIn(const std::filesystem::path& folder) {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
        names.push_back(entry.path().filename().string());
    std::sort(names.begin(), names.end());
    return names;
}

TEST_F(SessionRaces, ACaptureIsNamedAfterWhatItHolds) {
    TemporaryFolder folder;
    openWithProbe();
    hold();
    session.captureView(0, folder / "c", "png");
    session.setText("view.0.module", "none");
    release();
    waitFor("the file", [&] { return logged("Saved "); });
    ASSERT_EQ(namesIn(folder.path()).size(), 1u);
    const std::string name = namesIn(folder.path())[0];
    const Replay replay = readReplay(folder / name);
    EXPECT_EQ(name, fmt::format("c.probe.image.{:04}.png", replay.last));
    for (const auto& [frame, values] : replay.sets)
        EXPECT_FALSE(values.contains("view.0.module")) << "saved before the change";
}

TEST_F(SessionRaces, CapturesOfOneFrameAreTwoFiles) {
    TemporaryFolder folder;
    openWithProbe();
    pause();
    const std::string name = fmt::format("c.probe.image.{:04}", shownFrame());
    for (int i = 0; i < 2; ++i) session.captureView(0, folder / "c", "png");
    session.captureView(0, folder / "c", "exr");
    waitFor("the files", [&] {
        return logged("Saved " + (folder / (name + ".png")).string()) &&
               logged("Saved " + (folder / (name + "-1.png")).string()) &&
               logged("Saved " + (folder / (name + ".exr")).string());
    });
    EXPECT_EQ(namesIn(folder.path()), (std::vector<std::string>{name + "-1.png", name + ".exr", name + ".png"}));
}

TEST_F(SessionRaces, WhatIsBeingSavedAtTheEndIsWritten) {
    TemporaryFolder folder;
    MessageLog messages;
    {
        std::jthread later;
        Session ending(messages);
        ending.open(kCornell, {}, {{"render.width", "32"}, {"render.height", "24"}, {"view.0.module", "probe"}});
        waitFor("a picture", [&] { return ending.snapshot() != nullptr; });
        ending.setRendering(false);
        ProbeModule::holds = true;
        ending.step();
        waitFor("the frame to be held", [] { return ProbeModule::isHeld.load(); });
        ending.saveView(0, folder / "last.png");
        later = std::jthread([this] {
            std::this_thread::sleep_for(std::chrono::milliseconds(50));
            release();
        });
        // The session ends here, while the frame is held.
    }
    EXPECT_TRUE(std::filesystem::exists(folder / "last.png"));
}

TEST_F(SessionRaces, TheSkyAskedForLastWins) {
    TemporaryFolder folder;
    const auto write = [&](const char* name, Extent2 extent) {
        Image sky(extent, 3);
        sky.fill(0.5f);
        ExrLayers layers;
        layers.add("", "RGB", sky);
        writeExr(folder / name, layers);
        return (folder / name).string();
    };
    const std::string slow = write("slow.exr", {2048, 1024}), quick = write("quick.exr", {4, 2});
    open();
    session.setText("environment.file", slow);
    session.setText("environment.file", quick);
    const auto present = [&] { return std::get<std::string>(session.document().get("environment.file")); };
    waitFor("the sky", [&] { return present() == quick; });
    std::this_thread::sleep_for(std::chrono::milliseconds(700));
    EXPECT_EQ(present(), quick);
    EXPECT_TRUE(session.undo());
    EXPECT_EQ(present(), "");
}

TEST_F(SessionRaces, ASkyThatArrivesLeavesWhatWasTurnedMeanwhile) {
    TemporaryFolder folder;
    Image sky({2048, 1024}, 3);
    sky.fill(0.5f);
    ExrLayers layers;
    layers.add("", "RGB", sky);
    writeExr(folder / "slow.exr", layers);
    open();
    session.setText("environment.file", (folder / "slow.exr").string());
    session.setText("environment.rotate-deg", "45");
    session.setText("environment.scale", "2");
    waitFor("the sky", [&] { return std::get<std::string>(session.document().get("environment.file")) != ""; });
    EXPECT_EQ(std::get<float>(session.document().get("environment.rotate-deg")), 45);
    EXPECT_EQ(std::get<float>(session.document().get("environment.scale")), 2);
}

TEST_F(SessionRaces, AResetOfTheVariantTakesTheOthersAlong) {
    TemporaryFolder folder;
    std::ofstream(folder / "scene.gltf")
        << R"({"asset": {"version": "2.0"}, "scenes": [{"nodes": []}, {"nodes": []}], "scene": 0})";
    session.open(folder / "scene.gltf", {.index = 1},
                 {{"render.width", "32"}, {"render.height", "24"}, {"path.max-depth", "2"}});
    waitFor("the scene", [&] { return session.snapshot() != nullptr; });
    ASSERT_EQ(session.document().sceneChoice().index, 1);
    session.reset({"path.max-depth", "render.width", "scene.index"});
    waitFor("the other scene", [&] { return session.document().sceneChoice().index == -1; });
    const Document fresh(session.document().loadedScene());
    EXPECT_EQ(session.document().path().maxDepth, fresh.path().maxDepth);
    EXPECT_EQ(session.document().render().width, fresh.render().width);
    EXPECT_EQ(session.document().render().height, 24) << "only what was asked for";
}

TEST_F(SessionRaces, UndoWhilePlayingLeavesTimeAlone) {
    open();
    session.setPlaying(true);
    session.setText("view.0.exposure", "1");
    session.endEdit();
    waitFor("time", [&] { return session.document().time() > 0.2f; });
    pause();
    const float time = session.document().time();
    EXPECT_TRUE(session.undo());
    EXPECT_EQ(session.document().view(0).display.exposureEv, session.document().view(1).display.exposureEv);
    EXPECT_EQ(session.document().time(), time);
    session.setText("time", "3");
    session.endEdit();
    EXPECT_TRUE(session.undo());
    EXPECT_EQ(session.document().time(), time) << "an edit of time itself is undone";
}

TEST_F(SessionRaces, ARefusedChangeLeavesTimeToGoOn) {
    open({{"render.fps", "50"}});
    pause();
    session.setPlaying(true);
    const float before = session.snapshot()->time;
    EXPECT_ANY_THROW(session.setAll({{"time", 9.0f}, {"no.such-id", 1}}));
    const FrameNumber frame = shownFrame();
    session.step();
    waitFor("a frame", [&] { return shownFrame() == frame + 1; });
    EXPECT_NEAR(session.snapshot()->time - before, 0.02f, 1e-4f);
}

}  // namespace
}  // namespace lumi::test
