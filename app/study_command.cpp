#include "app/study_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "app/progress_line.h"
#include "app/study_tables.h"
#include "base/error.h"
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

/// The quick one where nothing is asked for: the study's own size may be hours.
std::string presetOf(const fs::path& file, const std::string& asked) {
    if (!asked.empty()) return asked;
    const std::vector<std::string> presets = studyPresets(file);
    return std::find(presets.begin(), presets.end(), "quick") == presets.end() ? "" : "quick";
}

}  // namespace

int runStudyCommand(const StudyCommandOptions& options, const MachineOptions& machine, MessageLog& log,
                    std::stop_token stop) {
    const fs::path file = findStudy(options.file);
    const Study study = loadStudy(file, presetOf(file, options.preset));
    StudyOptions run;
    run.out =
        options.out.empty() ? fs::path(study.name + (study.preset.empty() ? "" : "-" + study.preset)) : options.out;
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
    else printStudy(outcome);
    if (!machine.quiet) {
        std::fputs(fmt::format("{} jobs run, {} found done, {}\n", outcome.jobsRun, outcome.jobsFound,
                               formatDuration(outcome.seconds))
                       .c_str(),
                   stderr);
        std::map<std::string, int> folders;
        for (const fs::path& path : outcome.files) {
            if (path.parent_path() == run.out) std::fputs(fmt::format("Wrote {}\n", path.string()).c_str(), stderr);
            else ++folders[path.parent_path().string()];
        }
        for (const auto& [folder, count] : folders)
            std::fputs(fmt::format("Wrote {} files in {}\n", count, folder).c_str(), stderr);
    }
    const bool held = std::all_of(outcome.checks.begin(), outcome.checks.end(),
                                  [](const StudyCheckResult& result) { return result.asClaimed(); });
    return held ? 0 : static_cast<int>(ErrorKind::CheckFailed);
}

}  // namespace lumi
