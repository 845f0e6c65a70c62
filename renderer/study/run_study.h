#pragma once
#include <filesystem>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <stop_token>
#include <string>

#include "base/messages.h"
#include "study/checks.h"
#include "study/study.h"
#include "study/summary.h"
#include "study/times.h"

namespace lumi {

struct StudyProgress {
    size_t job = 0, jobs = 0;  ///< the one that runs, from 0
    size_t found = 0;          ///< jobs that were done before
    std::string step;
    double fraction = 0;  ///< of all work
    double elapsedS = 0;
    double leftS = -1;  ///< estimate; below 0 while nothing is known
};

struct StudyOptions {
    std::filesystem::path out;             ///< folder; made if missing
    std::filesystem::path referenceCache;  ///< empty: references are made again each time
    std::stop_token stop{};
    std::function<void(const StudyProgress&)> progress{};  ///< often; one call at a time, on any thread
};

struct StudyOutcome {
    Study study;  ///< without the scenes that were left out: indices of scenes are into this
    StudyPlan plan;
    StudyRecords records;
    StudySummaries summaries;
    StudyTimes times;
    std::vector<StudyCheckResult> checks;
    std::vector<std::filesystem::path>
        files;  ///< results.json, results.csv, timings.json, report.html, figures/, tables/
    size_t jobsRun = 0, jobsFound = 0;
    double seconds = 0;
};

/// Runs what is missing of a study and writes its results into the folder. Every finished job is a folder of its own
/// under `jobs`, whose job.json is written last and atomically: after an interruption at any moment the study goes on
/// with the first unfinished job, and results.json and results.csv come out byte for byte as if it had never been
/// interrupted. Jobs of another definition, scene, instruction set or build of the program do not count, and are
/// removed at the end. Scenes and values are checked before the first job; figures and tables are made anew each time,
/// from what the jobs left. Throws Error(Usage) if the folder is not this study's (StudyFolder), Error(BadInput) for a
/// scene or value that is not there, Error(Interrupted), Error(Resources).
StudyOutcome runStudy(const Study& study, const StudyOptions& options, MessageLog& log);

}  // namespace lumi
