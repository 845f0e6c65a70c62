#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"
#include "measure/measure.h"
#include "study/plan.h"
#include "study/study_reader.h"

namespace lumi {
namespace {

/// Columns of a figure: more do not fit a page.
constexpr size_t kMostColumns = 8;

StudyAblation::Stage readStage(const JsonTree& tree, const JsonValue& item, const StudyEntry& entry) {
    ObjectReader reader(tree, item, "stage");
    StudyAblation::Stage stage;
    const JsonValue& name = reader.need("name");
    stage.name = readText(tree, name, "name");
    checkFileName(tree, name, stage.name);
    const JsonValue& set = reader.need("set");
    stage.set = readValues(tree, &set, "set");
    if (stage.set.empty()) refuseValue(tree, set, "set", "what switches the stage off");
    reader.finish();
    for (const StudyValue& value : stage.set) checkModuleValue(entry.module, value);
    return stage;
}

/// Four shares of the picture: left, top, width, height.
StudyFigure::Crop readCrop(const JsonTree& tree, const JsonValue& item) {
    ObjectReader reader(tree, item, "crop");
    StudyFigure::Crop crop;
    const JsonValue& box = reader.need("box");
    const bool numbers =
        box.isArray() && box.items.size() == 4 &&
        std::all_of(box.items.begin(), box.items.end(), [](const JsonValue& v) { return v.isNumber(); });
    if (numbers)
        crop.x = box.items[0].number, crop.y = box.items[1].number, crop.width = box.items[2].number,
        crop.height = box.items[3].number;
    if (!numbers || crop.x < 0 || crop.y < 0 || !(crop.width > 0) || !(crop.height > 0) ||
        crop.x + crop.width > 1 + 1e-9 || crop.y + crop.height > 1 + 1e-9)
        refuseValue(tree, box, "box", "[left, top, width, height] as shares of the picture, from 0 to 1");
    crop.name = reader.text("name").value_or("");
    reader.finish();
    return crop;
}

std::string readMapMetric(const JsonTree& tree, const JsonValue& value) {
    const std::string metric = readText(tree, value, "metric");
    std::vector<std::string> known;
    for (const Metric& one : metricCatalog())
        if (one.mapColours) known.push_back(one.id);
    if (std::find(known.begin(), known.end(), metric) == known.end())
        refuseName(tree, value.at, "metric with a map", metric, known);
    return metric;
}

int64_t readMeasuredFrame(const JsonTree& tree, const JsonValue& value, const Study& study) {
    const int64_t frame = readWholes(tree, value, "frame", 0, study.frames.end - 1).front();
    if (!std::count(study.frames.measure.begin(), study.frames.measure.end(), frame))
        refuseValue(tree, value, "frame", "a frame that is measured");
    return frame;
}

std::string readSceneName(const JsonTree& tree, const JsonValue& value, const Study& study) {
    const std::string scene = readText(tree, value, "scene");
    std::vector<std::string> names;
    for (const StudyScene& known : study.scenes) names.push_back(known.name);
    if (std::find(names.begin(), names.end(), scene) == names.end()) refuseName(tree, value.at, "scene", scene, names);
    return scene;
}

void readWhere(const JsonTree& tree, ObjectReader& reader, const Study& study, StudyFigure& figure) {
    if (const JsonValue* scene = reader.find("scene")) figure.scene = readSceneName(tree, *scene, study);
    if (const JsonValue* frame = reader.find("frame")) figure.frame = readMeasuredFrame(tree, *frame, study);
    figure.spp = reader.integer("spp", 1, 65536).value_or(0);
    if (const JsonValue* input = reader.find("input")) figure.input = readEntryName(tree, *input, study, "input");
    if (const JsonValue* entries = reader.find("entries")) {
        readTexts(tree, *entries, "entries");
        for (const JsonValue& item : entries->items)
            figure.entries.push_back(readEntryName(tree, item, study, "entries"));
    }
    if (const JsonValue* metric = reader.find("metric")) figure.metric = readMapMetric(tree, *metric);
}

/// Refuses a figure that would have to leave entries out.
void checkColumns(const JsonTree& tree, const JsonValue& item, const Study& study, const StudyFigure& figure) {
    const std::vector<std::string>& entries = figure.entries;
    size_t columns = entries.empty() ? study.entries.size() : entries.size();
    columns += !entries.empty() && !figure.input.empty() && !std::count(entries.begin(), entries.end(), figure.input);
    if (columns > kMostColumns)
        throwBadInput({fmt::format("figure \"{}\" would show {} entries", figure.name, columns), tree.where(item.at),
                       fmt::format("at most {}, chosen by \"entries\"", kMostColumns), ""});
}

bool isSwept(const Study& study, const std::string& entry) {
    if (!study.sweep) return false;
    const std::vector<std::string>& swept = study.sweep->entries;
    return swept.empty() || std::count(swept.begin(), swept.end(), entry) > 0;
}

/// The name of an entry that is one method: of a swept one nobody knows which is meant.
std::string readUnsweptName(const JsonTree& tree, const JsonValue& value, const Study& study, const std::string& name) {
    const std::string entry = readEntryName(tree, value, study, name);
    if (isSwept(study, entry)) refuseValue(tree, value, name, "an entry that is not swept");
    return entry;
}

/// A metric or statistic of the study, or a time.
std::string readQuantity(const JsonTree& tree, const JsonValue& value, const Study& study) {
    const std::string id = readText(tree, value, "metric");
    std::vector<std::string> known = study.metrics;
    known.insert(known.end(), study.temporalMetrics.begin(), study.temporalMetrics.end());
    for (const StudyStatistic& statistic : study.statistics) known.push_back(statistic.name);
    for (const std::string& time : timeQuantities())
        if (time != "tracing_ns_per_ray" || !study.tracingStages.empty()) known.push_back(time);
    if (std::find(known.begin(), known.end(), id) == known.end())
        refuseName(tree, value.at, "metric of the study", id, known);
    return id;
}

}  // namespace

void checkFileName(const JsonTree& tree, const JsonValue& value, const std::string& name) {
    const bool good = !name.empty() && std::all_of(name.begin(), name.end(), [](unsigned char c) {
        return std::isalnum(c) || c == '-' || c == '_' || c == '.' || c == '+' || c == ' ' || c == '=' || c == '/';
    });
    if (!good) refuseValue(tree, value, "name", "letters, digits, spaces and any of - _ . + = /");
}

std::string readEntryName(const JsonTree& tree, const JsonValue& value, const Study& study, const std::string& name) {
    const std::string text = readText(tree, value, name);
    std::vector<std::string> names;
    for (const StudyEntry& entry : study.entries) names.push_back(entry.name);
    if (!study.entry(text)) refuseName(tree, value.at, "entry", text, names);
    return text;
}

void readAblations(const JsonTree& tree, const JsonValue* section, Study& study) {
    if (!section) return;
    if (!section->isArray()) refuseValue(tree, *section, "ablations", "an array of ablations");
    for (const JsonValue& item : section->items) {
        ObjectReader reader(tree, item, "ablation");
        StudyAblation ablation;
        const JsonValue& entry = reader.need("entry");
        ablation.entry = readUnsweptName(tree, entry, study, "entry");
        for (const StudyAblation& earlier : study.ablations)
            if (earlier.entry == ablation.entry) refuseValue(tree, entry, "entry", "each entry once");
        const JsonValue& stages = reader.need("stages");
        if (!stages.isArray() || stages.items.empty()) refuseValue(tree, stages, "stages", "an array of stages");
        for (const JsonValue& stage : stages.items) {
            ablation.stages.push_back(readStage(tree, stage, *study.entry(ablation.entry)));
            const std::string method = ablation.entry + " without " + ablation.stages.back().name;
            if (study.entry(method))
                throwBadInput({fmt::format("an entry is called \"{}\" already", method), tree.where(stage.at), "", ""});
            for (size_t i = 0; i + 1 < ablation.stages.size(); ++i)
                if (ablation.stages[i].name == ablation.stages.back().name)
                    throwBadInput({fmt::format("two stages are called \"{}\"", ablation.stages[i].name),
                                   tree.where(stage.at), "", ""});
        }
        reader.finish();
        study.ablations.push_back(std::move(ablation));
    }
}

void readChecks(const JsonTree& tree, const JsonValue* section, Study& study) {
    if (!section) return;
    if (!section->isArray()) refuseValue(tree, *section, "checks", "an array of checks");
    for (const JsonValue& item : section->items) {
        ObjectReader reader(tree, item, "check");
        StudyCheck check;
        check.title = reader.text("title").value_or("");
        if (const JsonValue* scene = reader.find("scene")) check.scene = readSceneName(tree, *scene, study);
        check.entry = readUnsweptName(tree, reader.need("entry"), study, "entry");
        const JsonValue& metric = reader.need("metric");
        check.metric = readQuantity(tree, metric, study);
        if (const JsonValue* equal = reader.find("at-equal")) check.atEqual = readQuantity(tree, *equal, study);
        if (const JsonValue* against = reader.find("against")) {
            readTexts(tree, *against, "against");
            for (const JsonValue& name : against->items)
                check.against.push_back(readUnsweptName(tree, name, study, "against"));
        }
        if (!check.atEqual.empty() && check.against.empty())
            refuseValue(tree, item, "at-equal", "entries under \"against\", which are the curve");
        const std::optional<double> most = reader.number("at-most", -1e9, 1e9),
                                    least = reader.number("at-least", -1e9, 1e9);
        if (most.has_value() == least.has_value())
            refuseValue(tree, item, "check", "either \"at-most\" or \"at-least\"");
        check.atLeast = least.has_value();
        check.bound = most ? *most : *least;
        const JsonValue* average = reader.find("on-average");
        check.onAverage = reader.toggle("on-average").value_or(false);
        if (check.onAverage && (check.timed() || !check.atEqual.empty() || !check.scene.empty()))
            refuseValue(tree, *average, "on-average", "false for what is about times, at equal cost, or on one scene");
        reader.finish();
        study.checks.push_back(std::move(check));
    }
}

void readFigures(const JsonTree& tree, const JsonValue* section, Study& study) {
    if (!section) return;
    if (!section->isArray()) refuseValue(tree, *section, "figures", "an array of figures");
    for (const JsonValue& item : section->items) {
        ObjectReader reader(tree, item, "figure");
        StudyFigure figure;
        const JsonValue& name = reader.need("name");
        figure.name = readText(tree, name, "name");
        checkFileName(tree, name, figure.name);
        for (const StudyFigure& earlier : study.figures)
            if (fileNameOf(earlier.name) == fileNameOf(figure.name))
                throwBadInput({fmt::format("two figures are called \"{}\"", figure.name), tree.where(name.at), "", ""});
        readWhere(tree, reader, study, figure);
        checkColumns(tree, item, study, figure);
        const JsonValue& crops = reader.need("crops");
        if (!crops.isArray() || crops.items.empty() || crops.items.size() > 6)
            refuseValue(tree, crops, "crops", "an array of one to six crops");
        for (const JsonValue& crop : crops.items) figure.crops.push_back(readCrop(tree, crop));
        reader.finish();
        study.figures.push_back(std::move(figure));
    }
}

}  // namespace lumi
