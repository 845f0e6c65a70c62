#include "app/compare_parts.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"
#include "frame/display.h"
#include "image/exr.h"
#include "image/hdr.h"
#include "image/png.h"
#include "measure/metrics.h"
#include "measure/temporal.h"

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

}  // namespace

Image croppedAs(const CompareOptions& options, const Image& image) {
    return options.crop && !image.empty() ? cropped(image, *options.crop, "--crop") : image;
}

ImagePair loadPair(const CompareOptions& options, const std::filesystem::path& image, const std::filesystem::path& reference) {
    ImagePair pair;
    pair.image = loadImage(image);
    pair.reference = loadImage(reference);
    if (!options.mask.empty()) pair.mask = luminanceMask(loadImage(options.mask));
    pair.exposureEv = options.exposureEv;
    pair.flipExposures = options.flipExposures;
    if (!(pair.image.extent() == pair.reference.extent())) pair.prepare(image.string());  // throws
    if (options.crop) {
        // Exposures belong to the whole reference, whichever part of it is looked at.
        if (!pair.flipExposures) pair.flipExposures = flipExposures(pair.reference);
        pair.image = croppedAs(options, pair.image);
        pair.reference = croppedAs(options, pair.reference);
        pair.mask = croppedAs(options, pair.mask);
    }
    pair.prepare(image.string());
    return pair;
}

void writeMap(const std::filesystem::path& folder, const std::string& name, const char* colours, const Image& map) {
    ExrLayers layers;
    layers.add("", "Y", map);
    writeExr(folder / (name + ".exr"), layers);
    DisplaySettings settings;
    Image8 picture;
    convert(map, "Y", colours, settings, picture);
    writePng(folder / (name + ".png"), picture);
}

MetricResults measureAll(const CompareOptions& options, const std::vector<const Metric*>& metrics, const ImagePair& pair,
                         const std::string& suffix) {
    MetricResults results;
    for (const Metric* metric : metrics) {
        const bool map = !options.maps.empty() && metric->mapColours;
        results.emplace_back(metric, metric->measure(pair, map));
        if (map) writeMap(options.maps, metric->id + suffix, metric->mapColours, results.back().second.map);
    }
    return results;
}

nlohmann::ordered_json jsonOf(const MetricResults& results) {
    nlohmann::ordered_json values, details = nlohmann::ordered_json::object();
    for (const auto& [metric, result] : results) {
        values[metric->id] = result.value;
        for (const auto& [name, value] : result.details) details[metric->id][name] = value;
    }
    return {{"metrics", values}, {"details", details}};
}

namespace {

void printTable(const ImagePair& pair, const MetricResults& results, bool quiet) {
    for (const auto& [metric, result] : results) {
        fmt::print("{:<10} {:<12.6g} {}\n", metric->id, result.value, metric->definition);
        for (const auto& [name, value] : result.details) fmt::print("{:<10} {} = {:.6g}\n", "", name, value);
    }
    if (pair.nonFinitePixels > 0 && !quiet)
        fmt::print(stderr, "warning: {} pixels are NaN or infinite; they count in no metric\n", pair.nonFinitePixels);
}

}  // namespace

int runCompare(const CompareOptions& options) {
    if (isSequence(options)) return runCompareSequence(options);
    if (options.frames) throwUsage({"one image has no frames", "--frames", "images called like frame.%04d.exr", ""});
    std::vector<const Metric*> wanted;
    for (const std::string& id : options.metrics) {
        for (const SequenceMetric& metric : sequenceMetricCatalog())
            if (id == metric.id) throwUsage({"\"" + id + "\" needs frames", "--metrics", "images called like frame.%04d.exr", ""});
        wanted.push_back(&findMetric(id, "--metrics"));
    }
    if (wanted.empty())
        for (const Metric& metric : metricCatalog()) wanted.push_back(&metric);

    const ImagePair pair = loadPair(options, options.image, options.reference);
    if (!options.maps.empty()) std::filesystem::create_directories(options.maps);
    const MetricResults results = measureAll(options, wanted, pair, "");
    if (!options.json) {
        printTable(pair, results, options.quiet);
        return 0;
    }
    nlohmann::ordered_json report = {{"width", pair.image.width()},
                                     {"height", pair.image.height()},
                                     {"nonfinite_pixels", pair.nonFinitePixels}};
    report.update(jsonOf(results));
    fmt::print("{}\n", report.dump(2));
    return 0;
}

}  // namespace lumi
