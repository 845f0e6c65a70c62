#include "session/state_log.h"

#include <algorithm>
#include <cassert>

#include "base/isa.h"
#include "params/json_text.h"

namespace lumi {
using nlohmann::json;
namespace {

constexpr const char* kFormat = "lumiscope-state";
constexpr int kVersion = 1;
/// Frames that can be stepped back to, unless the present one needs more.
constexpr size_t kKeptEntries = 4096;

/// Values as they stand in a state: with the content of a sky's file, where one was read. `whole`: all that differs
/// from the scene, else what differs from the frame before.
json stateValues(json values, const Document& document, bool whole) {
    if ((whole || values.contains("environment.file")) && !document.environmentDigest().empty())
        values[Document::kEnvironmentDigest] = document.environmentDigest();
    return values;
}

/// Clocks by which the document's frame is on time: from the first frame on, from the frame before, from its own.
std::vector<Clock> clocksOf(const StateLog::Entry& before, const StateLog::Entry& entry) {
    const float fps = entry.document->render().fps, time = entry.document->time();
    std::vector<Clock> clocks{{0, 0, fps}, {before.frame, before.document->time(), fps}, {entry.frame, time, fps}};
    std::erase_if(clocks, [&](const Clock& clock) { return clock.at(entry.frame) != time; });
    return clocks;
}

}  // namespace

size_t StateLog::size() const {
    return runs_.empty() ? 0 : static_cast<size_t>(runs_.back().number + runs_.back().count - forgotten_);
}

const StateLog::Run& StateLog::runOf(size_t index) const {
    assert(index < size());
    const uint64_t number = index + forgotten_;
    return *(std::upper_bound(runs_.begin(), runs_.end(), number,
                              [](uint64_t wanted, const Run& run) { return wanted < run.number; }) -
             1);
}

StateLog::Entry StateLog::entry(size_t index) const {
    const Run& run = runOf(index);
    const uint64_t within = index + forgotten_ - run.number;
    if (within == 0) return run.head;
    Entry entry{run.head.frame + static_cast<FrameNumber>(within), run.head.document, false, run.restDropped};
    if (run.moves) {
        auto document = std::make_shared<Document>(*run.head.document);
        document->setTime(run.clocks.front().at(entry.frame));
        entry.document = std::move(document);
    }
    return entry;
}

size_t StateLog::startOf(size_t index) const {
    const Run& run = runOf(index);
    const uint64_t number = index + forgotten_;
    // Where no module keeps history the frame before is run all the same: motion refers to it.
    const uint64_t start = number > run.number && run.restDropped ? number - 1 : run.start;
    return static_cast<size_t>(std::max(start, forgotten_) - forgotten_);
}

void StateLog::record(const FrameOutput& frame, std::shared_ptr<const Document> document) {
    if (!empty() && runs_.back().lastFrame() == frame.number) dropLast();
    add({frame.number, std::move(document), frame.changes.cut, frame.historyDropped});
    forgetOldest();
}

void StateLog::redescribeLast(std::shared_ptr<const Document> document) {
    if (empty()) return;
    Entry entry = last();
    entry.document = std::move(document);
    dropLast();
    add(std::move(entry));
}

/// Each entry is told once, when it comes: a state of n frames then costs n pieces of text, not n comparisons.
void StateLog::add(Entry entry) {
    Run run{std::move(entry), forgotten_ + size(), 1, 0, false, false, {}, nullptr};
    run.start = run.number;
    if (!empty()) {
        const Entry before = last();
        nlohmann::json set =
            run.head.document == before.document
                ? nlohmann::json::object()
                : stateValues(Document::difference(*before.document, *run.head.document), *run.head.document, false);
        if (extend(runs_.back(), before, run.head, set)) return;
        if (!run.head.cut) run.start = run.head.historyDropped ? run.number - 1 : startOf(size() - 1) + forgotten_;
        run.clocks = clocksOf(before, run.head);
        if (!set.empty()) run.set = std::make_shared<nlohmann::json>(std::move(set));
    } else {
        run.clocks = clocksOf(run.head, run.head);
    }
    runs_.push_back(std::move(run));
}

/// Takes an entry into the run that ends with `before`, if it goes on like it; `set` is what differs.
bool StateLog::extend(Run& run, const Entry& before, const Entry& entry, const nlohmann::json& set) {
    if (entry.cut || entry.frame != before.frame + 1) return false;
    if (run.count > 1 && entry.historyDropped != run.restDropped) return false;
    const bool moves = !set.empty();
    if (run.count > 1 && moves != run.moves) return false;
    if (moves) {
        if (set.size() != 1 || !set.contains("time")) return false;
        std::vector<Clock> clocks = run.clocks;
        std::erase_if(clocks, [&](const Clock& clock) { return clock.at(entry.frame) != entry.document->time(); });
        if (clocks.empty()) return false;
        run.clocks = std::move(clocks);
    }
    run.moves = moves;
    run.restDropped = entry.historyDropped;
    ++run.count;
    return true;
}

void StateLog::dropLast() {
    if (--runs_.back().count == 0) runs_.pop_back();
}

void StateLog::truncate(size_t count) {
    while (size() > count) {
        Run& run = runs_.back();
        run.count -= std::min<uint64_t>(run.count, size() - count);
        if (run.count == 0) runs_.pop_back();
    }
}

void StateLog::forgetOldest() {
    while (runs_.size() > 1 && size() > kKeptEntries) {
        const uint64_t oldest = runs_.front().count;
        if (startOf(size() - 1) < oldest || size() - oldest < kKeptEntries) return;
        forgotten_ += oldest;
        runs_.pop_front();
    }
}

/// What was done in the frames after entry number `first`, run by run.
nlohmann::json StateLog::framesFrom(uint64_t first) const {
    nlohmann::json frames = nlohmann::json::array();
    for (const Run& run : runs_) {
        if (run.number + run.count <= first + 1) continue;
        const bool whole = run.number > first;
        nlohmann::json told = nlohmann::json::object();
        if (whole && run.set) told["set"] = *run.set;
        const FrameNumber from =
            whole ? run.head.frame : run.head.frame + static_cast<FrameNumber>(first + 1 - run.number);
        if (run.moves) {
            const Clock& clock = run.clocks.front();
            told["last"] = run.lastFrame();
            told["clock"] = {{"frame", clock.frame}, {"time", clock.time}, {"fps", clock.fps}};
        }
        if (told.empty()) continue;
        told["frame"] = from;
        frames.push_back(std::move(told));
    }
    return frames;
}

std::string StateLog::json(const nlohmann::json& output) const {
    const size_t present = size() - 1, first = startOf(present);
    const Entry begin = entry(first);
    const nlohmann::json start = stateValues(begin.document->changedValues(), *begin.document, true);
    const nlohmann::json state = {
        {"format", kFormat},
        {"version", kVersion},
        {"scene", {{"name", scene_.name}, {"digest", scene_.digest}}},
        {"isa", isaName(activeIsa())},
        {"start", {{"frame", begin.frame}, {"set", start}}},
        {"frames", framesFrom(first + forgotten_)},
        {"frame", entry(present).frame},
        {"exposure", entry(present).document->view(output.value("view", 0)).display.exposureEv},
        {"output", output}};
    return jsonText(state);
}

}  // namespace lumi
