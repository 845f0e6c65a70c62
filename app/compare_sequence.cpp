// compare on frames: each by itself, and what only several frames tell.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/compare_parts.h"
#include "app/compare_sequence.h"
#include "app/render_command.h"
#include "base/error.h"
#include "base/files.h"
#include "measure/temporal.h"

namespace lumi {
namespace fs = std::filesystem;
using nlohmann::ordered_json;
namespace {

bool isPattern(const fs::path& path) {
    std::error_code failure;
    return path.string().find('%') != std::string::npos && !fs::exists(path, failure);
}

/// Numbers of the files that the pattern names, ascending.
std::vector<int64_t> framesThere(const std::string& pattern) {
    std::vector<int64_t> numbers;
    const size_t percent = fs::path(pattern).filename().string().find('%');
    const fs::path folder = fs::path(pattern).has_parent_path() ? fs::path(pattern).parent_path() : ".";
    std::error_code failure;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder, failure)) {
        const std::string name = entry.path().filename().string();
        if (percent == std::string::npos || name.size() <= percent) continue;
        size_t end = percent;
        while (end < name.size() && end < percent + 9 && std::isdigit(static_cast<unsigned char>(name[end]))) ++end;
        if (end == percent) continue;
        const int64_t number = std::stoll(name.substr(percent, end - percent));
        if (fs::path(numberedName(pattern, number)).filename() == name) numbers.push_back(number);
    }
    std::sort(numbers.begin(), numbers.end());
    return numbers;
}

struct WantedMetrics {
    std::vector<const Metric*> images;
    bool temporal = false, reprojected = false, lag = false;
};

WantedMetrics wantedMetrics(const std::vector<std::string>& ids) {
    WantedMetrics wanted;
    if (ids.empty()) {
        for (const Metric& metric : metricCatalog()) wanted.images.push_back(&metric);
        wanted.temporal = wanted.reprojected = wanted.lag = true;
    }
    for (const std::string& id : ids) {
        if (id == "temporal") wanted.temporal = true;
        else if (id == "temporal_reprojected") wanted.reprojected = true;
        else if (id == "lag") wanted.lag = true;
        else wanted.images.push_back(&findMetric(id, "--metrics"));
    }
    return wanted;
}

/// What the next frame needs of this one: images as they came, with their broken pixels.
struct Frame {
    Image image, reference, depth, motion;
};

class SequenceComparison {
public:
    explicit SequenceComparison(const CompareOptions& options)
        : options_(options), wanted_(wantedMetrics(options.metrics)), maps_(options.maps) {}

    int run() {
        findFrames();
        for (const Metric* metric : wanted_.images) report_.ids.emplace_back(metric->id);
        if (wanted_.temporal) report_.ids.emplace_back("temporal");
        if (wanted_.reprojected) report_.ids.emplace_back("temporal_reprojected");
        report_.lagWanted = wanted_.lag;
        for (const int64_t number : numbers_) compare(number);
        finishLag();
        maps_.finish();
        if (maps_.wanted()) report_.maps = maps_.ranges(), report_.mapsText = maps_.text();
        if (motionMissing_)
            report_.warnings.emplace_back(
                "temporal_reprojected wants references with the layer motion (reference --buffers motion)");
        printSequence(report_, options_);
        return 0;
    }

private:
    std::string imageName(int64_t number) const { return numberedName(options_.image.string(), number); }
    std::string referenceName(int64_t number) const {
        return isPattern(options_.reference) ? numberedName(options_.reference.string(), number)
                                             : options_.reference.string();
    }
    std::string suffix(int64_t number) const { return fmt::format(".{:04}", number); }

    void findFrames() {
        if (options_.frames)
            for (int64_t n = options_.frames->first; n < options_.frames->second; ++n) numbers_.push_back(n);
        else numbers_ = framesThere(options_.image.string());
        if (numbers_.empty()) throwBadInput({"no such files", options_.image.string(), "frames 0, 1, 2, ...", ""});
        for (const int64_t number : numbers_)
            for (const std::string& name : {imageName(number), referenceName(number)})
                if (!fs::exists(name))
                    throwBadInput({"no such file", name, "an image and a reference for each frame", ""});
        for (size_t i = 1; i < numbers_.size(); ++i)
            for (int64_t n = numbers_[i - 1] + 1; n < numbers_[i]; ++n) report_.missing.push_back(n);
        if (options_.frames || !isPattern(options_.reference)) return;
        for (const int64_t number : framesThere(options_.reference.string()))
            if (!std::binary_search(numbers_.begin(), numbers_.end(), number))
                report_.referencesAlone.push_back(number);
    }

