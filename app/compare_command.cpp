#include <fmt/format.h>

#include <cmath>

#include "app/compare_parts.h"
#include "base/error.h"
#include "measure/temporal.h"
#include "params/json_text.h"

namespace lumi {
using nlohmann::ordered_json;

MetricResults measureAll(const std::vector<const Metric*>& metrics, const ImagePair& pair, ErrorMaps& maps,
                         const std::string& suffix) {
    MetricResults results;
    for (const Metric* metric : metrics) {
        const bool map = maps.wanted() && metric->mapColours;
        results.emplace_back(metric, metric->measure(pair, map));
        if (map) maps.add(metric->id, suffix, MapRange(*metric), results.back().second.map);
    }
    return results;
}

void addMeasurement(ordered_json& report, const std::string& id, const Measurement& measurement) {
    report["metrics"][id] = std::isfinite(measurement.value) ? ordered_json(measurement.value) : ordered_json();
    for (const auto& [name, value] : measurement.details)
        report["details"][id][name] = std::isfinite(value) ? ordered_json(value) : ordered_json();
    if (!measurement.reason.empty()) report["no_value"][id] = measurement.reason;
}

void addCounts(ordered_json& report, const ImagePair& pair) {
    report["nonfinite_pixels"] = pair.nonFinitePixels;
    report["nonfinite_image"] = pair.nonFiniteImage;
    report["nonfinite_reference"] = pair.nonFiniteReference;
    report["counted_pixels"] = pair.countedPixels;
}

std::string valueText(double value) { return std::isnan(value) ? "-" : fmt::format("{:.6g}", value); }

namespace {

void printTable(const ComparedPair& compared, const MetricResults& results, const ErrorMaps& maps) {
    const ImagePair& pair = compared.pair;
    for (const auto& [metric, result] : results) {
        fmt::print("{:<10} {:<12} {}\n", metric->id, valueText(result.value),
                   result.reason.empty() ? metric->definition : result.reason);
        for (const auto& [name, value] : result.details) fmt::print("{:<10} {} = {}\n", "", name, valueText(value));
    }
    fmt::print("\n{}x{}, {} pixels count; not finite: {} in the image, {} in the reference; exposure {:g} EV ({})\n",
               pair.image.width(), pair.image.height(), pair.countedPixels, pair.nonFiniteImage,
               pair.nonFiniteReference, compared.exposure.ev, compared.exposure.from);
    if (maps.wanted()) fmt::print("{}\n", maps.text());
}

void printJson(const ComparedPair& compared, const MetricResults& results, const ErrorMaps& maps) {
    ordered_json report = {{"width", compared.pair.image.width()}, {"height", compared.pair.image.height()}};
    addCounts(report, compared.pair);
    report["exposure"] = compared.exposure.ev;
    report["exposure_from"] = compared.exposure.from;
    for (const char* key : {"metrics", "details", "no_value"}) report[key] = ordered_json::object();
    for (const auto& [metric, result] : results) addMeasurement(report, metric->id, result);
    if (maps.wanted()) report["maps"] = maps.ranges();
    fmt::print("{}\n", jsonText(report, 2));
}

}  // namespace

int runCompare(const CompareOptions& options) {
    if (isSequence(options)) return runCompareSequence(options);
    if (options.frames) throwUsage({"one image has no frames", "--frames", "images called like frame.%04d.exr", ""});
    std::vector<const Metric*> wanted;
    for (const std::string& id : options.metrics) {
        for (const SequenceMetric& metric : sequenceMetricCatalog())
            if (id == metric.id)
                throwUsage({"\"" + id + "\" needs frames", "--metrics", "images called like frame.%04d.exr", ""});
        wanted.push_back(&findMetric(id, "--metrics"));
    }
    if (wanted.empty())
        for (const Metric& metric : metricCatalog()) wanted.push_back(&metric);

    const ComparedPair compared = loadPair(options, options.image, options.reference, false);
    ErrorMaps maps(options.maps);
    const MetricResults results = measureAll(wanted, compared.pair, maps, "");
    maps.finish();
    if (options.json) printJson(compared, results, maps);
    else printTable(compared, results, maps);
    if (options.quiet) return 0;
    if (!compared.exposure.warning.empty()) fmt::print(stderr, "warning: {}\n", compared.exposure.warning);
    if (compared.pair.nonFinitePixels > 0)
        fmt::print(stderr, "warning: {} pixels are NaN or infinite; they count in no metric\n",
                   compared.pair.nonFinitePixels);
    return 0;
}

}  // namespace lumi
