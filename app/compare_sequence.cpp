// compare on frames: each by itself, and what only several frames tell.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "app/compare_parts.h"
#include "app/render_command.h"
#include "base/error.h"
#include "base/files.h"
#include "image/exr.h"
#include "image/hdr.h"
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

/// What the next frame needs of this one.
struct Frame {
    Image image, reference, depth, motion;
};

class SequenceComparison {
public:
    explicit SequenceComparison(const CompareOptions& options) : options_(options), wanted_(wantedMetrics(options.metrics)) {}

    int run() {
        findFrames();
        if (!options_.maps.empty()) fs::create_directories(options_.maps);
        for (const int64_t number : numbers_) compare(number);
        finishLag();
        print();
        return 0;
    }

private:
    std::string imageName(int64_t number) const { return numberedName(options_.image.string(), number); }
    std::string referenceName(int64_t number) const {
        return isPattern(options_.reference) ? numberedName(options_.reference.string(), number) : options_.reference.string();
    }
    std::string suffix(int64_t number) const { return fmt::format(".{:04}", number); }

    void findFrames() {
        if (options_.frames)
            for (int64_t n = options_.frames->first; n < options_.frames->second; ++n) numbers_.push_back(n);
        else
            numbers_ = framesThere(options_.image.string());
        if (numbers_.empty()) throwBadInput({"no such files", options_.image.string(), "frames 0, 1, 2, ...", ""});
        for (const int64_t number : numbers_)
            if (!fs::exists(referenceName(number)))
                throwBadInput({"no such file", referenceName(number), "a reference for each frame", ""});
    }

    void compare(int64_t number) {
        const ImagePair pair = loadPair(options_, imageName(number), referenceName(number));
        width_ = pair.image.width(), height_ = pair.image.height();
        nonFinite_ += pair.nonFinitePixels;
        ordered_json entry = {{"frame", number}, {"nonfinite_pixels", pair.nonFinitePixels}};
        ordered_json measured = jsonOf(measureAll(options_, wanted_.images, pair, suffix(number)));
        if (measured["metrics"].is_null()) measured["metrics"] = ordered_json::object();
        Frame now = frameOf(pair, number);
        const bool follows = previous_ && previousNumber_ + 1 == number;
        if (follows) addTemporal(pair, now, number, measured);
        if (wanted_.lag) addLag(pair, now, number);
        entry.update(measured);
        frames_.push_back(std::move(entry));
        previous_ = std::move(now);
        previousNumber_ = number;
    }

    Frame frameOf(const ImagePair& pair, int64_t number) const {
        Frame frame{pair.image, pair.reference, {}, {}};
        if (!wanted_.reprojected || lowerExtension(referenceName(number)) != ".exr") return frame;
        const ExrLayers layers = readExr(referenceName(number));
        frame.motion = croppedAs(options_, layers.image("motion", "XYZ"));
        frame.depth = croppedAs(options_, layers.image("depth", "Z"));
        if (frame.depth.empty()) frame.depth = croppedAs(options_, layers.image("", "Z"));
        return frame;
    }

    void addTemporal(const ImagePair& pair, const Frame& now, int64_t number, ordered_json& measured) {
        const auto measure = [&](const char* id, const Image& image, const Image& before, bool follow, bool wantMap) {
            TemporalPair temporal{image, before};
            temporal.exposureEv = options_.exposureEv;
            if (!pair.valid.empty()) temporal.mask = &pair.valid;
            if (follow) {
                temporal.motion = &now.motion;
                if (!now.depth.empty() && !previous_->depth.empty())
                    temporal.depth = &now.depth, temporal.previousDepth = &previous_->depth;
            }
            const Measurement result = follow ? measureReprojectedTemporal(temporal, wantMap) : measureTemporal(temporal, wantMap);
            if (wantMap) writeMap(options_.maps, id + suffix(number), "magma", result.map);
            return result;
        };
        const bool maps = !options_.maps.empty();
        const auto add = [&](const char* id, bool follow) {
            const Measurement own = measure(id, now.image, previous_->image, follow, maps);
            measured["metrics"][id] = own.value;
            for (const auto& [name, value] : own.details) measured["details"][id][name] = value;
            measured["details"][id]["reference"] = measure(id, now.reference, previous_->reference, follow, false).value;
        };
        if (wanted_.temporal) add("temporal", false);
        if (wanted_.reprojected && !now.motion.empty()) add("temporal_reprojected", true);
        else if (wanted_.reprojected) motionMissing_ = true;
    }

