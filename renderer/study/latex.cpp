#include "study/latex.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "study/number_text.h"
#include "study/report.h"
#include "study/report_resources.h"

namespace lumi {
namespace {

/// What goes into the template.
struct Rows {
    std::string name, title, caption, columns, head;
    std::vector<std::string> lines;  ///< without the line's end; empty: a rule between groups
};

std::string metricTitle(const Study& study, const std::string& id) {
    return escapedLatex(titleOf(study, id)) + (higherIsBetter(study, id) ? " $\\uparrow$" : " $\\downarrow$");
}

std::string cell(const Interval& interval, bool strong = false) { return latexText(numberText(interval), strong); }

/// A difference that the intervals tell from none is bold.
std::string differenceCell(const Interval& interval) {
    NumberText text = numberText(interval);
    if (interval.mean > 0 && text.mean != "-") text.mean = "+" + text.mean;
    return latexText(text, interval.excludesZero());
}

std::string sceneTitle(const Study& study, size_t scene) {
    return scene == kAllScenes ? "all scenes together" : escapedLatex(study.scenes[scene].name);
}
std::string sceneFile(const Study& study, size_t scene) {
    return scene == kAllScenes ? "all-scenes" : fileNameOf(study.scenes[scene].name);
}

std::string seedsText(const Study& study) {
    if (study.seeds.size() < 2) return "One seed: nothing is known of the noise, and nothing is ranked.";
    return fmt::format("Means over {} seeds with the half-width of the {:g}\\,\\% interval.", study.seeds.size(),
                       100 * study.intervals.level);
}

std::string asFile(const Study& study, const Rows& rows) {
    std::string body;
    for (size_t i = 0; i < rows.lines.size(); ++i)
        body +=
            (i ? "\n" : "") + (rows.lines[i].empty() ? std::string("    \\midrule") : "    " + rows.lines[i] + " \\\\");
    return filledTemplate(
        kTableTex, "<<", ">>",
        {{"comment", fmt::format("Study {}{}, file {}.", fileNameOf(study.name),
                                 study.preset.empty() ? "" : ", preset " + fileNameOf(study.preset), study.digest)},
         {"caption", rows.caption},
         {"label", fileNameOf(study.name) + "-" + rows.name},
         {"columns", rows.columns},
         {"head", "    " + rows.head + " \\\\"},
         {"body", body}});
}

std::string joinedCells(const std::vector<std::string>& cells) {
    std::string line;
    for (const std::string& text : cells) line += (line.empty() ? "" : " & ") + text;
    return line;
}

const StudySummary* summaryOf(const StudySummaries& all, size_t scene, size_t method, int spp,
                              const std::string& metric) {
    for (const StudySummary& summary : all.metrics)
        if (summary.scene == scene && summary.method == method && summary.spp == spp && summary.metric == metric)
            return &summary;
    return nullptr;
}

bool isSurelyBest(const StudySummaries& all, const StudySummary& summary) {
    for (const StudyRanking& ranking : all.rankings)
        if (ranking.scene == summary.scene && ranking.spp == summary.spp && ranking.metric == summary.metric)
            for (const StudyRanking::Place& place : ranking.places)
                if (place.method == summary.method)
                    return summary.interval.known() && place.rank.certain() && place.rank.best == 1;
    return false;
}

/// A row an entry and sample count, a column a metric, and the time of a frame.
Rows resultRows(const Study& study, const StudyPlan& plan, const StudySummaries& all, const StudyTimes& times,
                size_t scene) {
    const std::vector<std::string> metrics = allMetrics(study);
    Rows rows{"results-" + sceneFile(study, scene),
              "Results, " + (scene == kAllScenes ? "all scenes together" : study.scenes[scene].name),
              "",
              "lr",
              "Method & spp",
              {}};
    for (const std::string& metric : metrics) rows.columns += "r", rows.head += " & " + metricTitle(study, metric);
    const bool timed = scene != kAllScenes;
    if (timed) rows.columns += "r", rows.head += " & ms / frame";
    rows.caption =
        fmt::format("{}: {}. {} The best value of a sample count is bold where its intervals tell it from all others.",
                    escapedLatex(study.title), sceneTitle(study, scene), seedsText(study));
    std::vector<int> counts;
    for (const StudySummary& summary : all.metrics)
        if (summary.scene == scene && !std::count(counts.begin(), counts.end(), summary.spp))
            counts.push_back(summary.spp);
    std::sort(counts.begin(), counts.end());
    for (const int spp : counts) {
        if (!rows.lines.empty()) rows.lines.emplace_back();
        for (size_t method = 0; method < plan.methods.size(); ++method) {
            if (plan.methods[method].whole || !summaryOf(all, scene, method, spp, metrics.front())) continue;
            std::vector<std::string> cells{escapedLatex(plan.methods[method].name), std::to_string(spp)};
            for (const std::string& metric : metrics) {
                const StudySummary* summary = summaryOf(all, scene, method, spp, metric);
                cells.push_back(summary ? cell(summary->interval, isSurelyBest(all, *summary)) : "--");
            }
            const StudyMeanTime* time = timed ? times.find(scene, method, spp) : nullptr;
            if (timed) cells.push_back(time ? cell(time->frameMs) : "--");
            rows.lines.push_back(joinedCells(cells));
        }
    }
    return rows;
}

/// Where the other's sample counts do not reach in every seed, how many seeds the number is of.
std::string reachedCell(const Interval& interval, size_t seeds) {
    if (interval.count == 0) return "out of range";
    if (interval.count == static_cast<int64_t>(seeds)) return cell(interval);
    return cell(interval) + fmt::format(" ({} of {} seeds)", interval.count, seeds);
}

Rows equalRows(const Study& study, const StudyPlan& plan, const StudyTimes& times, size_t scene) {
    Rows rows{"equal-" + sceneFile(study, scene),
              "Equal time and equal error, " + study.scenes[scene].name,
              "",
              "lrlrrlrrrr",
              "Method & spp & Metric & ms / frame & Value & Against & \\multicolumn{2}{c}{at equal time} & "
              "\\multicolumn{2}{c}{at equal value} \\\\\n"
              "    \\cmidrule(lr){7-8} \\cmidrule(lr){9-10}\n    & & & & & & value & difference & ms & times as long",
              {}};
    rows.caption = fmt::format(
        "{}: equal time and equal error on {}. {} The other's values lie between its sample counts, on straight lines "
        "in log-log space; "
        "a difference is bold where it is told from none. Times are of one machine.",
        escapedLatex(study.title), sceneTitle(study, scene), seedsText(study));
    for (const StudyEqual& equal : times.pairs) {
        if (equal.scene != scene) continue;
        const Interval& difference = equal.differenceAtEqualTime;
        rows.lines.push_back(
            joinedCells({escapedLatex(plan.methods[equal.method].name), std::to_string(equal.spp),
                         metricTitle(study, equal.metric), cell(equal.ms), cell(equal.value),
                         escapedLatex(equal.against), reachedCell(equal.otherAtEqualTime, study.seeds.size()),
                         difference.count ? differenceCell(difference) : "--",
                         reachedCell(equal.otherMsAtEqualValue, study.seeds.size()),
                         equal.timesAsLong.count ? cell(equal.timesAsLong) : "--"}));
    }
    return rows;
}

const StudyStageTime* stageTimeOf(const StudyTimes& times, const StudyStageEffect& effect) {
    for (const StudyStageTime& time : times.stages)
        if (time.scene == effect.scene && time.without == effect.without && time.spp == effect.spp) return &time;
    return nullptr;
}

/// Which stages' differences are of other samples.
std::string exceptText(const Study& study, const StudyPlan& plan) {
    std::string names;
    for (const StudyMethod& method : plan.methods)
        if (tracesApart(study, method)) names += (names.empty() ? "" : ", ") + escapedLatex(method.name);
    return names.empty() ? "" : "; not so " + names + ", traced with samples of its own";
}

/// A row a stage, a column a metric's change without it, and the time's.
Rows ablationRows(const Study& study, const StudyPlan& plan, const StudySummaries& all, const StudyTimes& times,
                  size_t scene) {
    const std::vector<std::string> metrics = allMetrics(study);
    Rows rows{"ablation-" + sceneFile(study, scene),
              "Ablation, " + (scene == kAllScenes ? "all scenes together" : study.scenes[scene].name),
              "",
              "llr",
              "Method & Without & spp",
              {}};
    for (const std::string& metric : metrics)
        rows.columns += "r", rows.head += " & $\\Delta$ " + metricTitle(study, metric);
    const bool timed = scene != kAllScenes;
    if (timed) rows.columns += "r", rows.head += " & $\\Delta$ ms / frame";
    rows.caption = fmt::format(
        "{}: each stage switched off in turn, on {}. Differences to the whole method on the same samples{}. {} A "
        "difference is bold where "
        "it is told from none.",
        escapedLatex(study.title), sceneTitle(study, scene), exceptText(study, plan), seedsText(study));
    for (const StudyStageEffect& effect : all.stages) {
        if (effect.scene != scene || effect.metric != metrics.front()) continue;
        std::vector<std::string> cells{escapedLatex(plan.methods[effect.whole].name),
                                       escapedLatex(plan.methods[effect.without].stage), std::to_string(effect.spp)};
        for (const std::string& metric : metrics) {
            const auto own = std::find_if(all.stages.begin(), all.stages.end(), [&](const StudyStageEffect& stage) {
                return stage.scene == scene && stage.without == effect.without && stage.spp == effect.spp &&
                       stage.metric == metric;
            });
            cells.push_back(own == all.stages.end() ? "--" : differenceCell(own->difference));
        }
        const StudyStageTime* time = timed ? stageTimeOf(times, effect) : nullptr;
        if (timed) cells.push_back(time ? differenceCell(time->differenceMs) : "--");
        rows.lines.push_back(joinedCells(cells));
    }
    return rows;
}

/// A row an entry, a column a phase: what a frame's time is spent on.
Rows timeRows(const Study& study, const StudyPlan& plan, const StudyTimes& times, size_t scene) {
    std::set<std::string> stages;
    for (const StudyMeanTime& time : times.methods)
        for (const auto& [stage, ms] : time.stagesMs)
            if (time.scene == scene) stages.insert(stage);
    Rows rows{"times-" + sceneFile(study, scene),
              "Times, " + study.scenes[scene].name,
              "",
              "lrrrr",
              "Method & spp & ms / frame & build & trace",
              {}};
    for (const std::string& stage : stages) rows.columns += "r", rows.head += " & " + escapedLatex(stage);
    const bool tracing = !study.tracingStages.empty();
    rows.columns += tracing ? "rrr" : "rr", rows.head += " & Mrays / frame & ns / ray, whole frame";
    if (tracing) rows.head += " & ns / ray, tracing alone";
    rows.caption = fmt::format(
        "{}: medians of a frame's phases on {}, in milliseconds. Methods that share their samples share one trace, of "
        "all signals that any of them reads. Times are of one machine.",
        escapedLatex(study.title), sceneTitle(study, scene));
    for (const StudyMeanTime& time : times.methods) {
        if (time.scene != scene) continue;
        std::vector<std::string> cells{escapedLatex(plan.methods[time.method].name), std::to_string(time.spp),
                                       cell(time.frameMs), cell(time.buildMs), cell(time.traceMs)};
        for (const std::string& stage : stages)
            cells.push_back(time.stagesMs.contains(stage) ? cell(time.stagesMs.at(stage)) : "--");
        cells.push_back(fmt::format("{:.3f}", time.raysPerFrame.mean * 1e-6));
        cells.push_back(time.nsPerRay.count ? cell(time.nsPerRay) : "--");
        if (tracing) cells.push_back(time.tracingNsPerRay.count ? cell(time.tracingNsPerRay) : "--");
        rows.lines.push_back(joinedCells(cells));
    }
    return rows;
}

Rows definitionRows(const Study& study) {
    Rows rows{"metrics",
              "Metrics",
              "The metrics of " + escapedLatex(study.title) + ".",
              "lp{0.78\\textwidth}",
              "Metric & Definition",
              {}};
    for (const std::string& metric : allMetrics(study))
        rows.lines.push_back(metricTitle(study, metric) + " & " + escapedLatex(definitionOf(study, metric)));
    return rows;
}

}  // namespace

std::string escapedLatex(const std::string& text) {
    std::string out;
    for (const char c : text) switch (c) {
            case '&':
            case '%':
            case '$':
            case '#':
            case '_':
            case '{':
            case '}': out += std::string("\\") + c; break;
            case '~': out += "\\textasciitilde{}"; break;
            case '^': out += "\\textasciicircum{}"; break;
            case '\\': out += "\\textbackslash{}"; break;
            case '<': out += "\\textless{}"; break;
            case '>': out += "\\textgreater{}"; break;
            case '\n':
            case '\r':
            case '\t': out += ' '; break;
            default: out += c;
        }
    return out;
}

std::vector<LatexTable> latexTables(const Study& study, const StudyPlan& plan, const StudySummaries& summaries,
                                    const StudyTimes& times) {
    std::vector<size_t> scenes;
    for (size_t scene = 0; scene < study.scenes.size(); ++scene) scenes.push_back(scene);
    if (scenes.size() > 1) scenes.push_back(kAllScenes);
    std::vector<Rows> all;
    for (const size_t scene : scenes) all.push_back(resultRows(study, plan, summaries, times, scene));
    for (const size_t scene : scenes)
        if (scene != kAllScenes) all.push_back(timeRows(study, plan, times, scene));
    for (const size_t scene : scenes)
        if (scene != kAllScenes && !study.pairs.empty()) all.push_back(equalRows(study, plan, times, scene));
    for (const size_t scene : scenes)
        if (!study.ablations.empty()) all.push_back(ablationRows(study, plan, summaries, times, scene));
    all.push_back(definitionRows(study));
    std::vector<LatexTable> tables;
    for (const Rows& rows : all)
        if (!rows.lines.empty()) tables.push_back({rows.name, rows.title, asFile(study, rows)});
    return tables;
}

std::string latexDocument(const Study& study, const std::vector<DrawnFigure>& figures,
                          const std::vector<LatexTable>& tables) {
    std::string pictures, inputs;
    for (const DrawnFigure& figure : figures)
        pictures += fmt::format(
            "\\begin{{figure*}}[t]\n  \\centering\n  \\includegraphics[width=\\textwidth]{{../figures/{}.png}}\n  "
            "\\caption{{{}}}\n\\end{{figure*}}\n",
            figure.name, escapedLatex(figure.caption));
    for (const LatexTable& table : tables) inputs += fmt::format("\\input{{{}}}\n", table.name);
    return filledTemplate(kDocumentTex, "<<", ">>",
                          {{"comment", "All tables and figures of the study, to look at: run LaTeX in this folder."},
                           {"title", escapedLatex(study.title)},
                           {"figures", pictures},
                           {"tables", inputs}});
}

}  // namespace lumi
