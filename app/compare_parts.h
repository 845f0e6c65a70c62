#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "app/compare_command.h"

namespace lumi {

/// Two images with what masks and crops leave of them, prepared for measuring.
ImagePair loadPair(const CompareOptions& options, const std::filesystem::path& image, const std::filesystem::path& reference);
/// The part of an image that --crop asks for, or all of it. Throws Error(Usage) if it leaves the image.
Image croppedAs(const CompareOptions& options, const Image& image);

using MetricResults = std::vector<std::pair<const Metric*, Measurement>>;
/// Measures, and writes maps as `<metric><suffix>.exr` and .png where they are asked for.
MetricResults measureAll(const CompareOptions& options, const std::vector<const Metric*>& metrics, const ImagePair& pair,
                         const std::string& suffix);
/// The error map as it is (.exr) and in false colour (.png).
void writeMap(const std::filesystem::path& folder, const std::string& name, const char* colours, const Image& map);
/// Members "metrics" and "details"; infinity and NaN are null.
nlohmann::ordered_json jsonOf(const MetricResults& results);

/// Sequences: see CompareOptions.
int runCompareSequence(const CompareOptions& options);
bool isSequence(const CompareOptions& options);

}  // namespace lumi
