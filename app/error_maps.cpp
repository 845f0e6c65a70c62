#include "app/error_maps.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "base/error.h"
#include "frame/display.h"
#include "frame/display_range.h"
#include "image/exr.h"
#include "image/png.h"

namespace lumi {
namespace fs = std::filesystem;
namespace {

/// Maps that are shown over all of [0, 1]: 0 is no difference, 1 a complete one.
bool hasUnitRange(const std::string& metric) {
    constexpr std::array<const char*, 5> ids{"ssim", "ms_ssim", "flip", "hdr_flip", "cpbd"};
    return std::find(ids.begin(), ids.end(), metric) != ids.end();
}

float reachOf(const Image& map) {
    const float* values = map.data();
    const float high = percentileRange(map.extent().area(), [values](int64_t i) { return values[i]; }).high;
    if (high > 0) return high;
    float largest = 0;
    for (size_t i = 0; i < map.size(); ++i)
        if (std::isfinite(values[i])) largest = std::max(largest, values[i]);
    return largest;
}

}  // namespace

ErrorMaps::ErrorMaps(const fs::path& folder) : folder_(folder) {
    if (folder.empty()) return;
    std::error_code failure;
    fs::create_directories(folder, failure);
    if (fs::is_directory(folder)) return;
    const bool full = failure == std::errc::no_space_on_device;
    const std::string found = fs::exists(folder) ? "a file" : failure.message();
    throw Error(full ? ErrorKind::Resources : ErrorKind::Usage,
                {"cannot be made: " + folder.string(), "--maps", "a folder", found});
}

void ErrorMaps::add(const std::string& metric, const std::string& suffix, const char* colours, const Image& map) {
    ExrLayers layers;
    layers.add("", "Y", map);
    writeExr(folder_ / (metric + suffix + ".exr"), layers);
    auto maps = std::find_if(all_.begin(), all_.end(), [&](const Maps& m) { return m.metric == metric; });
    if (maps == all_.end()) maps = all_.insert(all_.end(), {metric, colours, 0, {}});
    if (!hasUnitRange(metric)) maps->high = std::max(maps->high, reachOf(map));
    maps->names.push_back(metric + suffix);
}

float ErrorMaps::highOf(const Maps& maps) { return !hasUnitRange(maps.metric) && maps.high > 0 ? maps.high : 1; }

void ErrorMaps::finish() const {
    for (const Maps& maps : all_) {
        DisplaySettings settings;
        settings.autoRange = false, settings.low = 0, settings.high = highOf(maps);
        for (const std::string& name : maps.names) {
            Image8 picture;
            convert(readExr(folder_ / (name + ".exr")).image("", "Y"), "Y", maps.colours.c_str(), settings, picture);
            writePng(folder_ / (name + ".png"), picture);
        }
    }
}

nlohmann::ordered_json ErrorMaps::ranges() const {
    nlohmann::ordered_json ranges = nlohmann::ordered_json::object();
    for (const Maps& maps : all_) ranges[maps.metric] = {{"low", 0}, {"high", highOf(maps)}};
    return ranges;
}

std::string ErrorMaps::text() const {
    std::string text;
    for (const Maps& maps : all_)
        text += fmt::format("{}{} 0 to {:.4g}", text.empty() ? "colours of the maps: " : ", ", maps.metric, highOf(maps));
    return text;
}

}  // namespace lumi
