#include "session/state_log.h"

#include <algorithm>

#include "base/error.h"
#include "base/files.h"
#include "base/isa.h"
#include "image/exr.h"
#include "image/png.h"

namespace lumi {
using nlohmann::json;
namespace {

constexpr const char* kFormat = "lumiscope-state";
constexpr int kVersion = 1;
/// Frames that can be stepped back to, unless the present one needs more.
constexpr size_t kKeptEntries = 4096;

const json& member(const json& object, const char* key, json::value_t type, const std::string& where) {
    const auto found = object.find(key);
    if (found == object.end()) throwBadInput({std::string("the embedded state lacks \"") + key + '"', where, "", ""});
    const bool number = type == json::value_t::number_integer && found->is_number_integer();
    if (found->type() != type && !number)
        throwBadInput({std::string("the embedded state's \"") + key + "\" has the wrong type", where, "", found->dump()});
    return *found;
}

/// Values as they stand in a state: with the content of a sky's file, where one was read. `whole`: all that differs
/// from the scene, else what differs from the frame before.
json stateValues(json values, const Document& document, bool whole) {
    if ((whole || values.contains("environment.file")) && !document.environmentDigest().empty())
        values[Document::kEnvironmentDigest] = document.environmentDigest();
    return values;
}

std::string embeddedState(const std::filesystem::path& file) {
    const std::string extension = lowerExtension(file);
    if (extension == ".exr") {
        ExrLayers layers = readExr(file);
        return layers.strings[kStateKey];
    }
    if (extension == ".png") return readPngTexts(file)[kStateKey];
    if (extension == ".json") return readTextFile(file);
    throwBadInput({"holds no state", file.string(), "a .exr, .png or .json that lumiscope wrote", ""});
}

}  // namespace

const json* Replay::valuesOf(FrameNumber frame) const {
    for (const auto& [number, values] : sets)
        if (number == frame) return &values;
    return nullptr;
}

Replay parseReplay(const std::string& text, const std::string& where) {
    const json state = json::parse(text, nullptr, false);
    if (state.is_discarded() || !state.is_object() || state.value("format", json()) != kFormat)
        throwBadInput({"holds no state of lumiscope", where, "", ""});
    if (state.value("version", json()) != kVersion)
        throwBadInput({"the embedded state has another version", where, std::to_string(kVersion),
                       state.value("version", json()).dump()});
    Replay replay;
    const json& scene = member(state, "scene", json::value_t::object, where);
    replay.scene.name = member(scene, "name", json::value_t::string, where).get<std::string>();
    replay.scene.digest = member(scene, "digest", json::value_t::string, where).get<std::string>();
    replay.isa = member(state, "isa", json::value_t::string, where).get<std::string>();
    const json& start = member(state, "start", json::value_t::object, where);
    replay.first = member(start, "frame", json::value_t::number_integer, where).get<FrameNumber>();
    replay.start = member(start, "set", json::value_t::object, where);
    replay.last = member(state, "frame", json::value_t::number_integer, where).get<FrameNumber>();
    for (const json& entry : member(state, "frames", json::value_t::array, where)) {
        if (!entry.is_object()) throwBadInput({"the embedded state's \"frames\" are not objects", where, "", ""});
        replay.sets.emplace_back(member(entry, "frame", json::value_t::number_integer, where).get<FrameNumber>(),
                                 member(entry, "set", json::value_t::object, where));
    }
    if (replay.first < 0 || replay.last < replay.first)
        throwBadInput({"the embedded state's frames are out of order", where, "", ""});
    replay.output = state.value("output", json::object());
    return replay;
}

std::string stateTextOf(const std::filesystem::path& file) {
    const std::string text = lowerExtension(file) == ".png" ? readPng(file).texts[kStateKey] : embeddedState(file);
    if (text.empty()) throwBadInput({"holds no state of lumiscope", file.string(), "", ""});
    return text;
}

Replay readReplay(const std::filesystem::path& file) {
    const std::string text = embeddedState(file);
    if (text.empty()) throwBadInput({"holds no state of lumiscope", file.string(), "", ""});
    return parseReplay(text, file.string());
}

void StateLog::record(const FrameOutput& frame, std::shared_ptr<const Document> document) {
    const Entry entry{frame.number, std::move(document), frame.changes.cut, frame.historyDropped, nullptr, 0};
    if (!entries_.empty() && entries_.back().frame == frame.number) entries_.back() = entry;
    else entries_.push_back(entry);
    describeLast();
    forgetOldest();
}

void StateLog::redescribeLast(std::shared_ptr<const Document> document) {
    if (entries_.empty()) return;
    entries_.back().document = std::move(document);
    describeLast();
}

/// Each entry is told once, when it comes: a state of n frames then costs n pieces of text, not n comparisons.
void StateLog::describeLast() {
    Entry& last = entries_.back();
    const uint64_t number = forgotten_ + entries_.size() - 1;
    last.set = nullptr;
    last.start = number;
    if (entries_.size() == 1) return;
    const Entry& before = entries_[entries_.size() - 2];
    // Where no module keeps history the frame before is run all the same: motion refers to it.
    if (!last.cut) last.start = last.historyDropped ? number - 1 : before.start;
    if (last.document == before.document) return;
    nlohmann::json set = stateValues(Document::difference(*before.document, *last.document), *last.document, false);
    if (!set.empty()) last.set = std::make_shared<nlohmann::json>(std::move(set));
}

size_t StateLog::startOf(size_t index) const {
    return static_cast<size_t>(std::max(entries_[index].start, forgotten_) - forgotten_);
}

void StateLog::forgetOldest() {
    if (entries_.size() <= kKeptEntries) return;
    const size_t unneeded = std::min(startOf(entries_.size() - 1), entries_.size() - kKeptEntries);
    entries_.erase(entries_.begin(), entries_.begin() + static_cast<std::ptrdiff_t>(unneeded));
    forgotten_ += unneeded;
}

std::string StateLog::json(const nlohmann::json& output) const {
    const size_t last = entries_.size() - 1, first = startOf(last);
    nlohmann::json frames = nlohmann::json::array();
    for (size_t i = first + 1; i <= last; ++i) {
        if (entries_[i].set) frames.push_back({{"frame", entries_[i].frame}, {"set", *entries_[i].set}});
    }
    const nlohmann::json start = stateValues(entries_[first].document->changedValues(), *entries_[first].document, true);
    const nlohmann::json state = {{"format", kFormat},
                                  {"version", kVersion},
                                  {"scene", {{"name", scene_.name}, {"digest", scene_.digest}}},
                                  {"isa", isaName(activeIsa())},
                                  {"start", {{"frame", entries_[first].frame}, {"set", start}}},
                                  {"frames", std::move(frames)},
                                  {"frame", entries_[last].frame},
                                  {"output", output}};
    return state.dump();
}

}  // namespace lumi
