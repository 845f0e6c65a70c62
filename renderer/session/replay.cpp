#include "session/replay.h"

#include <algorithm>

#include "base/error.h"
#include "base/files.h"
#include "image/exr.h"
#include "image/png.h"
#include "params/json.h"

namespace lumi {
using nlohmann::json;
namespace {

constexpr const char* kFormat = "lumiscope-state";
constexpr int kVersion = 1;

const json& member(const json& object, const char* key, json::value_t type, const std::string& where) {
    const auto found = object.find(key);
    if (found == object.end()) throwBadInput({std::string("the embedded state lacks \"") + key + '"', where, "", ""});
    const bool number = type == json::value_t::number_integer && found->is_number_integer();
    const bool real = type == json::value_t::number_float && found->is_number();
    if (found->type() != type && !number && !real)
        throwBadInput(
            {std::string("the embedded state's \"") + key + "\" has the wrong type", where, "", found->dump()});
    return *found;
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

/// One entry of "frames": values before a frame, a clock for a run of frames, or both.
void addFrames(Replay& replay, const json& entry, const std::string& where) {
    if (!entry.is_object()) throwBadInput({"the embedded state's \"frames\" are not objects", where, "", ""});
    const auto frame = member(entry, "frame", json::value_t::number_integer, where).get<FrameNumber>();
    if (!entry.contains("clock") || entry.contains("set"))
        replay.sets.emplace_back(frame, member(entry, "set", json::value_t::object, where));
    if (!entry.contains("clock")) return;
    const json& clock = member(entry, "clock", json::value_t::object, where);
    Replay::Ticks ticks{frame, member(entry, "last", json::value_t::number_integer, where).get<FrameNumber>(), {}};
    ticks.clock.frame = member(clock, "frame", json::value_t::number_integer, where).get<FrameNumber>();
    ticks.clock.time = member(clock, "time", json::value_t::number_float, where).get<float>();
    ticks.clock.fps = member(clock, "fps", json::value_t::number_float, where).get<float>();
    if (!(ticks.clock.fps > 0) || ticks.last < ticks.first)
        throwBadInput({"the embedded state's \"clock\" is damaged", where, "", entry.dump()});
    replay.ticks.push_back(ticks);
}

/// The `scene.` values among those of a document.
SceneChoice choiceOf(const json& values, const std::string& where) {
    SceneChoice choice;
    const auto parameters = [&](ParameterVisitor& visitor) { choice.describe(visitor); };
    try {
        for (const ParameterInfo& info : listParameters(parameters))
            if (values.contains(info.id))
                setParameter(parameters, info.id, parameterFromJson(info, values.at(info.id), where), where);
    } catch (const Error& error) {
        throw Error(ErrorKind::BadInput, error.text());
    }
    return choice;
}

}  // namespace

std::optional<json> Replay::valuesOf(FrameNumber frame) const {
    std::optional<json> values;
    const auto set = std::lower_bound(sets.begin(), sets.end(), frame,
                                      [](const auto& entry, FrameNumber number) { return entry.first < number; });
    if (set != sets.end() && set->first == frame) values = set->second;
    const auto run = std::lower_bound(ticks.begin(), ticks.end(), frame,
                                      [](const Ticks& entry, FrameNumber number) { return entry.last < number; });
    if (run != ticks.end() && run->first <= frame) {
        if (!values) values = json::object();
        (*values)["time"] = run->clock.at(frame);
    }
    return values;
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
    replay.choice = choiceOf(replay.start, where);
    replay.last = member(state, "frame", json::value_t::number_integer, where).get<FrameNumber>();
    for (const json& entry : member(state, "frames", json::value_t::array, where)) addFrames(replay, entry, where);
    const auto& sets = replay.sets;
    const auto& ticks = replay.ticks;
    const bool ordered =
        std::adjacent_find(sets.begin(), sets.end(), [](const auto& a, const auto& b) { return b.first <= a.first; }) ==
            sets.end() &&
        std::adjacent_find(ticks.begin(), ticks.end(),
                           [](const auto& a, const auto& b) { return b.first <= a.last; }) == ticks.end();
    if (replay.first < 0 || replay.last < replay.first || !ordered)
        throwBadInput({"the embedded state's frames are out of order", where, "", ""});
    replay.output = state.value("output", json::object());
    return replay;
}

std::optional<float> exposureOfState(const std::string& text) {
    const json state = json::parse(text, nullptr, false);
    if (!state.is_object() || state.value("format", json()) != kFormat) return std::nullopt;
    const auto exposure = state.find("exposure");
    if (exposure == state.end() || !exposure->is_number()) return std::nullopt;
    return exposure->get<float>();
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

}  // namespace lumi
