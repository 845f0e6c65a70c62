#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <set>

#include "app/commands.h"
#include "measure/temporal.h"
#include "params/json.h"
#include "params/json_text.h"
#include "reconstruct/catalog.h"
#include "study/bench.h"
#include "study/study_file.h"

namespace lumi {
using nlohmann::json;
namespace {

using Row = std::vector<std::string>;

/// Columns as wide as their widest cell; the last one free.
void printTable(const std::vector<Row>& rows) {
    std::vector<size_t> widths;
    for (const Row& row : rows) {
        widths.resize(std::max(widths.size(), row.size()), 0);
        for (size_t c = 0; c + 1 < row.size(); ++c) widths[c] = std::max(widths[c], row[c].size());
    }
    for (const Row& row : rows) {
        std::string line;
        for (size_t c = 0; c < row.size(); ++c)
            line += c + 1 < row.size() ? fmt::format("{:<{}}  ", row[c], widths[c]) : row[c];
        std::puts(line.c_str());
    }
}

void print(const MachineOptions& machine, const json& all, const std::vector<Row>& rows) {
    if (machine.json) std::puts(jsonText(all, 2).c_str());
    else printTable(rows);
}

void listSceneTable(const MachineOptions& machine) {
    json all = json::array();
    std::vector<Row> rows;
    for (const SceneEntry& entry : listScenes()) {
        all.push_back({{"id", entry.name}, {"title", entry.title}, {"path", entry.path.string()}});
        if (!entry.missing.empty()) all.back()["missing"] = entry.missing;
        rows.push_back({entry.name, entry.title + (entry.missing.empty() ? "" : " (not here: " + entry.missing + ")")});
    }
    print(machine, all, rows);
}

void listStudyTable(const MachineOptions& machine) {
    json all = json::array();
    std::vector<Row> rows;
    for (const StudyListing& study : listStudies()) {
        all.push_back(
            {{"id", study.name}, {"title", study.title}, {"path", study.path.string()}, {"presets", study.presets}});
        std::string presets;
        for (const std::string& preset : study.presets) presets += (presets.empty() ? "" : ", ") + preset;
        rows.push_back({study.name, presets.empty() ? "-" : presets, study.title});
    }
    print(machine, all, rows);
}

void listBenches(const MachineOptions& machine) {
    json all = json::array();
    std::vector<Row> rows;
    for (const BenchEntry& entry : benchEntries()) {
        all.push_back({{"id", entry.name}, {"title", entry.what}});
        rows.push_back({entry.name, entry.what});
    }
    print(machine, all, rows);
}

void listModules(const std::string& only, const MachineOptions& machine) {
    json all = json::array();
    std::vector<Row> rows;
    for (const ModuleEntry& entry : moduleCatalog()) {
        if (!only.empty() && &findModule(only, "--module") != &entry) continue;
        all.push_back({{"id", entry.id}, {"title", entry.title}, {"paper", entry.paper}});
        rows.push_back({entry.id, *entry.paper ? fmt::format("{} [{}]", entry.title, entry.paper) : entry.title});
    }
    print(machine, all, rows);
}

/// Metrics of two images, then those of sequences.
void listMetrics(const MachineOptions& machine) {
    json all = json::array();
    std::vector<Row> rows{{"ID", "RANGE", "BETTER", "SYMMETRIC", "OF", "SOURCE", "DEFINITION"}};
    const auto add = [&](const auto& metric, bool higher, bool map, const char* of) {
        all.push_back({{"id", metric.id},
                       {"title", metric.title},
                       {"definition", metric.definition},
                       {"range", metric.range},
                       {"higher_is_better", higher},
                       {"symmetric", metric.symmetric},
                       {"has_map", map},
                       {"of", of},
                       {"source", metric.source}});
        rows.push_back({metric.id, metric.range, higher ? "higher" : "lower", metric.symmetric ? "yes" : "no", of,
                        metric.source, fmt::format("{}: {}", metric.title, metric.definition)});
    };
    for (const Metric& metric : metricCatalog())
        add(metric, metric.higherIsBetter, metric.mapColours != nullptr, "images");
    for (const SequenceMetric& metric : sequenceMetricCatalog()) add(metric, false, true, "frames");
    print(machine, all, rows);
}

void listBuffers(const std::string& only, const MachineOptions& machine) {
    json all = json::array();
    std::vector<Row> rows;
    const auto add = [&](const std::string& id, const char* channels, const char* unit, const std::string& help,
                         const std::string& module) {
        json entry = {{"id", id}, {"title", help}, {"channels", channels}, {"unit", unit}};
        if (!module.empty()) entry["module"] = module;
        all.push_back(std::move(entry));
        rows.push_back({id, channels, *unit ? unit : "-", help});
    };
    if (only.empty())
        for (int i = 0; i < kSignalCount; ++i) {
            const SignalInfo& info = signalInfo(static_cast<Signal>(i));
            add(info.name, info.channels, info.unit, info.help, "");
        }
    for (const ModuleEntry& entry : moduleCatalog()) {
        if (!only.empty() && &findModule(only, "--module") != &entry) continue;
        const auto module = entry.make();
        for (const Tap& tap : module->taps())
            add(std::string(entry.id) + "-" + tap.name, tap.channels, tap.unit, tap.help, entry.id);
    }
    print(machine, all, rows);
}

/// A scene that has one of everything, so that a document of it declares every kind of parameter.
std::shared_ptr<const Scene> sampleScene() {
    auto scene = std::make_shared<Scene>();
    scene->materials.emplace_back().name = "name";
    scene->nodes.emplace_back();
    for (LightType type : {LightType::Point, LightType::Spot, LightType::Directional, LightType::Rectangle,
                           LightType::Disk, LightType::Sphere}) {
        Light light;
        light.name = "name";
        light.type = type;
        light.node = 0;
        scene->lights.push_back(light);
    }
    scene->cameras.emplace_back();
    return scene;
}

/// Ids of the sample scene as a user reads them: material.name.roughness is material.<name>.roughness.
std::string generalId(const std::string& id) {
    for (const std::string prefix : {"material.name", "light.name"}) {
        if (id.compare(0, prefix.size(), prefix) != 0) continue;
        const size_t dot = id.find('.', prefix.size());
        return prefix.substr(0, prefix.find('.')) + ".<name>" + id.substr(dot);
    }
    return id;
}

std::string rangeText(const ParameterInfo& info) {
    std::string text;
    switch (info.type) {
        case ParameterType::Number:
        case ParameterType::Integer: text = fmt::format("{:g} to {:g}", info.min, info.max); break;
        case ParameterType::Toggle: text = "true, false"; break;
        case ParameterType::Choice:
            for (const std::string& option : info.options) text += (text.empty() ? "" : ", ") + option;
            break;
        case ParameterType::Colour: text = "r,g,b"; break;
        case ParameterType::Vector: text = "x,y,z"; break;
        case ParameterType::Text: text = "text"; break;
    }
    return info.unit.empty() ? text : text + " " + info.unit;
}

void listParameterTable(const std::string& only, const MachineOptions& machine) {
    const Document document(sampleScene());
    std::vector<ParameterInfo> infos;
    if (only.empty()) {
        infos = document.list();
        for (const ModuleEntry& entry : moduleCatalog()) {
            const auto more = document.list(std::string(entry.id) + ".");
            infos.insert(infos.end(), more.begin(), more.end());
        }
    } else {
        findModule(only, "--module");
        infos = document.list(only + ".");
    }
    json all = json::array();
    std::vector<Row> rows;
    std::set<std::string> seen;
    for (ParameterInfo& info : infos) {
        info.id = generalId(info.id);
        if (!seen.insert(info.id).second) continue;
        all.push_back(toJson(info));
        std::string value = formatParameter(info.value);
        rows.push_back({info.id, value.empty() ? "-" : value, rangeText(info), info.help});
    }
    print(machine, all, rows);
}

}  // namespace

int runList(const ListOptions& options, const MachineOptions& machine) {
    if (options.what == "scenes") listSceneTable(machine);
    else if (options.what == "modules") listModules(options.module, machine);
    else if (options.what == "buffers") listBuffers(options.module, machine);
    else if (options.what == "metrics") listMetrics(machine);
    else if (options.what == "studies") listStudyTable(machine);
    else if (options.what == "benches") listBenches(machine);
    else listParameterTable(options.module, machine);
    return 0;
}

}  // namespace lumi
