#pragma once
#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "measure/measure.h"

namespace lumi {

struct CompareOptions {
    /// Images, or patterns with %04d for the number of a frame; one reference may serve all frames.
    std::filesystem::path image, reference;
    std::vector<std::string> metrics;        ///< empty: all
    std::filesystem::path maps;              ///< folder for error maps; empty: none
    std::optional<std::array<int, 4>> crop;  ///< x, y, width, height
    std::filesystem::path mask;              ///< image whose luminance above 0.5 counts; empty: everything counts
    std::optional<float> exposureEv;         ///< else what the state in the files says
    MetricSettings settings;
    std::optional<std::pair<int64_t, int64_t>> frames;  ///< half-open, of patterns; else the files there are
    bool json = false, quiet = false;
};

/// Prints the metrics of two images, or of two sequences, on stdout. Returns 0; throws Error.
int runCompare(const CompareOptions& options);

}  // namespace lumi
