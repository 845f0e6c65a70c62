#pragma once
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "app/compare_command.h"
#include "measure/lag.h"

namespace lumi {

/// What `compare` found out about a sequence.
struct SequenceReport {
    int width = 0, height = 0;
    int64_t nonFinite = 0, nonFiniteImage = 0, nonFiniteReference = 0;  ///< pixels, over all frames
    float exposureEv = 0;
    std::string exposureFrom;
    std::vector<nlohmann::ordered_json> frames;  ///< "frame", counts, "metrics", "details", "no_value"
    std::vector<int64_t> missing;                ///< numbers between the first and the last frame without an image
    std::vector<int64_t> referencesAlone;        ///< numbers of references that have no image
    std::vector<std::string> warnings;
    std::vector<std::string> ids;  ///< of metrics that were asked for and have a value a frame
    bool lagWanted = false;
    Lag lag;
    nlohmann::ordered_json maps;  ///< ErrorMaps::ranges(); null: none were wanted
    std::string mapsText;
};

/// Means over the frames that have a value, and how many those are, by metric; lag stands beside them.
struct SequenceMean {
    std::string id;
    double mean = 0;      ///< NaN if no frame has a value
    int64_t frames = 0;   ///< that have one
    int64_t present = 0;  ///< that could have one: all but the first, for metrics of consecutive frames
};
std::vector<SequenceMean> sequenceMeans(const SequenceReport& report);

/// On stdout, as a table or as JSON; warnings on stderr unless `quiet`.
void printSequence(const SequenceReport& report, const CompareOptions& options);

}  // namespace lumi
