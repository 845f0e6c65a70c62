#include "session/replay.h"

#include "base/files.h"
#include "support/expect_error.h"
#include "support/sky_file.h"
#include "support/temporary_folder.h"
#include "support/tiny_scene.h"

namespace lumi::test {
namespace {

/// Draws documents one after the other and keeps the log.
struct Recorder {
    MessageLog log;
    FrameEngine engine{log};
    StateLog states{SceneReference{"tiny", "0123456789abcdef"}};
    FrameOutput draw(const Document& document, FrameNumber frame) {
        std::optional<FrameOutput> output = engine.advance({document, frame, false, {Signal::Motion}, {}});
        states.record(*output, std::make_shared<Document>(document));
        return std::move(*output);
    }
};

/// The last frame of a state, drawn by a fresh engine.
FrameOutput replayed(const std::string& state, std::shared_ptr<const Scene> scene) {
    const Replay replay = parseReplay(state, "state");
    Document document(scene);
    document.apply(replay.start);
    MessageLog log;
    FrameEngine engine(log);
    std::optional<FrameOutput> output;
    for (FrameNumber frame = replay.first; frame <= replay.last; ++frame) {
        if (const auto values = replay.valuesOf(frame)) document.apply(*values);
        output = engine.advance({document, frame, frame == replay.first, {Signal::Motion}, {}});
    }
    return std::move(*output);
}

void expectSame(const FrameOutput& a, const FrameOutput& b) {
    EXPECT_EQ(a.number, b.number);
    for (const auto& [name, image] : a.results) EXPECT_EQ(*image, *b.results.at(name)) << name;
    EXPECT_EQ((*a.signals)[Signal::Motion], (*b.signals)[Signal::Motion]);
}

TEST(StateLog, ReplaysEachFrameBitForBit) {
    Recorder recorder;
    const auto scene = movingScene();
    Document document(scene);
    const std::pair<const char*, const char*> edits[] = {
        {"path.max-depth", "3"}, {"light.lamp.power", "2"},        {"camera.eye", "0.1,2,5"},
        {"view.layout", "wipe"}, {"accumulate.limit", "true"},     {"camera.select", "main"},
        {"render.width", "19"},  {"accumulate.reset", "cut-only"}, {"time", "0.01"},
        {"time", "0.02"},        {"view.0.module", "none"},        {"light.lamp.power", "1"}};
    FrameNumber frame = 0;
    for (const auto& [id, text] : edits) {
        document.setText(id, text);
        const FrameOutput moved = recorder.draw(document, frame++);
        expectSame(replayed(recorder.states.json(), scene), moved);
        const FrameOutput still = recorder.draw(document, frame++);
        expectSame(replayed(recorder.states.json(), scene), still);
    }
}

TEST(StateLog, BeginsWhereHistoryBegan) {
    Recorder recorder;
    Document document(tinyScene());
    for (FrameNumber frame = 0; frame < 5; ++frame) recorder.draw(document, frame);
    EXPECT_EQ(recorder.states.startOf(4), 0u);
    document.setText("camera.eye", "0,2,5.1");
    recorder.draw(document, 5);
    recorder.draw(document, 6);
    EXPECT_EQ(recorder.states.startOf(6), 4u) << "the frame before the move, which motion refers to";
    EXPECT_EQ(recorder.states.startOf(3), 0u);
    document.setText("render.width", "20");
    recorder.draw(document, 7);
    EXPECT_EQ(recorder.states.startOf(7), 7u) << "a cut";
}

TEST(StateLog, UnchangedFramesTakeNoSpace) {
    Recorder recorder;
    const Document document(tinyScene());
    recorder.draw(document, 0);
    recorder.draw(document, 1);
    const size_t length = recorder.states.json().size();
    for (FrameNumber frame = 2; frame < 9; ++frame) recorder.draw(document, frame);
    EXPECT_EQ(recorder.states.json().size(), length);
    EXPECT_EQ(recorder.states.runCount(), 1u);
}

/// Draws one frame after the other as time goes on by the clock.
void play(Recorder& recorder, Document& document, const Clock& clock, FrameNumber begin, FrameNumber end) {
    for (FrameNumber frame = begin; frame < end; ++frame) {
        document.setTime(clock.at(frame));
        recorder.draw(document, frame);
    }
}

TEST(StateLog, TimeThatGoesOnTakesNoSpace) {
    const auto scene = tinyScene();
    for (const Clock& clock : {Clock{0, 0, 60}, Clock{0, 0, 24}, Clock{0, 0.3f, 7}}) {
        Recorder recorder;
        Document document(scene);
        document.set("render.fps", clock.fps);
        document.setTime(clock.at(0));
        recorder.draw(document, 0);
        play(recorder, document, clock, 1, 11);
        const size_t length = recorder.states.json().size();
        play(recorder, document, clock, 11, 40);
        EXPECT_EQ(recorder.states.json().size(), length);
        EXPECT_LE(recorder.states.runCount(), 2u);
        EXPECT_EQ(recorder.states.size(), 40u);
        for (FrameNumber frame = 0; frame < 40; ++frame)
            EXPECT_EQ(recorder.states.entry(static_cast<size_t>(frame)).document->time(), clock.at(frame)) << frame;
        const Replay replay = parseReplay(recorder.states.json(), "state");
        Document again(scene);
        again.apply(replay.start);
        for (FrameNumber frame = replay.first; frame <= replay.last; ++frame) {
            if (const auto values = replay.valuesOf(frame)) again.apply(*values);
            EXPECT_EQ(again.time(), clock.at(frame)) << frame;
        }
        EXPECT_EQ(again.changedValues(), document.changedValues());
    }
}

TEST(StateLog, RunsBreakWhereSomethingElseChangesAndReplayBitForBit) {
    Recorder recorder;
    const auto scene = movingScene();
    Document document(scene);
    document.setText("accumulate.reset", "cut-only");
    const Clock clock{0, 0, document.render().fps};
    play(recorder, document, clock, 0, 6);
    document.setText("path.max-depth", "2");
    play(recorder, document, clock, 6, 12);
    const FrameOutput still = recorder.draw(document, 12);
    expectSame(replayed(recorder.states.json(), scene), still);
    document.setTime(0.4f);
    const FrameOutput jumped = recorder.draw(document, 13);
    expectSame(replayed(recorder.states.json(), scene), jumped);
    recorder.states.truncate(9);
    EXPECT_EQ(recorder.states.size(), 9u);
    EXPECT_EQ(recorder.states.entry(8).frame, 8);
    EXPECT_EQ(parseReplay(recorder.states.json(), "state").last, 8);
    Recorder shorter;
    Document other(scene);
    other.setText("accumulate.reset", "cut-only");
    play(shorter, other, clock, 0, 6);
    other.setText("path.max-depth", "2");
    play(shorter, other, clock, 6, 8);
    other.setTime(clock.at(8));
    const FrameOutput eighth = shorter.draw(other, 8);
    expectSame(replayed(recorder.states.json(), scene), eighth);
}

TEST(StateLog, AReplacedFrameIsToldOnce) {
    Recorder recorder;
    Document document(tinyScene());
    recorder.draw(document, 0);
    recorder.draw(document, 1);
    document.setText("accumulate.limit", "true");
    recorder.draw(document, 1);
    EXPECT_EQ(recorder.states.size(), 2u);
    EXPECT_NE(recorder.states.json().find("accumulate.limit"), std::string::npos);
}

TEST(StateLog, HoldsWhatAReplayNeeds) {
    Recorder recorder;
    Document document(tinyScene());
    document.setText("render.seed", "3");
    recorder.draw(document, 4);
    const Replay replay = parseReplay(recorder.states.json({{"view", 0}}), "state");
    EXPECT_EQ(replay.scene.name, "tiny");
    EXPECT_EQ(replay.scene.digest, "0123456789abcdef");
    EXPECT_FALSE(replay.isa.empty());
    EXPECT_EQ(replay.first, 4);
    EXPECT_EQ(replay.last, 4);
    EXPECT_EQ(replay.start.at("render.seed"), 3);
    EXPECT_EQ(replay.output.at("view"), 0);
}

TEST(StateLog, TellsWhichSkyItWas) {
    TemporaryFolder folder;
    const auto write = [&](float radiance) { writeSky(folder / "sky.exr", radiance); };
    write(1);
    Recorder recorder;
    Document document(tinyScene());
    recorder.draw(document, 0);
    document.setText("environment.file", (folder / "sky.exr").string());
    const FrameOutput drawn = recorder.draw(document, 1);
    const std::string state = recorder.states.json();
    expectSame(replayed(state, document.loadedScene()), drawn);
    write(2);
    expectError(ErrorKind::BadInput, [&] { replayed(state, document.loadedScene()); }, {"sky.exr", "changed"});
}

TEST(StateLog, EveryFrameThatDiffersIsTold) {
    constexpr int kFrames = 400;
    StateLog states(SceneReference{"tiny", "0123456789abcdef"});
    Document document(tinyScene());
    FrameOutput frame;
    for (frame.number = 0; frame.number < kFrames; ++frame.number) {
        document.set("render.seed", static_cast<int>(frame.number));
        states.record(frame, std::make_shared<Document>(document));
    }
    const Replay replay = parseReplay(states.json(), "state");
    EXPECT_EQ(replay.sets.size(), size_t(kFrames - 1));
    for (FrameNumber number = 1; number < kFrames; ++number)
        EXPECT_EQ(replay.valuesOf(number)->at("render.seed"), static_cast<int>(number));
}

TEST(StateLog, TruncatingNeverGrows) {
    Recorder recorder;
    const Document document(tinyScene());
    recorder.draw(document, 0);
    recorder.states.truncate(5);
    EXPECT_EQ(recorder.states.size(), 1u);
}

TEST(ReadReplay, RefusesWhatIsNoState) {
    TemporaryFolder folder;
    const auto refuse = [&](const std::string& text, const char* part) {
        expectError(ErrorKind::BadInput, [&] { parseReplay(text, "shot.png"); }, {"shot.png", part});
    };
    refuse("", "holds no state");
    refuse("[1]", "holds no state");
    refuse("{\"format\": 3}", "holds no state");
    refuse("{\"format\": \"lumiscope-state\", \"version\": 99}", "version");
    refuse("{\"format\": \"lumiscope-state\", \"version\": 1}", "\"scene\"");
    refuse(R"({"format": "lumiscope-state", "version": 1, "scene": {"name": 3}})", "\"name\"");
    refuse(R"({"format": "lumiscope-state", "version": 1, "scene": {"name": "a", "digest": "b"}, "isa": "v3",
               "start": {"frame": 5, "set": {}}, "frame": 2, "frames": []})",
           "order");
    refuse(R"({"format": "lumiscope-state", "version": 1, "scene": {"name": "a", "digest": "b"}, "isa": "v3",
               "start": {"frame": 0, "set": {"scene.index": "one"}}, "frame": 2, "frames": []})",
           "\"scene.index\"");
    refuse(R"({"format": "lumiscope-state", "version": 1, "scene": {"name": "a", "digest": "b"}, "isa": "v3",
               "start": {"frame": 0, "set": {"scene.index": 10000}}, "frame": 2, "frames": []})",
           "-1 to 9999");
    const std::string head =
        R"({"format": "lumiscope-state", "version": 1, "scene": {"name": "a", "digest": "b"}, "isa": "v3",
        "start": {"frame": 0, "set": {}}, "frame": 9, "frames": [)";
    refuse(head + R"({"frame": 1, "last": 4, "clock": {"frame": 0, "time": 0, "fps": 0}}]})", "clock");
    refuse(head + R"({"frame": 5, "last": 4, "clock": {"frame": 0, "time": 0, "fps": 60}}]})", "clock");
    refuse(head + R"({"frame": 1, "clock": {"frame": 0, "time": 0, "fps": 60}}]})", "\"last\"");
    refuse(head + R"({"frame": 3, "set": {}}, {"frame": 2, "set": {}}]})", "order");
    expectError(ErrorKind::BadInput, [&] { readReplay(folder / "missing.exr"); }, {"missing.exr", "no such file"});
    expectError(ErrorKind::BadInput, [&] { readReplay(folder / "notes.txt"); }, {"notes.txt"});
}

}  // namespace
}  // namespace lumi::test
