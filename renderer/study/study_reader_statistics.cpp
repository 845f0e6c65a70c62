#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "measure/measure.h"
#include "reconstruct/catalog.h"
#include "study/study_reader.h"
#include "study/temporal_metrics.h"

namespace lumi {
namespace {

const char* const kKinds[] = {"tap", "metric", "rays", "memory", "over"};

bool isTaken(const std::string& name, const std::vector<StudyStatistic>& earlier) {
    const auto& metrics = metricCatalog();
    return findTemporalMetric(name) || isTimeQuantity(name) ||
           std::any_of(metrics.begin(), metrics.end(), [&](const Metric& metric) { return name == metric.id; }) ||
           std::any_of(earlier.begin(), earlier.end(), [&](const StudyStatistic& one) { return one.name == name; });
}

/// Where a name must be one of a list.
std::string readOneOf(const JsonTree& tree, const JsonValue& value, const char* kind,
                      const std::vector<std::string>& names) {
    const std::string name = readText(tree, value, kind);
    if (std::find(names.begin(), names.end(), name) == names.end()) refuseName(tree, value.at, kind, name, names);
    return name;
}

/// "mean", "least", "most", or {"percentile": 99}, {"share-below": 1}, {"share-at-least": 16}.
void readReduction(const JsonTree& tree, const JsonValue& value, StudyStatistic& statistic) {
    using Of = StudyStatistic::Of;
    if (!value.isObject()) {
        const std::string name = readOneOf(tree, value, "of", {"mean", "least", "most"});
        statistic.of = name == "mean" ? Of::Mean : name == "least" ? Of::Least : Of::Most;
        return;
    }
    ObjectReader reader(tree, value, "of");
    const std::optional<double> percent = reader.number("percentile", 0, 100),
                                below = reader.number("share-below", -1e9, 1e9),
                                least = reader.number("share-at-least", -1e9, 1e9);
    if (percent.has_value() + below.has_value() + least.has_value() != 1)
        refuseValue(tree, value, "of", "one of \"percentile\", \"share-below\" and \"share-at-least\"");
    statistic.of = percent ? Of::Percentile : below ? Of::ShareBelow : Of::ShareAtLeast;
    statistic.value = percent ? *percent : below ? *below : *least;
    reader.finish();
}

std::string reductionText(const StudyStatistic& statistic) {
    switch (statistic.of) {
        case StudyStatistic::Of::Mean: return "mean";
        case StudyStatistic::Of::Least: return "least value";
        case StudyStatistic::Of::Most: return "greatest value";
        case StudyStatistic::Of::Percentile: return fmt::format("{:g}th percentile", statistic.value);
        case StudyStatistic::Of::ShareBelow: return fmt::format("share of pixels below {:g}", statistic.value);
        case StudyStatistic::Of::ShareAtLeast: return fmt::format("share of pixels at or above {:g}", statistic.value);
    }
    return "";
}

std::string definitionOf(const StudyStatistic& statistic) {
    if (!statistic.tap.empty())
        return fmt::format("The {} of the method's buffer {}{}, over its pixels that are finite.",
                           reductionText(statistic), statistic.tap,
                           statistic.channel.empty() ? "" : "." + statistic.channel);
    if (!statistic.metric.empty())
        return fmt::format("{} against a reference of {} samples a pixel, its own error included.",
                           findMetric(statistic.metric).title, statistic.referenceSpp);
    if (!statistic.rays.empty())
        return fmt::format("Rays a pixel that the method traced itself{}.",
                           statistic.rays == "all" ? "" : ", of the kind " + statistic.rays);
    if (statistic.memory)
        return "Bytes a pixel that the method holds between frames and to work on them, without threads' scratch.";
    return fmt::format("{} divided by {}.", statistic.over, statistic.under);
}

StudyStatistic readStatistic(const JsonTree& tree, const JsonValue& item, const std::vector<StudyStatistic>& earlier) {
    ObjectReader reader(tree, item, "statistic");
    StudyStatistic statistic;
    const JsonValue& name = reader.need("name");
    statistic.name = readText(tree, name, "name");
    checkFileName(tree, name, statistic.name);
    if (isTaken(statistic.name, earlier))
        throwBadInput(
            {fmt::format("\"{}\" is the name of something else", statistic.name), tree.where(name.at), "", ""});
    statistic.title = reader.text("title").value_or(statistic.name);
    statistic.higherIsBetter = reader.toggle("higher-is-better").value_or(false);
    int kinds = 0;
    for (const char* kind : kKinds) kinds += reader.find(kind) != nullptr;
    if (kinds != 1)
        refuseValue(tree, item, "statistic", "one of \"tap\", \"metric\", \"rays\", \"memory\" and \"over\"");
    if (const JsonValue* tap = reader.find("tap")) {
        statistic.tap = readText(tree, *tap, "tap");
        statistic.channel = reader.text("channel").value_or("");
        readReduction(tree, reader.need("of"), statistic);
    }
    if (const JsonValue* metric = reader.find("metric")) {
        std::vector<std::string> ids;
        for (const Metric& one : metricCatalog()) ids.emplace_back(one.id);
        statistic.metric = readOneOf(tree, *metric, "metric", ids);
        const JsonValue& spp = reader.need("reference-spp");
        statistic.referenceSpp = readInts(tree, spp, "reference-spp", 32, 1 << 20).front();
        if (statistic.referenceSpp % 32)
            refuseValue(tree, spp, "reference-spp", "a multiple of 32: two halves of whole blocks of 16");
    }
    if (const JsonValue* rays = reader.find("rays"))
        statistic.rays = readOneOf(tree, *rays, "rays", {"camera", "bounce", "shadow", "all"});
    if (const JsonValue* memory = reader.find("memory")) {
        statistic.memory = reader.toggle("memory").value_or(false);
        if (!statistic.memory) refuseValue(tree, *memory, "memory", "true");
    }
    if (const JsonValue* over = reader.find("over")) {
        std::vector<std::string> names;
        for (const StudyStatistic& one : earlier) names.push_back(one.name);
        statistic.over = readOneOf(tree, *over, "over", names);
        statistic.under = readOneOf(tree, reader.need("under"), "under", names);
    }
    reader.finish();
    statistic.definition = definitionOf(statistic);
    return statistic;
}

}  // namespace

std::vector<StudyStatistic> readStatistics(const JsonTree& tree, const JsonValue* section) {
    std::vector<StudyStatistic> statistics;
    if (!section) return statistics;
    if (!section->isArray()) refuseValue(tree, *section, "statistics", "an array of statistics");
    for (const JsonValue& item : section->items) statistics.push_back(readStatistic(tree, item, statistics));
    return statistics;
}

void checkStatisticTaps(const JsonTree& tree, const JsonValue* section, const Study& study) {
    std::vector<std::string> names;
    for (const StudyEntry& entry : study.entries) {
        const std::unique_ptr<Module> module = findModule(entry.module).make();
        for (const Tap& tap : module->taps())
            if (std::find(names.begin(), names.end(), tap.name) == names.end()) names.push_back(tap.name);
    }
    for (size_t i = 0; i < study.statistics.size(); ++i) {
        const std::string& tap = study.statistics[i].tap;
        if (tap.empty() || std::find(names.begin(), names.end(), tap) != names.end()) continue;
        for (const JsonMember& member : section->items[i].members)
            if (member.key == "tap") refuseName(tree, member.value.at, "buffer of the entries' modules", tap, names);
    }
}

std::vector<std::pair<std::string, double>> readKnown(const JsonTree& tree, const JsonValue* section,
                                                      const Study& study) {
    std::vector<std::pair<std::string, double>> known;
    if (!section) return known;
    if (!section->isObject()) refuseValue(tree, *section, "known", "an object");
    std::vector<std::string> names;
    for (const StudyStatistic& statistic : study.statistics) names.push_back(statistic.name);
    for (const JsonMember& member : section->members) {
        if (!study.statistic(member.key)) refuseName(tree, member.at, "statistic", member.key, names);
        known.emplace_back(member.key, readNumber(tree, member.value, member.key, -1e12, 1e12));
    }
    return known;
}

}  // namespace lumi
