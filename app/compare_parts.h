#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "app/compare_command.h"
#include "app/error_maps.h"

namespace lumi {

/// Stops for the metrics that judge images as shown: --exposure; else those in the state of the reference, then of the
/// image; else 0. A picture that is stored as shown (.png and the like) has its exposure in it already: beside a linear
/// file only that file gets these stops, and the picture is judged as it is stored.
struct ExposureUsed {
    float ev = 0;
    std::string from;     ///< "--exposure", "state of ref.exr", "no state", "state of ref.exr; a.png stored as shown"
    std::string warning;  ///< the two files differ in kind or exposure; empty: they do not
};

/// Two images with what masks and crops leave of them, prepared for measuring, and as they came.
struct ComparedPair {
    ImagePair pair;
    Image image, reference;  ///< before non-finite pixels were blanked; held if `layers` was asked for
    Image motion, depth;     ///< of the reference, where it has them; read if `layers` was asked for
    ExposureUsed exposure;
};

ComparedPair loadPair(const CompareOptions& options, const std::filesystem::path& image,
                      const std::filesystem::path& reference, bool layers);

using MetricResults = std::vector<std::pair<const Metric*, Measurement>>;
/// Measures, and adds the maps where they are wanted.
MetricResults measureAll(const std::vector<const Metric*>& metrics, const ImagePair& pair, ErrorMaps& maps,
                         const std::string& suffix);
/// Adds a measurement to the members "metrics", "details" and "no_value" (why a number is NaN or infinite, which is
/// null).
void addMeasurement(nlohmann::ordered_json& report, const std::string& id, const Measurement& measurement);
/// Members "nonfinite_pixels" (of the two together), "nonfinite_image", "nonfinite_reference" and "counted_pixels".
void addCounts(nlohmann::ordered_json& report, const ImagePair& pair);
/// A number as tables show it: "-" for NaN.
std::string valueText(double value);

/// Sequences: see CompareOptions.
int runCompareSequence(const CompareOptions& options);
bool isSequence(const CompareOptions& options);

}  // namespace lumi
