// How `compare` tells what it found out about a sequence.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/compare_parts.h"
#include "app/compare_sequence.h"
#include "params/json_text.h"

namespace lumi {
using nlohmann::ordered_json;
namespace {

double numberOf(const ordered_json& values, const std::string& id) {
    const auto found = values.find(id);
    return found != values.end() && found->is_number() ? found->get<double>() : std::nan("");
}

ordered_json jsonOf(const Lag& lag) {
    ordered_json curve = ordered_json::array();
    for (const double value : lag.curve) curve.push_back(std::isfinite(value) ? ordered_json(value) : ordered_json());
    return {{"step_frame", lag.stepFrame}, {"curve", curve}, {"nonfinite_pixels", lag.nonFinitePixels}};
}

void printJson(const SequenceReport& report) {
    ordered_json all = {{"width", report.width},
                        {"height", report.height},
                        {"nonfinite_pixels", report.nonFinite},
                        {"nonfinite_image", report.nonFiniteImage},
                        {"nonfinite_reference", report.nonFiniteReference},
                        {"exposure", report.exposureEv},
                        {"exposure_from", report.exposureFrom},
                        {"missing_frames", report.missing},
                        {"references_without_image", report.referencesAlone}};
    for (const char* key : {"metrics", "frames_counted", "details", "no_value"}) all[key] = ordered_json::object();
    for (const SequenceMean& mean : sequenceMeans(report)) {
        all["metrics"][mean.id] = mean.frames > 0 ? ordered_json(mean.mean) : ordered_json();
        all["frames_counted"][mean.id] = mean.frames;
        if (mean.frames == 0)
            all["no_value"][mean.id] = mean.present > 0 ? "no frame has a value" : "there is one frame only";
    }
    if (report.lagWanted) {
        all["metrics"]["lag"] = std::isfinite(report.lag.value) ? ordered_json(report.lag.value) : ordered_json();
        if (report.lag.stepFrame >= 0) all["details"]["lag"] = jsonOf(report.lag);
        if (!report.lag.reason.empty()) all["no_value"]["lag"] = report.lag.reason;
    }
    if (!report.maps.is_null()) all["maps"] = report.maps;
    all["frames"] = report.frames;
    fmt::print("{}\n", jsonText(all, 2));
}

/// Frames that a metric's mean leaves out, with the first one's reason.
void printLeftOut(const SequenceReport& report, const SequenceMean& mean) {
    if (mean.present == 0) fmt::print("{}: no value: there is one frame only\n", mean.id);
    if (mean.frames == mean.present) return;
    std::string first;
    for (const ordered_json& frame : report.frames) {
        const auto why = frame.find("no_value");
        if (why == frame.end() || !why->contains(mean.id)) continue;
        first = fmt::format(" (frame {}: {})", frame["frame"].get<int64_t>(), (*why)[mean.id].get<std::string>());
        break;
    }
    fmt::print("{}: mean of {} of {} frames; the others have no value{}\n", mean.id, mean.frames, mean.present, first);
}

void printLag(const Lag& lag) {
    if (lag.stepFrame < 0) fmt::print("lag: no value: {}\n", lag.reason);
    else if (std::isnan(lag.value))
        fmt::print("lag: {} after the step at frame {}; response", lag.reason, lag.stepFrame);
    else fmt::print("lag: {} frames after the step at frame {}; response", lag.value, lag.stepFrame);
    for (const double value : lag.curve) fmt::print(" {}", std::isnan(value) ? "-" : fmt::format("{:.3f}", value));
    if (!lag.curve.empty()) fmt::print("\n");
    if (lag.nonFinitePixels > 0)
        fmt::print("lag: {} pixels of these frames are not finite; they count for nothing\n", lag.nonFinitePixels);
}

void printTable(const SequenceReport& report) {
    const std::vector<SequenceMean> means = sequenceMeans(report);
    const auto cell = [](const std::string& text) { return fmt::format("  {:>12}", text.substr(0, 12)); };
    std::string head = "frame   ", last = "mean    ";
    for (const SequenceMean& mean : means) {
        head += cell(mean.id);
        last += cell(valueText(mean.mean));
    }
    fmt::print("{}{}{}\n", head, cell("bad image"), cell("bad ref"));
    for (const ordered_json& frame : report.frames) {
        std::string line = fmt::format("{:<8}", frame["frame"].get<int64_t>());
        for (const SequenceMean& mean : means) line += cell(valueText(numberOf(frame["metrics"], mean.id)));
        fmt::print("{}{}{}\n", line, cell(frame["nonfinite_image"].dump()), cell(frame["nonfinite_reference"].dump()));
    }
    fmt::print("{}{}{}\n\n", last, cell(std::to_string(report.nonFiniteImage)),
               cell(std::to_string(report.nonFiniteReference)));
    fmt::print("{}x{}, {} frames; not finite: {} pixels in the images, {} in the references; exposure {:g} EV ({})\n",
               report.width, report.height, report.frames.size(), report.nonFiniteImage, report.nonFiniteReference,
               report.exposureEv, report.exposureFrom);
    if (!report.mapsText.empty()) fmt::print("{}\n", report.mapsText);
    for (const SequenceMean& mean : means) printLeftOut(report, mean);
    if (report.lagWanted) printLag(report.lag);
}

std::string listed(const std::vector<int64_t>& numbers) {
    std::string text;
    for (size_t i = 0; i < std::min<size_t>(numbers.size(), 8); ++i)
        text += (i > 0 ? ", " : "") + std::to_string(numbers[i]);
    return numbers.size() > 8 ? fmt::format("{} and {} more", text, numbers.size() - 8) : text;
}

}  // namespace

std::vector<SequenceMean> sequenceMeans(const SequenceReport& report) {
    std::vector<SequenceMean> means;
    for (const std::string& id : report.ids) {
        SequenceMean mean{id, 0, 0, 0};
        for (const ordered_json& frame : report.frames) {
            const ordered_json& values = frame["metrics"];
            mean.present += values.contains(id);
            const double value = numberOf(values, id);
            if (std::isnan(value)) continue;
            mean.mean += value;
            ++mean.frames;
        }
        mean.mean = mean.frames > 0 ? mean.mean / static_cast<double>(mean.frames) : std::nan("");
        means.push_back(mean);
    }
    return means;
}

void printSequence(const SequenceReport& report, const CompareOptions& options) {
    if (options.json) printJson(report);
    else printTable(report);
    if (options.quiet) return;
    for (const std::string& warning : report.warnings) fmt::print(stderr, "warning: {}\n", warning);
    if (report.nonFinite > 0)
        fmt::print(stderr, "warning: {} pixels are NaN or infinite; they count in no metric\n", report.nonFinite);
    if (!report.missing.empty()) fmt::print(stderr, "warning: there is no image of frame {}\n", listed(report.missing));
    if (!report.referencesAlone.empty())
        fmt::print(stderr, "warning: references without an image are left out: frame {}\n",
                   listed(report.referencesAlone));
}

}  // namespace lumi