    /// The step is where the reference changes most, and much more than otherwise: known at the end. Until then each
    /// frame that changes more than any before it is taken for it.
    void addLag(const ImagePair& pair, const Frame& now, int64_t number) {
        if (previous_) {
            const double change = measureTemporal({now.reference, previous_->reference}, false).value;
            changes_.push_back(change);
            if (!lag_ || change > stepChange_) {
                lag_.emplace(previous_->reference, now.reference, pair.valid.empty() ? nullptr : &pair.valid);
                stepChange_ = change;
                stepFrame_ = number;
            }
        }
        if (lag_) lag_->add(now.image);
    }

    void finishLag() {
        if (!lag_) return;
        std::vector<double> sorted = changes_;
        std::sort(sorted.begin(), sorted.end());
        const double usual = sorted[(sorted.size() - 1) / 2];
        if (!lag_->changes() || !(stepChange_ > 0.01) || (sorted.size() > 1 && stepChange_ < 4 * usual)) lag_.reset();
        if (lag_ && !options_.maps.empty()) writeMap(options_.maps, "lag", "magma", lag_->map());
    }

    /// Means over the frames that have a value; lag is one number.
    ordered_json means() const {
        ordered_json result = ordered_json::object();
        std::map<std::string, std::pair<double, int>> sums;
        std::vector<std::string> order;
        for (const ordered_json& frame : frames_)
            for (const auto& [id, value] : frame["metrics"].items()) {
                if (!sums.count(id)) order.push_back(id);
                auto& [sum, count] = sums[id];
                const double number = value.is_number() ? value.get<double>() : std::nan("");
                if (std::isnan(number)) continue;
                sum += number;
                ++count;
            }
        for (const std::string& id : order) {
            const auto& [sum, count] = sums[id];
            result[id] = count > 0 ? ordered_json(sum / count) : ordered_json();
        }
        if (wanted_.lag) result["lag"] = lag_ && lag_->lag() >= 0 ? ordered_json(lag_->lag()) : ordered_json();
        return result;
    }

    void print() const {
        if (!options_.quiet) {
            if (nonFinite_ > 0)
                fmt::print(stderr, "warning: {} pixels are NaN or infinite; they count in no metric\n", nonFinite_);
            if (motionMissing_)
                fmt::print(stderr, "warning: temporal_reprojected wants references with the layer motion (reference --buffers motion)\n");
        }
        const ordered_json mean = means();
        if (options_.json) {
            ordered_json details = ordered_json::object();
            if (lag_) details["lag"] = {{"step_frame", stepFrame_}, {"curve", lag_->curve()}};
            const ordered_json report = {{"width", width_},    {"height", height_}, {"nonfinite_pixels", nonFinite_},
                                         {"metrics", mean},    {"details", details}, {"frames", frames_}};
            fmt::print("{}\n", report.dump(2));
            return;
        }
        const auto cell = [](const ordered_json& values, const std::string& id) {
            const auto found = values.find(id);
            const bool there = found != values.end() && found->is_number();
            return fmt::format("  {:>12}", there ? fmt::format("{:.6g}", found->get<double>()) : "-");
        };
        std::string head = "frame   ", last = "mean    ";
        for (const auto& [id, value] : mean.items()) {
            if (id == "lag") continue;
            head += fmt::format("  {:>12}", id.substr(0, 12));
            last += cell(mean, id);
        }
        fmt::print("{}\n", head);
        for (const ordered_json& frame : frames_) {
            std::string line = fmt::format("{:<8}", frame["frame"].get<int64_t>());
            for (const auto& [id, value] : mean.items())
                if (id != "lag") line += cell(frame["metrics"], id);
            fmt::print("{}\n", line);
        }
        fmt::print("{}\n", last);
        if (!lag_) return;
        if (lag_->lag() >= 0) fmt::print("lag: {} frames after the step at frame {}; response", lag_->lag(), stepFrame_);
        else fmt::print("lag: not reached after the step at frame {}; response", stepFrame_);
        for (const double value : lag_->curve()) fmt::print(" {:.3f}", value);
        fmt::print("\n");
    }

    const CompareOptions& options_;
    const WantedMetrics wanted_;
    std::vector<int64_t> numbers_;
    int width_ = 0, height_ = 0;
    int64_t nonFinite_ = 0, previousNumber_ = -1, stepFrame_ = -1;
    std::optional<Frame> previous_;
    std::vector<ordered_json> frames_;
    std::vector<double> changes_;
    std::optional<LagMeter> lag_;
    double stepChange_ = 0;
    bool motionMissing_ = false;
};

}  // namespace

bool isSequence(const CompareOptions& options) { return isPattern(options.image); }

int runCompareSequence(const CompareOptions& options) { return SequenceComparison(options).run(); }

}  // namespace lumi
