#include "app/study_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <set>

#include "study/number_text.h"

namespace lumi {
namespace {

std::string shown(const Interval& interval) { return plainText(numberText(interval)); }

std::string shownDifference(const Interval& interval) {
    return (interval.mean > 0 ? "+" : "") + shown(interval) + (interval.excludesZero() ? " *" : "  ");
}

std::string sceneName(const Study& study, size_t scene) {
    return scene == kAllScenes ? "all scenes" : study.scenes[scene].name;
}

std::string rankText(const StudySummaries& all, const StudySummary& summary) {
    for (const StudyRanking& ranking : all.rankings)
        if (ranking.scene == summary.scene && ranking.spp == summary.spp && ranking.metric == summary.metric)
            for (const StudyRanking::Place& place : ranking.places)
                if (place.method == summary.method && summary.interval.known())
                    return place.rank.certain() ? fmt::format(" [{}]", place.rank.best)
                                                : fmt::format(" [{}-{}]", place.rank.best, place.rank.worst);
    return "";
}

/// Columns as wide as their widest cell; the first to the left, the others to the right.
class TextTable {
public:
    void add(std::vector<std::string> row) { rows_.push_back(std::move(row)); }
    bool empty() const { return rows_.size() < 2; }
    void print() const {
        std::vector<size_t> widths;
        for (const auto& row : rows_)
            for (size_t i = 0; i < row.size(); ++i) {
                widths.resize(std::max(widths.size(), row.size()));
                widths[i] = std::max(widths[i], lettersOf(row[i]));
            }
        for (const auto& row : rows_) {
            std::string line;
            for (size_t i = 0; i < row.size(); ++i) {
                const std::string room(widths[i] - lettersOf(row[i]), ' ');
                line += i == 0 ? row[i] + room : "   " + room + row[i];
            }
            std::puts(line.c_str());
        }
    }

private:
    static size_t lettersOf(const std::string& text) {
        return static_cast<size_t>(std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xc0) != 0x80; }));
    }
    std::vector<std::vector<std::string>> rows_;
};

const StudySummary* find(const StudySummaries& all, size_t scene, int spp, size_t method, const std::string& metric) {
    for (const StudySummary& summary : all.metrics)
        if (summary.scene == scene && summary.spp == spp && summary.method == method && summary.metric == metric)
            return &summary;
    return nullptr;
}

void printResults(const Study& study, const StudyOutcome& outcome) {
    std::vector<std::pair<size_t, int>> places;
    for (const StudySummary& summary : outcome.summaries.metrics)
        if (places.empty() || places.back() != std::pair(summary.scene, summary.spp))
            places.emplace_back(summary.scene, summary.spp);
    for (const auto& [scene, spp] : places) {
        TextTable table;
        std::vector<std::string> head{fmt::format("{}, {} spp", sceneName(study, scene), spp)};
        for (const std::string& metric : allMetrics(study)) head.push_back(metric);
        table.add(std::move(head));
        for (size_t method = 0; method < outcome.plan.methods.size(); ++method) {
            if (outcome.plan.methods[method].whole) continue;
            std::vector<std::string> row{"  " + outcome.plan.methods[method].name};
            bool any = false;
            for (const std::string& metric : allMetrics(study)) {
                const StudySummary* summary = find(outcome.summaries, scene, spp, method, metric);
                any = any || summary;
                row.push_back(!summary ? "-"
                                       : shown(summary->interval) + rankText(outcome.summaries, *summary) +
                                             (summary->missing ? fmt::format(" ({} without)", summary->missing) : ""));
            }
            if (any) table.add(std::move(row));
        }
        std::puts("");
        table.print();
    }
    if (study.seeds.size() > 1)
        std::puts(
            "\n[place] or [best-worst place that the intervals allow]: methods that share places are not told apart.");
}

void printNonFinite(const Study& study, const StudyOutcome& outcome) {
    for (const StudyNonFinite& found : outcome.summaries.nonFinite)
        std::puts(
            fmt::format("{}, {} spp, {}: {} pixels that are not finite, in {} of {} images; they count in no metric",
                        study.scenes[found.scene].name, found.spp, outcome.plan.methods[found.method].name,
                        found.pixels, found.images, found.allImages)
                .c_str());
    for (const StudyReferenceNote& note : outcome.records.references)
        if (note.nonFinitePixels > 0)
            std::puts(fmt::format("{}, reference of frame {}: {} pixels that are not finite",
                                  study.scenes[note.scene].name, note.frame, note.nonFinitePixels)
                          .c_str());
}

