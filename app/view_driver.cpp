#include "app/view_driver.h"

#include <algorithm>
#include <chrono>
#include <functional>
#include <nlohmann/json.hpp>
#include <thread>

#include "base/error.h"
#include "base/files.h"
#include "image/png.h"
#include "session/export.h"

namespace lumi {

namespace {

constexpr float kFrameSeconds = 1.0f / 60;
constexpr double kLongestWaitMs = 180e3;

float number(const ScriptLine& line, size_t index) {
    const std::string& text = line.arguments.at(index);
    try {
        size_t used = 0;
        const float value = std::stof(text, &used);
        if (used == text.size()) return value;
    } catch (const std::exception&) {
    }
    throwBadInput({.what = "not a number", .where = line.where, .found = '"' + text + '"'});
}

MouseButton button(const ScriptLine& line) {
    const std::string& name = line.arguments[0];
    if (name == "left") return MouseButton::Left;
    if (name == "right") return MouseButton::Right;
    if (name == "middle") return MouseButton::Middle;
    throwBadInput(
        {.what = "no such mouse button", .where = line.where, .expected = "left, right or middle", .found = name});
}

KeyChord chordOf(const ScriptLine& line) {
    const auto chord = parseChord(line.arguments[0]);
    if (!chord) throwBadInput({.what = "no such key", .where = line.where, .found = '"' + line.arguments[0] + '"'});
    return *chord;
}

/// By instance: the pinned pixel, and its rows.
nlohmann::json lineageJson(const AppState& state) {
    nlohmann::json all = nlohmann::json::object();
    if (!state.snapshot) return all;
    for (const auto& [instance, lineage] : state.snapshot->lineages) {
        nlohmann::json& one = all[instance];
        one["pixel"] = {lineage.pixel.x, lineage.pixel.y};
        one["rows"] = nlohmann::json::array();
        for (const Lineage::Row& row : lineage.rows)
            one["rows"].push_back(
                {{"stage", row.stage}, {"at", {row.at.x, row.at.y}}, {"weight", row.weight}, {"verdict", row.verdict}});
    }
    return all;
}

}  // namespace

ViewDriver::ViewDriver(const ViewOptions& options)
    : options_(options),
      context_(createHeadlessContext()),
      session_(log_),
      interface_(context_->gl(), session_, log_),
      startCheck_(session_, log_, options.start),
      size_(options.size) {
    interface_.uiMap().setEnabled(true);
    interface_.state().captures = options.out;
    openAtStart(session_, interface_.state(), options.start);
}

void ViewDriver::build(int frames) {
    startCheck_.check();
    for (int i = 0; i < frames; ++i, ++frames_) {
        interface_.setScale(scale_);
        interface_.build(size_, kFrameSeconds);
        AppState& state = interface_.state();
        if (firstImageS_ < 0 && state.snapshot) firstImageS_ = sinceStart_.elapsedMs() * 1e-3;
        if (state.windowShotWanted) {
            state.windowShotWanted = false;
            shot("window");
        }
    }
}

void ViewDriver::settle() {
    do build();
    while (!interface_.input().empty());
    build();
}

void ViewDriver::wait(const ScriptLine& line, const std::function<bool()>& until) {
    waitUntil(line.command + ' ' + line.rest, line.where, until);
}

void ViewDriver::waitUntil(const std::string& what, const std::string& where, const std::function<bool()>& until) {
    const Timer timer;
    while (!until()) {
        if (timer.elapsedMs() > kLongestWaitMs)
            throw Error(ErrorKind::CheckFailed, {.what = "waited too long for \"" + what + '"', .where = where});
        build();
        std::this_thread::sleep_for(std::chrono::milliseconds(8));
    }
    build(2);
}

Vec2 ViewDriver::centreOf(const ScriptLine& line, const std::string& name) {
    settle();
    const auto item = interface_.uiMap().find(name);
    if (item) return item->centre();
    std::vector<std::string> names;
    for (const UiMap::Item& known : interface_.uiMap().items()) names.push_back(known.name);
    const std::string nearest = nearestName(name, names);
    throwBadInput({.what = "nothing on the screen is called \"" + name + '"' +
                           (nearest.empty() ? "" : "; did you mean \"" + nearest + "\"?"),
                   .where = line.where});
}

void ViewDriver::pointer(const ScriptLine& line) {
    InputQueue& input = interface_.input();
    if (line.command == "mouse") input.add(MouseMoved{{number(line, 0), number(line, 1)}});
    if (line.command == "hover") input.add(MouseMoved{centreOf(line, line.rest)});
    if (line.command == "press") input.add(MouseButtonChanged{button(line), true});
    if (line.command == "release") input.add(MouseButtonChanged{button(line), false});
    if (line.command == "wheel") input.add(WheelTurned{{0, number(line, 0)}});
    settle();
}

void ViewDriver::click(const ScriptLine& line, int times) {
    interface_.input().add(MouseMoved{centreOf(line, line.rest)});
    settle();
    for (int i = 0; i < times; ++i) {
        interface_.input().add(MouseButtonChanged{MouseButton::Left, true});
        interface_.input().add(MouseButtonChanged{MouseButton::Left, false});
    }
    settle();
}

void ViewDriver::drag(const ScriptLine& line) {
    constexpr int kSteps = 8;
    const Vec2 from = centreOf(line, line.arguments[0]), by(number(line, 1), number(line, 2));
    InputQueue& input = interface_.input();
    input.add(MouseMoved{from});
    settle();
    input.add(MouseButtonChanged{MouseButton::Left, true});
    build();
    for (int step = 1; step <= kSteps; ++step) {
        input.add(MouseMoved{from + by * (static_cast<float>(step) / kSteps)});
        build();
    }
    input.add(MouseButtonChanged{MouseButton::Left, false});
    settle();
}

void ViewDriver::keys(const ScriptLine& line) {
    const KeyChord chord = chordOf(line);
    if (line.command == "lift") {
        strike(chord.key, false);
        settle();
        return;
    }
    if (chord.control) strike(Key::LeftControl, true);
    if (chord.shift) strike(Key::LeftShift, true);
    if (chord.alt) strike(Key::LeftAlt, true);
    strike(chord.key, true);
    build();
    if (line.command == "hold") return;
    strike(chord.key, false);
    if (chord.control) strike(Key::LeftControl, false);
    if (chord.shift) strike(Key::LeftShift, false);
    if (chord.alt) strike(Key::LeftAlt, false);
    settle();
}

void ViewDriver::waits(const ScriptLine& line) {
    const AppState& state = interface_.state();
    if (line.command == "wait-load") {
        wait(line, [&] {
            if (session_.loadStatus().loading) return false;
            // A failed load with nothing to show will never draw.
            for (const Message& message : log_.messages())
                if (message.severity == Severity::Error && !session_.hasScene())
                    throw Error(ErrorKind::BadInput, {.what = message.text});
            build();  // the document that the load left, not the one before
            return state.snapshot && state.document.scene() && state.snapshot->scene &&
                   state.snapshot->scene->scene->path == state.document.scene()->path;
        });
        if (!options_.buffers.empty())  // refused before anything is drawn for it
            BufferSelection::parse(options_.buffers, state.module(0), "--buffers");
    } else if (line.command == "wait-shown") {
        wait(line, [&] { return state.snapshot && state.snapshot->revision >= session_.revision(); });
    } else if (line.command == "wait-frames") {
        const FrameNumber from = state.snapshot ? state.snapshot->frame : -1;
        const auto more = static_cast<FrameNumber>(number(line, 0));
        wait(line,
             [&] { return state.snapshot && (state.snapshot->frame >= from + more || state.snapshot->frame < from); });
    } else if (line.command == "wait-frame") {
        const auto wanted = static_cast<FrameNumber>(number(line, 0));
        wait(line, [&] { return state.snapshot && !state.snapshot->preview && state.snapshot->frame == wanted; });
    } else if (line.command == "wait-signals") {
        wait(line, [&] { return session_.signalCheck() && !session_.checkingSignals(); });
    } else if (line.command == "wait-metrics") {
        wait(line, [&] {
            const auto measured = state.metrics.latest();
            return measured && state.snapshot && measured->serial == state.snapshot->serial &&
                   measured->problem.empty() && state.referencePictures.current() &&
                   (state.errorMap.empty() || (!measured->panes.empty() && measured->panes[0].map));
        });
    } else if (line.command == "wait-spp") {
        const auto samples = static_cast<uint64_t>(number(line, 0));
        // What does not accumulate has as many samples as its frames.
        wait(line, [&] {
            if (!state.snapshot || state.snapshot->preview) return false;
            const auto perFrame = static_cast<uint64_t>(state.document.number("render.spp", 1));
            const auto traced = static_cast<uint64_t>(state.snapshot->frame + 1) * perFrame;
            return std::max(state.snapshot->accumulatedSamples, state.snapshot->accumulatedSamples ? 0 : traced) >=
                   samples;
        });
    } else {
        wait(line, [&] {
            const std::vector<Message> messages = log_.messages();
            return std::any_of(messages.begin(), messages.end(),
                               [&](const Message& m) { return m.text.find(line.rest) != std::string::npos; });
        });
    }
}

void ViewDriver::shot(const std::string& name) {
    if (!framebuffer_ || !(framebuffer_->extent() == size_))
        framebuffer_ = std::make_unique<Framebuffer>(context_->gl(), size_);
    framebuffer_->bind();
    interface_.draw(size_);
    files_.push_back(options_.out / (name + ".png"));
    writePng(files_.back(), framebuffer_->read());
    if (!options_.buffers.empty() && interface_.state().snapshot) saveBuffers(options_.out / (name + ".exr"));
}

void ViewDriver::run(const ScriptLine& line) {
    const std::string& c = line.command;
    say(line.where + "  " + c + ' ' + line.rest);
    if (c == "size") {
        size_ = {static_cast<int>(number(line, 0)), static_cast<int>(number(line, 1))};
        if (size_.empty() || size_.width > 16384 || size_.height > 16384)
            throwBadInput(
                {.what = "size is out of range", .where = line.where, .expected = "1 to 16384", .found = line.rest});
        settle();
    } else if (c == "scale") {
        scale_ = std::clamp(number(line, 0), 0.5f, 4.0f);
        settle();
    } else if (c == "mouse" || c == "hover" || c == "press" || c == "release" || c == "wheel") {
        pointer(line);
    } else if (c == "click" || c == "double-click") {
        click(line, c == "click" ? 1 : 2);
    } else if (c == "drag") {
        drag(line);
    } else if (c == "key" || c == "hold" || c == "lift") {
        keys(line);
    } else if (c == "text") {
        interface_.input().add(TextTyped{line.rest});
        settle();
    } else if (c == "drop") {
        interface_.input().add(FilesDropped{{line.rest}});
        settle();
    } else if (c == "set") {
        session_.setText(line.arguments[0],
                         line.rest.substr(line.rest.find(line.arguments[1], line.arguments[0].size())));
        session_.endEdit();
        settle();
    } else if (c == "pause") {
        build(static_cast<int>(number(line, 0)));
    } else if (c == "shot") {
        settle();
        shot(line.rest);
    } else if (c == "dump-ui") {
        settle();
        files_.push_back(options_.out / (line.rest + ".json"));
        writeFileAtomically(files_.back(), interface_.uiMap().json());
    } else if (c == "dump-lineage") {
        settle();
        files_.push_back(options_.out / (line.rest + ".json"));
        writeFileAtomically(files_.back(), lineageJson(interface_.state()).dump(1) + "\n");
    } else {
        waits(line);
    }
}

void ViewDriver::finish() { build(2); }

nlohmann::json ViewDriver::report() const {
    const AppState& state = interface_.state();
    nlohmann::json report;
    report["files"] = nlohmann::json::array();
    for (const auto& file : files_) report["files"].push_back(file.string());
    report["context"] = context_->description();
    report["first_image_s"] = firstImageS_;
    report["ui_frames"] = frames_;
    report["ui_ms"] = {{"median", state.timing.median()}, {"p99", state.timing.p99()}, {"worst", state.timing.worst()}};
    report["engine_frames"] = state.snapshot ? state.snapshot->frame + 1 : 0;
    report["warnings"] = log_.warnings();
    report["errors"] = nlohmann::json::array();
    for (const Message& message : log_.messages())
        if (message.severity == Severity::Error) report["errors"].push_back(message.text);
    return report;
}

}  // namespace lumi
