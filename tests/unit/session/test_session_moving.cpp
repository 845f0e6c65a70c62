// What is seen while changes keep coming, and what a session tells of itself.
#include <nlohmann/json.hpp>
#include <set>

#include "session/replay.h"
#include "support/probe_module.h"
#include "support/session_test.h"

namespace lumi::test {
namespace {

using SessionMoving = SessionTest;

TEST_F(SessionMoving, SlowFramesHaveAPreviewWhileTheCameraMoves) {
    open();
    waitFor("some frames", [&] { return shownFrame() >= 3; });
    // Frames of many seconds, of which none is ever complete here.
    session.setAll({{"render.width", 800}, {"render.height", 600}, {"render.spp", 256}});
    std::set<float> seen;
    float fov = 30;
    Timer timer;
    while (seen.size() < 4 && timer.elapsedMs() < 120'000) {
        session.set("camera.fov-y-deg", fov = fov > 60 ? 30 : fov + 0.5f);
        std::this_thread::sleep_for(std::chrono::milliseconds(15));
        const auto snapshot = session.snapshot();
        if (!snapshot->preview) continue;
        seen.insert(snapshot->camera.halfHeight);
        EXPECT_EQ(snapshot->extent, (Extent2{800, 600}));
        EXPECT_LT(snapshot->traced.area(), snapshot->extent.area());
        EXPECT_EQ(snapshot->panes[0].pixels->extent, snapshot->extent);
        EXPECT_TRUE(snapshot->results.empty());
        EXPECT_LT(snapshot->revision, session.revision());
        EXPECT_TRUE(session.inspect(*snapshot, {3, 4}).empty());
    }
    EXPECT_EQ(seen.size(), 4u) << "previews of moving cameras";
    session.setAll({{"render.width", 16}, {"render.height", 12}, {"render.spp", 1}});
    waitFor("whole frames", [&] { return !session.snapshot()->preview && session.snapshot()->extent.width == 16; });
}

TEST_F(SessionMoving, PreviewsLeaveNoTrace) {
    open();
    waitFor("some frames", [&] { return shownFrame() >= 2; });
    pause();
    session.setAll({{"render.width", 160}, {"render.height", 120}, {"render.spp", 64}});
    bool previewed = false;
    float fov = 30;
    for (const Timer timer; !previewed && timer.elapsedMs() < 60'000; previewed = session.snapshot()->preview) {
        session.set("camera.fov-y-deg", fov = fov > 60 ? 30 : fov + 0.5f);
        std::this_thread::sleep_for(std::chrono::milliseconds(15));
    }
    EXPECT_TRUE(previewed);
    waitFor("the whole frame", [&] { return session.snapshot()->revision == session.revision(); });
    const auto snapshot = session.snapshot();
    const Replay replay = parseReplay(session.stateJson(), "state");
    MessageLog messages;
    Document document(session.document().loadedScene());
    document.apply(replay.start);
    FrameEngine engine(messages);
    std::optional<FrameOutput> frame;
    for (FrameNumber number = replay.first; number <= replay.last; ++number) {
        if (const auto values = replay.valuesOf(number)) document.apply(*values);
        frame = engine.advance({document, number, number == replay.first, {}, {}});
    }
    EXPECT_EQ(*snapshot->results.at("accumulate"), *frame->results.at("accumulate"));
}

TEST_F(SessionMoving, AnEditDuringAStepBackKeepsTheTimeThatWasSteppedTo) {
    open({{"view.0.module", "probe"}, {"render.fps", "10"}});
    session.setPlaying(true);
    waitFor("time to go on", [&] { return session.snapshot()->time > 0.25f; });
    pause();
    const float late = session.document().time();
    ProbeModule::holds = true;
    session.stepBack();
    waitFor("the replay", [] { return ProbeModule::isHeld.load(); });
    session.setText("path.max-depth", "2");
    ProbeModule::holds = false;
    waitFor("a frame with it", [&] { return session.snapshot()->revision == session.revision(); });
    EXPECT_EQ(session.document().path().maxDepth, 2);
    EXPECT_LT(session.document().time(), late - 0.05f);
    EXPECT_EQ(session.snapshot()->time, session.document().time());
}

TEST_F(SessionMoving, TimeThatPlaysIsThatOfRenderedFrames) {
    session.setRendering(false);
    open({{"render.fps", "24"}});
    session.setPlaying(true);
    session.setRendering(true);
    waitFor("some frames", [&] { return shownFrame() >= 6; });
    const auto snapshot = session.snapshot();
    EXPECT_EQ(snapshot->time, static_cast<float>(static_cast<double>(snapshot->frame) / 24));
    EXPECT_GT(snapshot->framesPerSecond, 0);
}

TEST_F(SessionMoving, BeginsAgainAtAnyFrame) {
    open();
    pause();
    session.restart(7);
    // A slow pause may have left the frame 7 of the first run on view.
    waitFor("frame 7", [&] { return shownFrame() == 7 && session.snapshot()->accumulatedSamples == 1; });
    EXPECT_EQ(parseReplay(session.stateJson(), "state").first, 7);
    session.step();
    waitFor("frame 8", [&] { return shownFrame() == 8; });
    session.restart();
    session.step();
    waitFor("the step after the restart", [&] { return shownFrame() == 1; });
}

TEST_F(SessionMoving, ChecksTheSignalsOfAScene) {
    session.setCheckingScenes(true);
    EXPECT_EQ(session.signalCheck(), nullptr);
    open();
    waitFor("the check", [&] { return session.signalCheck() != nullptr; });
    const auto check = session.signalCheck();
    EXPECT_TRUE(check->holds()) << check->failure << check->brokenRules();
    EXPECT_EQ(check->frames.size(), 2u);
    waitFor("frames to go on", [&, frame = shownFrame()] { return shownFrame() > frame; });
    session.setText("view.0.exposure", "1");
    EXPECT_EQ(session.signalCheck(), check) << "what is traced is what was checked";
    session.setText("camera.fov-y-deg", "30");
    EXPECT_EQ(session.signalCheck(), nullptr) << "something else is traced now";
    session.checkSignals();
    waitFor("the check of what was changed", [&] { return session.signalCheck() != nullptr; });
    session.open(kCornell);
    waitFor("the scene to be another", [&] { return session.signalCheck() != check; });
    session.checkSignals();
    waitFor("another check", [&] { return session.signalCheck() != nullptr && !session.checkingSignals(); });
}

}  // namespace
}  // namespace lumi::test