void printStages(const Study& study, const StudyOutcome& outcome) {
    std::set<std::pair<size_t, int>> places;
    for (const StudyStageEffect& effect : outcome.summaries.stages) places.insert({effect.scene, effect.spp});
    for (const auto& [scene, spp] : places) {
        TextTable table;
        std::vector<std::string> head{fmt::format("{}, {} spp, without", sceneName(study, scene), spp)};
        for (const std::string& metric : allMetrics(study)) head.push_back("Δ " + metric + "  ");
        head.push_back("Δ ms a frame  ");
        table.add(std::move(head));
        for (size_t method = 0; method < outcome.plan.methods.size(); ++method) {
            std::vector<std::string> row{"  " + outcome.plan.methods[method].stage};
            for (const StudyStageEffect& effect : outcome.summaries.stages)
                if (effect.scene == scene && effect.spp == spp && effect.without == method)
                    row.push_back(shownDifference(effect.difference));
            if (row.size() == 1) continue;
            for (const StudyStageTime& time : outcome.times.stages)
                if (time.scene == scene && time.spp == spp && time.without == method)
                    row.push_back(shownDifference(time.differenceMs));
            table.add(std::move(row));
        }
        std::puts("");
        table.print();
    }
    if (!places.empty()) std::puts("\n*: told from no difference at all.");
}

void printPairs(const Study& study, const StudyOutcome& outcome) {
    TextTable table;
    table.add({"equal time, equal value", "spp", "metric", "ms a frame", "value", "against", "at equal time",
               "difference  ", "ms for equal value", "times as long"});
    for (const StudyEqual& equal : outcome.times.pairs) {
        const auto reached = [&](const Interval& interval) {
            if (interval.count == 0) return std::string("out of range");
            const bool all = interval.count == static_cast<int64_t>(study.seeds.size());
            return shown(interval) + (all ? "" : fmt::format(" ({} of {} seeds)", interval.count, study.seeds.size()));
        };
        const bool timed = equal.otherAtEqualTime.count > 0, valued = equal.otherMsAtEqualValue.count > 0;
        table.add({fmt::format("  {}, {}", study.scenes[equal.scene].name, outcome.plan.methods[equal.method].name),
                   std::to_string(equal.spp), equal.metric, shown(equal.ms), shown(equal.value), equal.against,
                   reached(equal.otherAtEqualTime), timed ? shownDifference(equal.differenceAtEqualTime) : "-  ",
                   reached(equal.otherMsAtEqualValue), valued ? shown(equal.timesAsLong) : "-"});
    }
    if (table.empty()) return;
    std::puts("");
    table.print();
}

/// A row an entry: the frame, its phases, and what a ray costs.
void printTimes(const Study& study, const StudyOutcome& outcome) {
    for (size_t scene = 0; scene < study.scenes.size(); ++scene) {
        std::set<std::string> stages;
        for (const StudyMeanTime& time : outcome.times.methods)
            for (const auto& [stage, ms] : time.stagesMs)
                if (time.scene == scene) stages.insert(stage);
        TextTable table;
        std::vector<std::string> head{study.scenes[scene].name + ", ms a frame", "spp", "frame", "build", "trace"};
        head.insert(head.end(), stages.begin(), stages.end());
        head.insert(head.end(), {"Mrays a frame", "ns a ray, whole frame"});
        if (!study.tracingStages.empty()) head.push_back("ns a ray, tracing alone");
        table.add(std::move(head));
        for (const StudyMeanTime& time : outcome.times.methods) {
            if (time.scene != scene) continue;
            std::vector<std::string> row{"  " + outcome.plan.methods[time.method].name, std::to_string(time.spp),
                                         shown(time.frameMs), shown(time.buildMs), shown(time.traceMs)};
            for (const std::string& stage : stages) {
                const auto found = time.stagesMs.find(stage);
                row.push_back(found == time.stagesMs.end() ? "-" : shown(found->second));
            }
            row.push_back(fmt::format("{:.3f}", time.raysPerFrame.mean * 1e-6));
            row.push_back(shown(time.nsPerRay));
            if (!study.tracingStages.empty()) row.push_back(shown(time.tracingNsPerRay));
            table.add(std::move(row));
        }
        if (table.empty()) continue;
        std::puts("");
        table.print();
    }
}

void printChecks(const Study& study, const StudyOutcome& outcome) {
    TextTable table;
    table.add({"claims", "scene", "spp", "value", "against", "ratio", "verdict"});
    for (const StudyCheckResult& result : outcome.checks)
        table.add({"  " + claimText(study, study.checks[result.check]), sceneName(study, result.scene),
                   std::to_string(result.spp), shown(result.value), result.against.empty() ? "-" : result.against,
                   result.against.empty() ? "-" : shown(result.ratio), verdictText(result.verdict)});
    if (table.empty()) return;
    std::puts("");
    table.print();
}

}  // namespace

void printStudy(const StudyOutcome& outcome) {
    const Study& study = outcome.study;
    printResults(study, outcome);
    printNonFinite(study, outcome);
    printStages(study, outcome);
    printTimes(study, outcome);
    printPairs(study, outcome);
    printChecks(study, outcome);
}

}  // namespace lumi
