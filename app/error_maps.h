#pragma once
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "image/image.h"

namespace lumi {

/// The error maps of one `compare`: `<metric><suffix>.exr` as they are, and .png in false colour. All maps of a metric have
/// one range of colours, from 0: to 1 for SSIM, MS-SSIM, both FLIPs and CPBD; else to the largest 99th percentile of a map
/// (its largest value where that is 0; 1 where all are 0). So frames of a sequence can be laid beside each other.
class ErrorMaps {
public:
    /// Makes the folder; an empty name: no maps are wanted. Throws Error(Usage), Error(Resources) if it cannot be made.
    explicit ErrorMaps(const std::filesystem::path& folder);

    bool wanted() const { return !folder_.empty(); }
    /// Writes the .exr and notes the range; `map` has one channel.
    void add(const std::string& metric, const std::string& suffix, const char* colours, const Image& map);
    /// Writes the pictures, when the ranges are known.
    void finish() const;

    /// By metric: {"low": 0, "high": h}.
    nlohmann::ordered_json ranges() const;
    /// One line for people; empty without maps.
    std::string text() const;

private:
    struct Maps {
        std::string metric, colours;
        float high = 0;
        std::vector<std::string> names;  ///< without extension
    };
    static float highOf(const Maps& maps);

    std::filesystem::path folder_;
    std::vector<Maps> all_;
};

}  // namespace lumi
