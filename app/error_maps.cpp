#include "app/error_maps.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"
#include "frame/display.h"
#include "image/exr.h"
#include "image/png.h"

namespace lumi {
namespace fs = std::filesystem;
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

void ErrorMaps::add(const std::string& metric, const std::string& suffix, const MapRange& empty, const Image& map) {
    ExrLayers layers;
    layers.add("", "Y", map);
    writeExr(folder_ / (metric + suffix + ".exr"), layers);
    auto maps = std::find_if(all_.begin(), all_.end(), [&](const Maps& m) { return m.metric == metric; });
    if (maps == all_.end()) maps = all_.insert(all_.end(), {metric, empty, {}});
    maps->range.add(map);
    maps->names.push_back(metric + suffix);
}

void ErrorMaps::finish() const {
    for (const Maps& maps : all_)
        for (const std::string& name : maps.names) {
            Image8 picture;
            convert(readExr(folder_ / (name + ".exr")).image("", "Y"), "Y", "none", maps.range.display(), picture);
            writePng(folder_ / (name + ".png"), picture);
        }
}

nlohmann::ordered_json ErrorMaps::ranges() const {
    nlohmann::ordered_json ranges = nlohmann::ordered_json::object();
    for (const Maps& maps : all_) ranges[maps.metric] = {{"low", 0}, {"high", maps.range.high()}};
    return ranges;
}

std::string ErrorMaps::text() const {
    std::string text;
    for (const Maps& maps : all_)
        text += fmt::format("{}{} 0 to {:.4g}", text.empty() ? "colours of the maps: " : ", ", maps.metric,
                            maps.range.high());
    return text;
}

}  // namespace lumi
