#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "study/checks.h"
#include "study/summary.h"
#include "study/times.h"

namespace lumi {

/// results.json: what was run, every row, references with their noise, tuning, and the summaries. It holds no time of
/// day, duration, thread count, host or path, so that an interrupted study ends with the bytes of an uninterrupted one.
nlohmann::ordered_json resultsJson(const Study& study, const StudyPlan& plan, const StudyRecords& records,
                                   const StudySummaries& summaries, const std::vector<StudyCheckResult>& checks = {});

/// results.csv: a row per (scene, frame or sequence, entry, spp, seed), metrics as columns, `<metric>_corrected` beside
/// those whose reference noise is taken off; numbers in the shortest form that reads back as the same.
std::string resultsCsv(const Study& study, const StudyPlan& plan, const StudyRecords& records);

/// timings.json: wall-clock medians of this machine, a row per (scene, entry, spp), what equal times and equal errors
/// come to for the study's pairs, and what stages cost. Never the same twice.
nlohmann::ordered_json timingsJson(const Study& study, const StudyPlan& plan, const StudyTimes& times,
                                   const std::vector<StudyCheckResult>& checks = {});

/// Verdicts of claims: those about times, which stand in timings.json, or the others.
nlohmann::ordered_json checksJson(const Study& study, const std::vector<StudyCheckResult>& checks, bool timed);

/// {"mean", "standard_error", "low", "high", "count"}; null where nothing is known.
nlohmann::ordered_json intervalJson(const Interval& interval);

}  // namespace lumi
