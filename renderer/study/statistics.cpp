#include "study/statistics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "reconstruct/catalog.h"

namespace lumi {
namespace {

using Of = StudyStatistic::Of;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

std::vector<float> finiteValues(const StudyStatistic& statistic, const Image& tap, const std::string& channels) {
    const size_t channel = statistic.channel.empty() ? 0 : channels.find(statistic.channel);
    if (channel >= static_cast<size_t>(tap.channels()))
        throwBadInput({fmt::format("buffer \"{}\" has no channel \"{}\"", statistic.tap, statistic.channel),
                       "\"statistics\"", "one of " + channels, ""});
    std::vector<float> values;
    for (int y = 0; y < tap.height(); ++y)
        for (int x = 0; x < tap.width(); ++x)
            if (const float value = tap.at(static_cast<int>(channel), x, y); std::isfinite(value))
                values.push_back(value);
    return values;
}

double share(const std::vector<float>& values, bool below, double limit) {
    const auto count =
        std::count_if(values.begin(), values.end(), [&](float value) { return (value < limit) == below; });
    return static_cast<double>(count) / static_cast<double>(values.size());
}

const Tap* findTap(const Module& module, const std::string& name) {
    for (const Tap& tap : module.taps())
        if (tap.name == name) return &tap;
    return nullptr;
}

double raysPerPixel(const TraceCounts& rays, const std::string& kind, const Image& image) {
    const uint64_t count = kind == "camera"   ? rays.cameraRays
                           : kind == "bounce" ? rays.bounceRays
                           : kind == "shadow" ? rays.shadowRays
                                              : rays.total();
    return static_cast<double>(count) / static_cast<double>(image.extent().area());
}

}  // namespace

TapSet statisticTaps(const Study& study, const StudyEntry& entry) {
    TapSet taps;
    const std::unique_ptr<Module> module = findModule(entry.module).make();
    for (const StudyStatistic& statistic : study.statistics)
        if (!statistic.tap.empty() && findTap(*module, statistic.tap)) taps.insert(statistic.tap);
    return taps;
}

double reduced(const StudyStatistic& statistic, const Image& tap, const std::string& channels) {
    std::vector<float> values = finiteValues(statistic, tap, channels);
    if (values.empty()) return kNaN;
    switch (statistic.of) {
        case Of::Mean: {
            double sum = 0;
            for (const float value : values) sum += value;
            return sum / static_cast<double>(values.size());
        }
        case Of::Least: return *std::min_element(values.begin(), values.end());
        case Of::Most: return *std::max_element(values.begin(), values.end());
        case Of::Percentile: {
            const auto place = static_cast<std::ptrdiff_t>(
                std::lround(statistic.value / 100 * static_cast<double>(values.size() - 1)));
            std::nth_element(values.begin(), values.begin() + place, values.end());
            return values[static_cast<size_t>(place)];
        }
        case Of::ShareBelow: return share(values, true, statistic.value);
        case Of::ShareAtLeast: return share(values, false, statistic.value);
    }
    return kNaN;
}

std::map<std::string, double> frameStatistics(
    const Study& study, const StudyEntry& entry, const std::string& instance, const FrameOutput& frame,
    const std::function<double(const std::string& metric, int spp)>& against) {
    std::map<std::string, double> values(entry.known.begin(), entry.known.end());
    const std::unique_ptr<Module> module = findModule(entry.module).make();
    for (const StudyStatistic& statistic : study.statistics) {
        if (values.contains(statistic.name)) continue;
        if (!statistic.tap.empty()) {
            const Tap* tap = findTap(*module, statistic.tap);
            const auto image = frame.taps.find(instance + "-" + statistic.tap);
            if (tap && image != frame.taps.end())
                values[statistic.name] = reduced(statistic, *image->second, tap->channels);
        } else if (!statistic.metric.empty()) {
            values[statistic.name] = against(statistic.metric, statistic.referenceSpp);
        } else if (!statistic.rays.empty()) {
            values[statistic.name] =
                raysPerPixel(frame.runRays.at(instance), statistic.rays, *frame.results.at(instance));
        } else if (statistic.memory) {
            values[statistic.name] = static_cast<double>(frame.moduleBytes.at(instance)) /
                                     static_cast<double>(frame.results.at(instance)->extent().area());
        } else if (values.contains(statistic.over) && values.contains(statistic.under)) {
            values[statistic.name] = values[statistic.over] / values[statistic.under];
        }
    }
    return values;
}

}  // namespace lumi
