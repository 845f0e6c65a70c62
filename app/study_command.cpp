#include "app/study_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <mutex>
#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "app/progress_line.h"
#include "base/files.h"
#include "reference/reference.h"
#include "study/run_study.h"
#include "study/study_file.h"

namespace lumi {
namespace fs = std::filesystem;
namespace {

constexpr size_t kBarWidth = 24;

std::string progressText(const StudyProgress& progress) {
    const size_t full = static_cast<size_t>(progress.fraction * kBarWidth);
    std::string bar;
    for (size_t i = 0; i < kBarWidth; ++i) bar += i < full ? "█" : "░";
    const std::string left = progress.leftS >= 0 ? formatDuration(progress.leftS) + " left" : "";
    constexpr size_t kWidest = 64;
    std::string step = progress.step;
    if (step.size() > kWidest) {
        step.resize(kWidest - 3);
        step += "...";
    }
    return fmt::format("{} {:3.0f}%  {}  job {} of {}  {}", bar, 100 * progress.fraction, left,
                       std::min(progress.job + 1, progress.jobs), progress.jobs, step);
}

std::string numberText(double value) { return std::isfinite(value) ? fmt::format("{:.4g}", value) : "-"; }

std::string rankText(const StudyRanking* ranking, size_t method) {
    if (!ranking) return "";
    for (const StudyRanking::Place& place : ranking->places)
        if (place.method == method)
            return place.rank.certain() ? fmt::format("[{}]", place.rank.best)
                                        : fmt::format("[{}-{}]", place.rank.best, place.rank.worst);
    return "";
}

/// One table a scene and number of samples: a row an entry, a column a metric, with interval and place.
void printTables(const Study& study, const StudyOutcome& outcome) {
    const StudySummary* last = nullptr;
    std::vector<std::string> metrics = study.metrics;
    metrics.insert(metrics.end(), study.temporalMetrics.begin(), study.temporalMetrics.end());
    const bool ranked = study.seeds.size() > 1;
    for (const StudySummary& summary : outcome.summaries.metrics) {
        if (!last || last->scene != summary.scene || last->spp != summary.spp) {
            const std::string scene = summary.scene == kAllScenes ? "all scenes" : study.scenes[summary.scene].name;
            std::string head = fmt::format("\n{:<40}", fmt::format("{}, {} spp", scene, summary.spp));
            for (const std::string& metric : metrics) head += fmt::format("{:>28}", metric);
            std::puts(head.c_str());
        }
        if (!last || last->scene != summary.scene || last->spp != summary.spp || last->method != summary.method) {
            std::string row = fmt::format("  {:<38}", outcome.plan.methods[summary.method].name);
            for (const std::string& metric : metrics) {
                std::string cell = "-";
                for (const StudySummary& own : outcome.summaries.metrics) {
                    if (own.scene != summary.scene || own.spp != summary.spp || own.method != summary.method || own.metric != metric)
                        continue;
                    const StudyRanking* ranking = nullptr;
                    for (const StudyRanking& one : outcome.summaries.rankings)
                        if (one.scene == own.scene && one.spp == own.spp && one.metric == metric) ranking = &one;
                    cell = numberText(own.interval.mean);
                    if (own.interval.known())
                        cell += fmt::format(" ± {} {:<6}", numberText((own.interval.high - own.interval.low) / 2),
                                            ranked ? rankText(ranking, own.method) : "");
                }
                // fmt counts "±" as one column.
                row += fmt::format("{:>28}", cell);
            }
            std::puts(row.c_str());
        }
        last = &summary;
    }
    if (ranked)
        std::puts("\n[place] or [best-worst place that the intervals allow]: methods that share places are not told apart.");
}

/// The quick one where nothing is asked for: the study's own size may be hours.
std::string presetOf(const fs::path& file, const std::string& asked) {
    if (!asked.empty()) return asked;
    const std::vector<std::string> presets = studyPresets(file);
    return std::find(presets.begin(), presets.end(), "quick") == presets.end() ? "" : "quick";
}

}  // namespace

int runStudyCommand(const StudyCommandOptions& options, const MachineOptions& machine, MessageLog& log, std::stop_token stop) {
    const fs::path file = findStudy(options.file);
    const Study study = loadStudy(file, presetOf(file, options.preset));
    StudyOptions run;
    run.out = options.out.empty() ? fs::path(study.name + (study.preset.empty() ? "" : "-" + study.preset)) : options.out;
    run.referenceCache = defaultReferenceCache();
    run.stop = stop;
    std::mutex mutex;
    StudyProgress latest;
    run.progress = [&](const StudyProgress& progress) {
        const std::lock_guard lock(mutex);
        latest = progress;
    };
    printMessages(log, machine);
    StudyOutcome outcome;
    {
        const bool shown = !machine.quiet && (options.progress == Progress::Always ||
                                              (options.progress == Progress::Auto && stderrIsTerminal()));
        ProgressLine line(shown, [&] {
            const std::lock_guard lock(mutex);
            return progressText(latest);
        });
        outcome = runStudy(study, run, log);
    }
    if (machine.json) std::fputs(readTextFile(run.out / "results.json").c_str(), stdout);
    else printTables(study, outcome);
    if (!machine.quiet) {
        std::fputs(fmt::format("{} jobs run, {} found done, {}\n", outcome.jobsRun, outcome.jobsFound,
                               formatDuration(outcome.seconds))
                       .c_str(),
                   stderr);
        for (const fs::path& path : outcome.files) std::fputs(fmt::format("Wrote {}\n", path.string()).c_str(), stderr);
    }
    return 0;
}

}  // namespace lumi