    void compare(int64_t number) {
        const bool sequential = wanted_.temporal || wanted_.reprojected || wanted_.lag;
        ComparedPair compared = loadPair(options_, imageName(number), referenceName(number), sequential);
        const ImagePair& pair = compared.pair;
        note(compared, number);
        ordered_json entry = {{"frame", number}};
        addCounts(entry, pair);
        for (const char* key : {"metrics", "details"}) entry[key] = ordered_json::object();
        for (const auto& [metric, result] : measureAll(wanted_.images, pair, maps_, suffix(number)))
            addMeasurement(entry, metric->id, result);
        Frame now{std::move(compared.image), std::move(compared.reference), std::move(compared.depth),
                  std::move(compared.motion)};
        if (previousNumber_ >= 0) addConsecutive(pair, now, number, entry);
        if (wanted_.lag) lag_.add(number, now.image, now.reference, pair.mask.empty() ? nullptr : &pair.mask);
        report_.frames.push_back(std::move(entry));
        previous_ = std::move(now);
        previousNumber_ = number;
    }

    /// Sums up what is told of all frames together. Throws Error(BadInput) for a frame of another size.
    void note(const ComparedPair& compared, int64_t number) {
        const ImagePair& pair = compared.pair;
        if (previousNumber_ < 0) {
            report_.width = pair.image.width(), report_.height = pair.image.height();
            report_.exposureEv = compared.exposure.ev, report_.exposureFrom = compared.exposure.from;
        }
        if (pair.image.width() != report_.width || pair.image.height() != report_.height)
            throwBadInput({"frames differ in size", imageName(number),
                           fmt::format("{}x{}", report_.width, report_.height),
                           fmt::format("{}x{}", pair.image.width(), pair.image.height())});
        if (!compared.exposure.warning.empty() && report_.warnings.empty())
            report_.warnings.push_back(compared.exposure.warning);
        if (compared.exposure.ev != report_.exposureEv)
            throwBadInput({"frames were made at different exposures", imageName(number),
                           fmt::format("{} EV as before, or --exposure", report_.exposureEv),
                           fmt::format("{} EV", compared.exposure.ev)});
        report_.nonFinite += pair.nonFinitePixels;
        report_.nonFiniteImage += pair.nonFiniteImage, report_.nonFiniteReference += pair.nonFiniteReference;
    }

    Measurement consecutive(const ImagePair& pair, const Frame& now, const Image& image, const Image& before,
                            bool follow, bool wantMap) const {
        TemporalPair temporal{image, before};
        temporal.exposureEv = pair.exposureEv;
        if (!pair.mask.empty()) temporal.mask = &pair.mask;
        if (!follow) return measureTemporal(temporal, wantMap);
        temporal.motion = &now.motion;
        if (!now.depth.empty() && !previous_.depth.empty())
            temporal.depth = &now.depth, temporal.previousDepth = &previous_.depth;
        return measureReprojectedTemporal(temporal, wantMap);
    }

    void addConsecutive(const ImagePair& pair, const Frame& now, int64_t number, ordered_json& entry) {
        const auto add = [&](const std::string& id, bool follow) {
            Measurement none;
            if (previousNumber_ + 1 != number) none.reason = fmt::format("frame {} is missing", number - 1);
            else if (follow && now.motion.empty()) none.reason = "the reference holds no layer motion";
            if (!none.reason.empty()) return addMeasurement(entry, id, none);
            const Measurement own = consecutive(pair, now, now.image, previous_.image, follow, maps_.wanted());
            if (maps_.wanted()) maps_.add(id, suffix(number), {}, own.map);
            addMeasurement(entry, id, own);
            const double reference = consecutive(pair, now, now.reference, previous_.reference, follow, false).value;
            entry["details"][id]["reference"] = std::isfinite(reference) ? ordered_json(reference) : ordered_json();
        };
        if (wanted_.temporal) add("temporal", false);
        if (wanted_.reprojected) add("temporal_reprojected", true);
        motionMissing_ = motionMissing_ || (wanted_.reprojected && now.motion.empty());
    }

    void finishLag() {
        if (!wanted_.lag) return;
        report_.lag = lag_.result();
        const Image map = lag_.map();
        if (!map.empty() && maps_.wanted()) maps_.add("lag", "", {}, map);
    }

    const CompareOptions& options_;
    const WantedMetrics wanted_;
    std::vector<int64_t> numbers_;
    ErrorMaps maps_;
    SequenceReport report_;
    LagSequence lag_;
    Frame previous_;
    int64_t previousNumber_ = -1;
    bool motionMissing_ = false;
};

}  // namespace

bool isSequence(const CompareOptions& options) { return isPattern(options.image); }

int runCompareSequence(const CompareOptions& options) { return SequenceComparison(options).run(); }

}  // namespace lumi
