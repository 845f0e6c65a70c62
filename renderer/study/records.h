#pragma once
#include <filesystem>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "study/plan.h"

namespace lumi {

/// One measured image: a row of results.json and results.csv. Sequence rows (frame -1) hold metrics of consecutive
/// frames.
struct StudyRow {
    size_t scene = 0, method = 0;
    int64_t frame = -1;
    int spp = 1, seed = 0;
    std::map<std::string, double> metrics;
    std::map<std::string, double> corrected;     ///< without the reference's own error, where it can be taken off
    std::map<std::string, std::string> reasons;  ///< why a metric has no value, where it has none
    int64_t nonFinitePixels = 0;
    std::filesystem::path image, reference;  ///< of a frame; where they are

    /// The corrected value where there is one; NaN if the metric was not measured.
    double value(const std::string& metric) const;
};

/// Values of one metric over the consecutive frames of a sequence; of lag, the response to the step.
struct StudySeries {
    size_t scene = 0, method = 0;
    int spp = 1, seed = 0;
    std::string metric;
    int64_t begin = 0;  ///< frame of the first value
    std::vector<double> values;
};

struct StudyReferenceNote {
    size_t scene = 0;
    int64_t frame = 0;
    std::string file;
    float exposureEv = 0;
    std::map<std::string, double> floor;  ///< by metric: what the reference's noise alone is worth
    std::map<std::string, double> own;    ///< of metrics that judge one image: the reference's
    int64_t nonFinitePixels = 0;
    std::map<std::string, double> details;  ///< what metrics take from it
};

/// What tuning chose.
struct StudyChoice {
    size_t scene = 0, entry = 0;
    int spp = 1;
    std::vector<std::pair<std::string, std::string>> values;
    struct Candidate {
        std::vector<std::pair<std::string, std::string>> values;
        double metric = 0;
    };
    std::vector<Candidate> candidates;
    std::vector<std::string>
        atEnds;  ///< parameters of which the first or the last value was chosen: the best may lie beyond it
};

/// Median wall-clock times of a method's frames in one job.
struct StudyTime {
    size_t scene = 0, method = 0;
    int spp = 1, seed = 0;
    double traceMs = 0, poseMs = 0,
           runMs = 0;         ///< traceMs: of all signals that the job's methods read; 0 if the method reads none
    double raysPerFrame = 0;  ///< of the signals, if the method reads any, and those that it traced itself
    std::map<std::string, double> stagesMs;  ///< of run()
    double buildMs = 0;                      ///< of what is traced, where things move
    double frameMs() const { return poseMs + buildMs + traceMs + runMs; }
};

/// Everything that a study's jobs left.
struct StudyRecords {
    std::vector<StudyRow> rows;
    std::vector<StudySeries> series;
    std::vector<StudyReferenceNote> references;
    std::vector<StudyChoice> choices;
    std::vector<StudyTime> times;

    void add(const StudyPlan& plan, const StudyJob& job, const nlohmann::json& result, const nlohmann::json& times,
             const std::filesystem::path& folder, const std::filesystem::path& out);
};

}  // namespace lumi
