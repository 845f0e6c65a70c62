#pragma once
#include <filesystem>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <stop_token>
#include <string>

#include "base/messages.h"
#include "study/study.h"
#include "study/summary.h"

namespace lumi {

struct StudyProgress {
    size_t job = 0, jobs = 0;  ///< the one that runs, from 0
    size_t found = 0;          ///< jobs that were done before
    std::string step;
    double fraction = 0;       ///< of all work
    double elapsedS = 0;
    double leftS = -1;         ///< estimate; below 0 while nothing is known
};

struct StudyOptions {
    std::filesystem::path out;             ///< folder; made if missing
    std::filesystem::path referenceCache;  ///< empty: references are made again each time
    std::stop_token stop{};
    std::function<void(const StudyProgress&)> progress{};  ///< on the calling thread, often
};

struct StudyOutcome {
    StudyPlan plan;
    StudyRecords records;
    StudySummaries summaries;
    std::vector<std::filesystem::path> files;  ///< results.json, results.csv, timings.json, report.html
    size_t jobsRun = 0, jobsFound = 0;
    double seconds = 0;
};

/// Runs what is missing of a study and writes its results into the folder. Every finished job is a folder of its own
/// under `jobs`, whose job.json is written last and atomically: after an interruption at any moment the study goes on
/// with the first unfinished job, and results.json and results.csv come out byte for byte as if it had never been
/// interrupted. Jobs of another definition, scene, instruction set or build of the program do not count, and are removed
/// at the end. One process works in a folder at a time.
/// Throws Error(Usage) if another does, Error(BadInput) for a scene or value that is not there, Error(Interrupted),
/// Error(Resources).
StudyOutcome runStudy(const Study& study, const StudyOptions& options, MessageLog& log);

}  // namespace lumi
