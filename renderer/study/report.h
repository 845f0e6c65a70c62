#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "study/records.h"

namespace lumi {

/// The report: one HTML file that needs nothing else, with tables, plots (SVG), and images and error maps (PNG inside)
/// that can be compared under a wipe. `results` and `times` are what results.json and timings.json hold.
std::string studyReport(const Study& study, const StudyPlan& plan, const StudyRecords& records,
                        const nlohmann::ordered_json& results, const nlohmann::ordered_json& times);

/// The pictures of a report, a set for each scene, frame and number of samples: {"scene", "frame", "spp", "width",
/// "height", "images": [{"name", "kind": "reference" | "method" | "error", "of": name, "png": data URI}],
/// "error_map": {"title", "low", "high", "colours"}}. Images are those of the first seed, as metrics see them.
nlohmann::ordered_json reportPictures(const Study& study, const StudyPlan& plan, const StudyRecords& records);

std::string base64(const std::vector<uint8_t>& bytes);

}  // namespace lumi
