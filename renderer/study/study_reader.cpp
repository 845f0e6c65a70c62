#include "study/study_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "measure/measure.h"
#include "reconstruct/catalog.h"
#include "study/study_file.h"

namespace lumi {
namespace {

constexpr int64_t kLastFrame = 10'000'000;

const ParameterInfo* find(const std::vector<ParameterInfo>& declared, const std::string& id) {
    for (const ParameterInfo& info : declared)
        if (info.id == id) return &info;
    return nullptr;
}

/// [begin, end), as two numbers.
void readRange(const JsonTree& tree, const JsonValue& value, const std::string& name, int64_t& begin, int64_t& end) {
    const std::vector<int64_t> ends = readWholes(tree, value, name, 0, kLastFrame);
    if (ends.size() != 2 || ends[0] >= ends[1]) refuseValue(tree, value, name, "[first, end] with first < end");
    begin = ends[0], end = ends[1];
}

std::vector<int64_t> readMeasured(const JsonTree& tree, const JsonValue& value, const StudyFrames& frames) {
    std::vector<int64_t> measured;
    if (value.isString() && value.text == "all") {
        for (int64_t f = frames.begin; f < frames.end; ++f) measured.push_back(f);
        return measured;
    }
    if (value.isString()) refuseValue(tree, value, "measure", "frame numbers or \"all\"");
    measured = readWholes(tree, value, "measure", 0, kLastFrame);
    std::sort(measured.begin(), measured.end());
    if (measured.front() < frames.begin || measured.back() >= frames.end)
        refuseValue(tree, value, "measure", fmt::format("frames from {} to {}", frames.begin, frames.end - 1));
    return measured;
}

StudyStep readStep(const JsonTree& tree, const JsonValue& section, const StudyFrames& frames) {
    ObjectReader reader(tree, section, "step");
    StudyStep step;
    step.frame = readWholes(tree, reader.need("frame"), "frame", frames.begin + 1, frames.end - 1).front();
    const JsonValue& set = reader.need("set");
    step.set = readValues(tree, &set, "set");
    if (step.set.empty()) refuseValue(tree, set, "set", "at least one value");
    for (const StudyValue& value : step.set)
        if (!definesImage(value.id))
            throwBadInput({fmt::format("\"{}\" does not change what a converged image shows", value.id), value.where,
                           "a parameter of the scene: material., light., environment. ...", ""});
    reader.finish();
    return step;
}

}  // namespace

std::string studyValueText(const JsonTree& tree, const JsonValue& value, const std::string& name) {
    if (value.isString()) return value.text;
    if (value.isNumber() || value.type == JsonValue::Type::Boolean) return value.shown();
    if (value.isArray() && value.items.size() == 3) {
        readVector(tree, value, name);
        return value.items[0].text + "," + value.items[1].text + "," + value.items[2].text;
    }
    refuseValue(tree, value, name, "a number, true or false, text or three numbers");
}

std::vector<int64_t> readWholes(const JsonTree& tree, const JsonValue& value, const std::string& name, int64_t min,
                                int64_t max) {
    std::vector<int64_t> numbers;
    const auto add = [&](const JsonValue& item) {
        const std::string range = fmt::format("a whole number from {} to {}", min, max);
        if (!item.isNumber() || item.number != std::floor(item.number) || item.number < static_cast<double>(min) ||
            item.number > static_cast<double>(max))
            refuseValue(tree, item, name, range);
        const int64_t number = static_cast<int64_t>(item.number);
        if (std::find(numbers.begin(), numbers.end(), number) != numbers.end())
            throwBadInput({fmt::format("\"{}\" has {} twice", name, number), tree.where(item.at), "", ""});
        numbers.push_back(number);
    };
    if (!value.isArray()) {
        add(value);
        return numbers;
    }
    for (const JsonValue& item : value.items) add(item);
    if (numbers.empty()) refuseValue(tree, value, name, "at least one number");
    return numbers;
}

std::vector<int> readInts(const JsonTree& tree, const JsonValue& value, const std::string& name, int min, int max) {
    std::vector<int> numbers;
    for (const int64_t number : readWholes(tree, value, name, min, max)) numbers.push_back(static_cast<int>(number));
    return numbers;
}

std::vector<std::string> readTexts(const JsonTree& tree, const JsonValue& value, const std::string& name) {
    if (!value.isArray() || value.items.empty()) refuseValue(tree, value, name, "an array of names");
    std::vector<std::string> texts;
    for (const JsonValue& item : value.items) {
        texts.push_back(readText(tree, item, name));
        if (std::count(texts.begin(), texts.end(), texts.back()) > 1)
            throwBadInput({fmt::format("\"{}\" has \"{}\" twice", name, texts.back()), tree.where(item.at), "", ""});
    }
    return texts;
}

std::vector<StudyValue> readValues(const JsonTree& tree, const JsonValue* section, const std::string& name) {
    std::vector<StudyValue> values;
    if (!section) return values;
    if (!section->isObject()) refuseValue(tree, *section, name, "an object");
    for (const JsonMember& member : section->members)
        values.push_back({member.key, studyValueText(tree, member.value, member.key), tree.where(member.at)});
    return values;
}

std::vector<StudyAxis> readAxes(const JsonTree& tree, const JsonValue* section, const std::string& name,
                                bool distinct) {
    std::vector<StudyAxis> axes;
    if (!section) return axes;
    if (!section->isObject()) refuseValue(tree, *section, name, "an object of arrays");
    for (const JsonMember& member : section->members) {
        if (!member.value.isArray() || member.value.items.empty())
            refuseValue(tree, member.value, member.key, "an array of values");
        StudyAxis axis{member.key, {}, tree.where(member.at)};
        for (const JsonValue& item : member.value.items) {
            axis.values.push_back(studyValueText(tree, item, member.key));
            if (distinct && std::count(axis.values.begin(), axis.values.end(), axis.values.back()) > 1)
                throwBadInput(
                    {fmt::format("\"{}\" has {} twice", member.key, item.shown()), tree.where(item.at), "", ""});
        }
        axes.push_back(std::move(axis));
    }
    return axes;
}

StudyFrames readFrames(const JsonTree& tree, const JsonValue* section) {
    StudyFrames frames;
    if (!section) return frames;
    ObjectReader reader(tree, *section, "frames");
    if (const JsonValue* range = reader.find("range")) readRange(tree, *range, "range", frames.begin, frames.end);
    frames.measure = {frames.end - 1};
    if (const JsonValue* measure = reader.find("measure")) frames.measure = readMeasured(tree, *measure, frames);
    // Differences of consecutive frames: over all from the first measured frame on, unless told otherwise.
    frames.temporalBegin = std::max(frames.measure.front(), frames.begin + 1);
    frames.temporalEnd = frames.measure.back() + 1;
    if (const JsonValue* temporal = reader.find("temporal")) {
        readRange(tree, *temporal, "temporal", frames.temporalBegin, frames.temporalEnd);
        if (frames.temporalBegin <= frames.begin || frames.temporalEnd > frames.end)
            refuseValue(tree, *temporal, "temporal",
                        fmt::format("frames after {} and up to {}", frames.begin, frames.end));
    }
    frames.temporalMeanFrom = frames.temporalBegin;
    if (const JsonValue* from = reader.find("mean-from"))
        frames.temporalMeanFrom =
            readWholes(tree, *from, "mean-from", frames.temporalBegin, frames.temporalEnd - 1).front();
    if (const JsonValue* step = reader.find("step")) frames.step = readStep(tree, *step, frames);
    frames.still = reader.toggle("still").value_or(false);
    frames.fps = static_cast<float>(reader.number("fps", 0.1, 1000).value_or(0));
    reader.finish();
    return frames;
}

MetricSettings readMetricSettings(const JsonTree& tree, const JsonValue* section) {
    MetricSettings settings;
    if (!section) return settings;
    ObjectReader reader(tree, *section, "metric-settings");
    settings.relMseEpsilon = reader.number("relmse-epsilon", 1e-12, 1e6).value_or(settings.relMseEpsilon);
    if (const JsonValue* range = reader.find("hdr-flip-exposures")) {
        const auto isEv = [](const JsonValue& value) { return value.isNumber() && std::abs(value.number) <= 100; };
        const bool good = range->isArray() && (range->items.size() == 2 || range->items.size() == 3) &&
                          isEv(range->items[0]) && isEv(range->items[1]) &&
                          range->items[0].number <= range->items[1].number;
        if (!good) refuseValue(tree, *range, "hdr-flip-exposures", "[start, stop] or [start, stop, count] in EV");
        settings.flipExposures = FlipExposures::over(range->items[0].number, range->items[1].number);
        if (range->items.size() == 3)
            settings.flipExposures->count = readInts(tree, range->items[2], "hdr-flip-exposures", 2, 64).front();
    }
    reader.finish();
    return settings;
}

StudyIntervals readIntervals(const JsonTree& tree, const JsonValue* section) {
    StudyIntervals intervals;
    if (!section) return intervals;
    ObjectReader reader(tree, *section, "intervals");
    intervals.level = reader.number("level", 0.5, 0.9999).value_or(intervals.level);
    const auto choice = [&](const char* key, const char* first, const char* second) {
        const JsonValue* value = reader.find(key);
        if (value && !(value->isString() && (value->text == first || value->text == second)))
            refuseValue(tree, *value, key, quotedList({first, second}));
        return value && value->text == second;
    };
    if (choice("units", "seeds", "frames-and-seeds")) intervals.units = StudyIntervals::Units::FramesAndSeeds;
    if (choice("method", "student-t", "bootstrap")) intervals.method = StudyIntervals::Method::Bootstrap;
    reader.finish();
    return intervals;
}

StudyPictures readPictures(const JsonTree& tree, const JsonValue* section) {
    StudyPictures pictures;
    if (!section) return pictures;
    ObjectReader reader(tree, *section, "pictures");
    if (const JsonValue* frames = reader.find("frames"))
        pictures.frames = readWholes(tree, *frames, "frames", 0, kLastFrame);
    if (const JsonValue* spp = reader.find("spp")) pictures.spp = readInts(tree, *spp, "spp", 1, 65536);
    if (const JsonValue* map = reader.find("error-map")) {
        pictures.errorMap = readText(tree, *map, "error-map");
        std::vector<std::string> known;
        for (const Metric& metric : metricCatalog())
            if (metric.mapColours) known.push_back(metric.id);
        if (std::find(known.begin(), known.end(), pictures.errorMap) == known.end())
            refuseName(tree, map->at, "error map", pictures.errorMap, known);
    }
    reader.finish();
    return pictures;
}

namespace {

/// An entry's parameters have no module before their dot: with one, they would be those of another that does not run.
void refuseOtherModule(const std::string& module, const StudyValue& value, size_t dot) {
    const std::string before = value.id.substr(0, dot);
    const std::span<const ModuleEntry> catalog = moduleCatalog();
    if (std::none_of(catalog.begin(), catalog.end(), [&](const ModuleEntry& known) { return known.id == before; }))
        return;
    throwBadInput(
        {fmt::format("\"{}\" has no effect on an entry of module \"{}\"", value.id, module), value.where,
         before == module ? '"' + value.id.substr(dot + 1) + '"' : "a parameter of that module, or of the scene", ""});
}

}  // namespace

void checkModuleValue(const std::string& module, const StudyValue& value) {
    const std::unique_ptr<Module> instance = findModule(module).make();
    const Describe describe = [&](ParameterVisitor& v) { instance->describe(v); };
    const std::vector<ParameterInfo> declared = listParameters(describe);
    if (const ParameterInfo* info = find(declared, value.id)) {
        try {
            setParameter(describe, value.id, parseParameter(*info, value.text, value.where), value.where);
        } catch (const Error& error) {
            throw Error(ErrorKind::BadInput, error.text());
        }
        return;
    }
    if (const size_t dot = value.id.find('.'); dot != std::string::npos) {
        refuseOtherModule(module, value, dot);
        return;
    }
    std::vector<std::string> ids;
    for (const ParameterInfo& info : declared) ids.push_back(info.id);
    const std::string near = nearestName(value.id, ids);
    throwBadInput({fmt::format("module \"{}\" has no parameter \"{}\"", module, value.id), value.where,
                   near.empty() ? "one of " + quotedList(ids) + ", or an id with a dot" : '"' + near + '"', ""});
}

JsonValue mergeJson(const JsonValue& base, const JsonValue& over) {
    if (!base.isObject() || !over.isObject()) return over;
    JsonValue merged = base;
    for (const JsonMember& member : over.members) {
        const auto mine = std::find_if(merged.members.begin(), merged.members.end(),
                                       [&](const JsonMember& m) { return m.key == member.key; });
        if (mine == merged.members.end()) merged.members.push_back(member);
        else mine->value = mergeJson(mine->value, member.value), mine->at = member.at;
    }
    return merged;
}

}  // namespace lumi
