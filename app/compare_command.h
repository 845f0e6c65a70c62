#pragma once
#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace lumi {

struct CompareOptions {
    std::filesystem::path image, reference;
    std::vector<std::string> metrics;          ///< empty: all
    std::filesystem::path maps;                ///< folder for error maps; empty: none
    std::optional<std::array<int, 4>> crop;    ///< x, y, width, height
    std::filesystem::path mask;                ///< image whose luminance above 0.5 counts; empty: everything counts
    float exposureEv = 0;
    bool json = false, quiet = false;
};

/// Prints the metrics of two images on stdout. Returns 0; throws Error.
int runCompare(const CompareOptions& options);

}  // namespace lumi
