#include "app/compare_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "frame/display.h"
#include "image/exr.h"
#include "image/hdr.h"
#include "image/png.h"
#include "measure/measure.h"

namespace lumi {
namespace {

Image cropped(const Image& image, const std::array<int, 4>& crop, const std::string& where) {
    const auto [x, y, width, height] = crop;
    const bool inside = x >= 0 && y >= 0 && width > 0 && height > 0 && x + width <= image.width() &&
                        y + height <= image.height();
    if (!inside)
        throwUsage({"the crop leaves the image", where, fmt::format("a part of {}x{}", image.width(), image.height()),
                    fmt::format("{},{},{},{}", x, y, width, height)});
    Image out({width, height}, image.channels());
    for (int c = 0; c < image.channels(); ++c)
        for (int row = 0; row < height; ++row)
            std::copy_n(image.plane(c).row(y + row) + x, width, out.plane(c).row(row));
    return out;
}

Image luminanceMask(const Image& rgb) {
    Image mask(rgb.extent(), 1);
    for (int y = 0; y < rgb.height(); ++y)
        for (int x = 0; x < rgb.width(); ++x)
            mask.at(0, x, y) = luminance(Vec3(rgb.at(0, x, y), rgb.at(1, x, y), rgb.at(2, x, y)));
    return mask;
}

ImagePair loadPair(const CompareOptions& options) {
    ImagePair pair;
    pair.image = loadImage(options.image);
    pair.reference = loadImage(options.reference);
    if (!options.mask.empty()) pair.mask = luminanceMask(loadImage(options.mask));
    pair.exposureEv = options.exposureEv;
    if (!(pair.image.extent() == pair.reference.extent())) pair.prepare(options.image.string());  // throws
    if (options.crop) {
        pair.image = cropped(pair.image, *options.crop, "--crop");
        pair.reference = cropped(pair.reference, *options.crop, "--crop");
        if (!pair.mask.empty()) pair.mask = cropped(pair.mask, *options.crop, "--crop");
    }
    pair.prepare(options.image.string());
    return pair;
}

/// The error map as it is (.exr) and in false colour (.png).
void writeMap(const std::filesystem::path& folder, const Metric& metric, const Image& map) {
    ExrLayers layers;
    layers.add("", "Y", map);
    writeExr(folder / (std::string(metric.id) + ".exr"), layers);
    DisplaySettings settings;
    Image8 picture;
    convert(map, "Y", metric.mapColours, settings, picture);
    writePng(folder / (std::string(metric.id) + ".png"), picture);
}

void printTable(const ImagePair& pair, const std::vector<std::pair<const Metric*, Measurement>>& results, bool quiet) {
    for (const auto& [metric, result] : results) {
        fmt::print("{:<10} {:<12.6g} {}\n", metric->id, result.value, metric->definition);
        for (const auto& [name, value] : result.details) fmt::print("{:<10} {} = {:.6g}\n", "", name, value);
    }
    if (pair.nonFinitePixels > 0 && !quiet)
        fmt::print(stderr, "warning: {} pixels are NaN or infinite; they count in no metric\n", pair.nonFinitePixels);
}

}  // namespace

int runCompare(const CompareOptions& options) {
    std::vector<const Metric*> wanted;
    for (const std::string& id : options.metrics) wanted.push_back(&findMetric(id, "--metrics"));
    if (wanted.empty())
        for (const Metric& metric : metricCatalog()) wanted.push_back(&metric);

    const ImagePair pair = loadPair(options);
    if (!options.maps.empty()) std::filesystem::create_directories(options.maps);
    std::vector<std::pair<const Metric*, Measurement>> results;
    for (const Metric* metric : wanted) {
        const bool map = !options.maps.empty() && metric->mapColours;
        results.emplace_back(metric, metric->measure(pair, map));
        if (map) writeMap(options.maps, *metric, results.back().second.map);
    }
    if (!options.json) {
        printTable(pair, results, options.quiet);
        return 0;
    }
    nlohmann::ordered_json values, details = nlohmann::ordered_json::object();
    for (const auto& [metric, result] : results) {
        values[metric->id] = result.value;  // infinity and NaN become null
        for (const auto& [name, value] : result.details) details[metric->id][name] = value;
    }
    const nlohmann::ordered_json report = {{"width", pair.image.width()},
                                           {"height", pair.image.height()},
                                           {"nonfinite_pixels", pair.nonFinitePixels},
                                           {"metrics", values},
                                           {"details", details}};
    fmt::print("{}\n", report.dump(2));
    return 0;
}

}  // namespace lumi
