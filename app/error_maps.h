#pragma once
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "measure/map_range.h"

namespace lumi {

/// The error maps of one `compare`: `<metric><suffix>.exr` as they are, and .png in false colour. All maps of a metric
/// share the range of a MapRange, so that frames of a sequence can be laid beside each other.
class ErrorMaps {
public:
    /// Makes the folder; an empty name: no maps are wanted. Throws Error(Usage), Error(Resources) if it cannot be made.
    explicit ErrorMaps(const std::filesystem::path& folder);

    bool wanted() const { return !folder_.empty(); }
    /// Writes the .exr and takes it up in the range, which begins as `empty`; `map` has one channel.
    void add(const std::string& metric, const std::string& suffix, const MapRange& empty, const Image& map);
    /// Writes the pictures, when the ranges are known.
    void finish() const;

    /// By metric: {"low": 0, "high": h}.
    nlohmann::ordered_json ranges() const;
    /// One line for people; empty without maps.
    std::string text() const;

private:
    struct Maps {
        std::string metric;
        MapRange range;
        std::vector<std::string> names;  ///< without extension
    };

    std::filesystem::path folder_;
    std::vector<Maps> all_;
};

}  // namespace lumi
