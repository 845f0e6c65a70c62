#include "study/study_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "base/error.h"
#include "base/files.h"
#include "measure/measure.h"
#include "reconstruct/catalog.h"
#include "study/plan.h"
#include "study/study_reader.h"
#include "study/temporal_metrics.h"

namespace lumi {
namespace fs = std::filesystem;
namespace {

constexpr uint64_t kMaxStudyBytes = uint64_t(16) << 20;

/// What a preset may not change: the file itself.
const std::set<std::string> kFileKeys{"$schema", "version", "title", "paper", "description", "presets"};

template <class Thing>
void refuseTwin(const JsonTree& tree, const JsonValue& at, const std::vector<Thing>& earlier, const std::string& name,
                const char* kind) {
    for (const Thing& thing : earlier)
        if (thing.name == name)
            throwBadInput({fmt::format("two {} are called \"{}\"", kind, name), tree.where(at.at), "", ""});
}

/// Tables and references are files named after their scene, those of all scenes together `all-scenes`.
void refuseTwinFiles(const JsonTree& tree, const JsonValue& at, const std::vector<StudyScene>& earlier,
                     const std::string& name) {
    const std::string file = fileNameOf(name);
    if (name == "all" || file == "all-scenes")
        throwBadInput({fmt::format("a scene cannot be called \"{}\"", name), tree.where(at.at),
                       "another name: this one is for the mean over all scenes", ""});
    for (const StudyScene& scene : earlier)
        if (fileNameOf(scene.name) == file)
            throwBadInput({fmt::format("files of scenes \"{}\" and \"{}\" would have one name", scene.name, name),
                           tree.where(at.at), "names that differ in letters or digits", ""});
}

std::vector<StudyScene> readScenes(const JsonTree& tree, const JsonValue& section) {
    if (!section.isArray() || section.items.empty()) refuseValue(tree, section, "scenes", "an array of scenes");
    std::vector<StudyScene> scenes;
    for (const JsonValue& item : section.items) {
        StudyScene scene;
        scene.where = tree.where(item.at);
        if (item.isString()) {
            scene.source = item.text;
        } else {
            ObjectReader reader(tree, item, "scene");
            scene.source = readText(tree, reader.need("scene"), "scene");
            scene.name = reader.text("name").value_or("");
            scene.optional = reader.toggle("optional").value_or(false);
            scene.set = readValues(tree, reader.find("set"), "set");
            reader.finish();
        }
        if (scene.name.empty()) scene.name = fs::path(scene.source.substr(scene.source.find(':') + 1)).stem().string();
        checkFileName(tree, item, scene.name);
        refuseTwin(tree, item, scenes, scene.name, "scenes");
        refuseTwinFiles(tree, item, scenes, scene.name);
        scenes.push_back(std::move(scene));
    }
    return scenes;
}

StudyEntry readEntry(const JsonTree& tree, const JsonValue& item, const Study& study) {
    ObjectReader reader(tree, item, "entry");
    StudyEntry entry;
    const JsonValue& module = reader.need("module");
    entry.module = readText(tree, module, "module");
    std::vector<std::string> ids;
    for (const ModuleEntry& known : moduleCatalog()) ids.push_back(known.id);
    if (std::find(ids.begin(), ids.end(), entry.module) == ids.end())
        refuseName(tree, module.at, "module", entry.module, ids);
    entry.name = reader.text("name").value_or(entry.module);
    checkFileName(tree, item, entry.name);
    entry.set = readValues(tree, reader.find("set"), "set");
    entry.tune = readAxes(tree, reader.find("tune"), "tune");
    if (const JsonValue* spp = reader.find("spp")) entry.spp = readInts(tree, *spp, "spp", 1, 65536);
    entry.known = readKnown(tree, reader.find("known"), study);
    reader.finish();
    for (const StudyValue& value : entry.set) checkModuleValue(entry.module, value);
    for (const StudyAxis& axis : entry.tune)
        for (const std::string& text : axis.values) checkModuleValue(entry.module, {axis.id, text, axis.where});
    return entry;
}

void readEntries(const JsonTree& tree, const JsonValue& section, Study& study) {
    if (!section.isArray() || section.items.empty()) refuseValue(tree, section, "entries", "an array of entries");
    for (const JsonValue& item : section.items) {
        StudyEntry entry = readEntry(tree, item, study);
        refuseTwin(tree, item, study.entries, entry.name, "entries");
        if (!entry.tune.empty() && !study.tuning)
            throwBadInput({fmt::format("\"{}\" is tuned, but nothing says on which frame", entry.name),
                           tree.where(item.at), "\"tuning\": {\"frame\": ...} in the study", ""});
        study.entries.push_back(std::move(entry));
    }
}

void readSweep(const JsonTree& tree, const JsonValue* section, Study& study) {
    if (!section) return;
    ObjectReader reader(tree, *section, "sweep");
    StudySweep sweep;
    const JsonValue& axesFound = reader.need("axes");
    sweep.axes = readAxes(tree, &axesFound, "axes");
    if (sweep.axes.empty() || sweep.axes.size() > 2) refuseValue(tree, axesFound, "axes", "one or two axes");
    if (const JsonValue* with = reader.find("with")) {
        sweep.with = readAxes(tree, with, "with", false);
        if (sweep.axes.size() > 1) refuseValue(tree, *with, "with", "a single axis beside it");
        for (const StudyAxis& axis : sweep.with)
            if (axis.values.size() != sweep.axes[0].values.size())
                throwBadInput({fmt::format("\"{}\" has {} values", axis.id, axis.values.size()), axis.where,
                               fmt::format("{}, as many as \"{}\"", sweep.axes[0].values.size(), sweep.axes[0].id),
                               ""});
    }
    if (const JsonValue* entries = reader.find("entries")) {
        if (!entries->isArray()) refuseValue(tree, *entries, "entries", "an array of names");
        for (const JsonValue& item : entries->items)
            sweep.entries.push_back(readEntryName(tree, item, study, "entries"));
    }
    reader.finish();
    for (const StudyEntry& entry : study.entries) {
        const bool swept = sweep.entries.empty() ||
                           std::find(sweep.entries.begin(), sweep.entries.end(), entry.name) != sweep.entries.end();
        for (const std::vector<StudyAxis>* axes : {&sweep.axes, &sweep.with})
            for (const StudyAxis& axis : *axes)
                for (const std::string& text : axis.values)
                    if (swept) checkModuleValue(entry.module, {axis.id, text, axis.where});
    }
    study.sweep = std::move(sweep);
}

void readTuning(const JsonTree& tree, const JsonValue* section, Study& study) {
    if (!section) return;
    ObjectReader reader(tree, *section, "tuning");
    StudyTuning tuning;
    const JsonValue& frame = reader.need("frame");
    tuning.frame = readWholes(tree, frame, "frame", study.frames.begin, study.frames.end - 1).front();
    if (std::count(study.frames.measure.begin(), study.frames.measure.end(), tuning.frame))
        refuseValue(tree, frame, "frame", "a frame that is not measured");
    if (const JsonValue* metric = reader.find("metric")) {
        tuning.metric = readText(tree, *metric, "metric");
        try {
            findMetric(tuning.metric, tree.where(metric->at));
        } catch (const Error& error) {
            throw Error(ErrorKind::BadInput, error.text());
        }
    }
    tuning.seed = reader.integer("seed", 0, kReferenceSeed - 1).value_or(0);
    reader.finish();
    study.tuning = tuning;
}

/// One entry's name, or several.
std::vector<std::string> readEntryNames(const JsonTree& tree, const JsonValue& value, const Study& study,
                                        const std::string& name) {
    if (!value.isArray()) return {readEntryName(tree, value, study, name)};
    std::vector<std::string> names = readTexts(tree, value, name);
    for (const JsonValue& item : value.items) readEntryName(tree, item, study, name);
    return names;
}

void readPairs(const JsonTree& tree, const JsonValue* section, Study& study) {
    if (!section) return;
    if (!section->isArray()) refuseValue(tree, *section, "pairs", "an array of pairs");
    for (const JsonValue& item : section->items) {
        ObjectReader reader(tree, item, "pair");
        StudyPair pair;
        pair.entry = readEntryName(tree, reader.need("entry"), study, "entry");
        pair.against = readEntryNames(tree, reader.need("against"), study, "against");
        reader.finish();
        study.pairs.push_back(pair);
    }
}

void readMetrics(const JsonTree& tree, const JsonValue* section, Study& study) {
    study.metrics = {"rmse"};
    if (!section) return;
    study.metrics.clear();
    std::vector<std::string> known;
    for (const Metric& metric : metricCatalog()) known.push_back(metric.id);
    for (const TemporalMetric& metric : temporalMetricCatalog()) known.push_back(metric.id);
    readTexts(tree, *section, "metrics");
    for (const JsonValue& item : section->items) {
        if (std::find(known.begin(), known.end(), item.text) == known.end())
            refuseName(tree, item.at, "metric", item.text, known);
        (findTemporalMetric(item.text) ? study.temporalMetrics : study.metrics).push_back(item.text);
    }
    for (const std::string& id : study.temporalMetrics) {
        if (id != "lag" && study.frames.temporalBegin >= study.frames.temporalEnd)
            refuseValue(tree, *section, "metrics", "two frames or more for \"" + id + '"');
        if (id == "lag" && !(study.frames.step && study.frames.still))
            refuseValue(tree, *section, "metrics", "\"frames\" with a \"step\" and \"still\": true for \"lag\"");
    }
}

void readReference(const JsonTree& tree, const JsonValue* section, StudyReference& reference) {
    if (!section) return;
    ObjectReader reader(tree, *section, "reference");
    if (const JsonValue* spp = reader.find("spp")) {
        reference.spp = readInts(tree, *spp, "spp", 32, 1 << 20).front();
        if (reference.spp % 32) refuseValue(tree, *spp, "spp", "a multiple of 32: two halves of whole blocks of 16");
    }
    reference.set = readValues(tree, reader.find("set"), "set");
    reader.finish();
}

/// Everything but title and presets, from the study with a preset merged into it.
void readBody(const JsonTree& tree, const JsonValue& merged, Study& study) {
    ObjectReader top(tree, merged, "study");
    for (const std::string& key : kFileKeys) top.find(key.c_str());
    if (const JsonValue* size = top.find("size")) {
        if (!size->isArray() || size->items.size() != 2) refuseValue(tree, *size, "size", "[width, height]");
        const auto side = [&](size_t i) { return readInts(tree, size->items[i], "size", 1, 16384).front(); };
        study.size = {side(0), side(1)};
    }
    study.scenes = readScenes(tree, top.need("scenes"));
    study.frames = readFrames(tree, top.find("frames"));
    if (const JsonValue* spp = top.find("spp")) study.spp = readInts(tree, *spp, "spp", 1, 65536);
    if (const JsonValue* seeds = top.find("seeds"))
        study.seeds = readInts(tree, *seeds, "seeds", 0, kReferenceSeed - 1);
    study.set = readValues(tree, top.find("set"), "set");
    readReference(tree, top.find("reference"), study.reference);
    readMetrics(tree, top.find("metrics"), study);
    study.metricSettings = readMetricSettings(tree, top.find("metric-settings"));
    study.statistics = readStatistics(tree, top.find("statistics"));
    if (const JsonValue* stages = top.find("tracing-stages"))
        study.tracingStages = readTexts(tree, *stages, "tracing-stages");
    readTuning(tree, top.find("tuning"), study);
    readEntries(tree, top.need("entries"), study);
    checkStatisticTaps(tree, top.find("statistics"), study);
    readSweep(tree, top.find("sweep"), study);
    readPairs(tree, top.find("pairs"), study);
    readAblations(tree, top.find("ablations"), study);
    readFigures(tree, top.find("figures"), study);
    readChecks(tree, top.find("checks"), study);
    study.intervals = readIntervals(tree, top.find("intervals"));
    study.pictures = readPictures(tree, top.find("pictures"));
    top.finish();
}

/// The study's members with those of the preset in their place.
JsonValue applyPreset(const JsonTree& tree, const JsonMember& preset) {
    if (!preset.value.isObject()) refuseValue(tree, preset.value, preset.key, "an object");
    for (const JsonMember& member : preset.value.members)
        if (kFileKeys.contains(member.key))
            throwBadInput({fmt::format("a preset cannot change \"{}\"", member.key), tree.where(member.at), "", ""});
    return mergeJson(tree.root, preset.value);
}

const JsonValue* findMember(const JsonValue& object, const std::string& key) {
    for (const JsonMember& member : object.members)
        if (member.key == key) return &member.value;
    return nullptr;
}

}  // namespace

const StudyEntry* Study::entry(const std::string& wanted) const {
    for (const StudyEntry& entry : entries)
        if (entry.name == wanted) return &entry;
    return nullptr;
}

const StudyStatistic* Study::statistic(const std::string& wanted) const {
    for (const StudyStatistic& statistic : statistics)
        if (statistic.name == wanted) return &statistic;
    return nullptr;
}

bool Study::measures(const std::string& metric) const {
    return std::count(metrics.begin(), metrics.end(), metric) +
                   std::count(temporalMetrics.begin(), temporalMetrics.end(), metric) >
               0 ||
           statistic(metric);
}

const std::vector<std::string>& timeQuantities() {
    static const std::vector<std::string> names{"frame_ms", "run_ms", "ns_per_ray", "tracing_ns_per_ray"};
    return names;
}

bool isTimeQuantity(const std::string& id) {
    return std::count(timeQuantities().begin(), timeQuantities().end(), id) > 0;
}

bool StudyCheck::timed() const { return isTimeQuantity(metric) || isTimeQuantity(atEqual); }

Study parseStudy(const std::string& text, const fs::path& path, const std::string& preset) {
    const JsonTree tree = parseJsonTree(text, path.string());
    if (!tree.root.isObject())
        throwBadInput({"is not a study file", tree.where(tree.root.at), "a JSON object", tree.root.shown()});
    Study study;
    study.path = path;
    study.name = path.stem().string();
    study.digest = digest({reinterpret_cast<const uint8_t*>(text.data()), text.size()});
    study.preset = preset;
    {
        ObjectReader top(tree, tree.root, "study");
        const JsonValue& version = top.need("version");
        if (!version.isNumber() || version.number != 1) refuseValue(tree, version, "version", "1");
        study.title = top.text("title").value_or(study.name);
        study.paper = top.text("paper").value_or("");
        study.description = top.text("description").value_or("");
    }
    std::vector<std::string> presets;
    const JsonMember* chosen = nullptr;
    if (const JsonValue* section = findMember(tree.root, "presets")) {
        if (!section->isObject()) refuseValue(tree, *section, "presets", "an object");
        for (const JsonMember& member : section->members) {
            presets.push_back(member.key);
            if (member.key == preset) chosen = &member;
            Study checked = study;
            readBody(tree, applyPreset(tree, member), checked);
        }
    }
    if (!preset.empty() && !chosen)
        throwUsage({fmt::format("study \"{}\" has no preset \"{}\"", study.name, preset), "--preset",
                    presets.empty() ? "none, for it has none" : "one of " + quotedList(presets), ""});
    readBody(tree, chosen ? applyPreset(tree, *chosen) : tree.root, study);
    return study;
}

Study loadStudy(const fs::path& path, const std::string& preset) {
    return parseStudy(readTextFile(path, kMaxStudyBytes), path, preset);
}

std::vector<std::string> studyPresets(const fs::path& path) {
    const JsonTree tree = parseJsonTree(readTextFile(path, kMaxStudyBytes), path.string());
    std::vector<std::string> names;
    if (const JsonValue* section = findMember(tree.root, "presets"))
        for (const JsonMember& member : section->members) names.push_back(member.key);
    return names;
}

}  // namespace lumi
