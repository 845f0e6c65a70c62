#include "app/options/option_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "base/error.h"
#include "session/document.h"

namespace lumi {

int64_t parseWhole(const std::string& text, const std::string& option, const char* expected, int64_t least) {
    int64_t value = 0;
    const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (code != std::errc() || end != text.data() + text.size() || value < least)
        throwUsage({"not understood", option, expected, '"' + text + '"'});
    return value;
}

Extent2 parseSize(const std::string& text, const std::string& option) {
    const size_t x = text.find('x');
    const char* expected = "WIDTHxHEIGHT, as 1280x720";
    if (x == std::string::npos) throwUsage({"not understood", option, expected, '"' + text + '"'});
    const int64_t width = parseWhole(text.substr(0, x), option, expected, 1);
    const int64_t height = parseWhole(text.substr(x + 1), option, expected, 1);
    if (width > 16384 || height > 16384) throwUsage({"too large", option, "at most 16384x16384", '"' + text + '"'});
    return {static_cast<int>(width), static_cast<int>(height)};
}

FrameRange parseFrames(const std::string& text) {
    const char* expected = "a number N, or a range A..B with A < B";
    const size_t dots = text.find("..");
    FrameRange range;
    if (dots == std::string::npos) {
        range.end = parseWhole(text, "--frames", expected, 1);
    } else {
        range.begin = parseWhole(text.substr(0, dots), "--frames", expected, 0);
        range.end = parseWhole(text.substr(dots + 2), "--frames", expected, 0);
        if (range.begin >= range.end) throwUsage({"not understood", "--frames", expected, '"' + text + '"'});
    }
    if (range.end > 10'000'000) throwUsage({"too many frames", "--frames", "at most 10000000", '"' + text + '"'});
    return range;
}

std::pair<uint64_t, uint64_t> parseSamples(const std::string& text, const std::string& option) {
    const char* expected = "A..B with A < B, multiples of 16, as 0..1024";
    const size_t dots = text.find("..");
    if (dots == std::string::npos) throwUsage({"not understood", option, expected, '"' + text + '"'});
    const int64_t begin = parseWhole(text.substr(0, dots), option, expected, 0);
    const int64_t end = parseWhole(text.substr(dots + 2), option, expected, 0);
    if (begin >= end || begin % 16 != 0 || end % 16 != 0) throwUsage({"not understood", option, expected, '"' + text + '"'});
    if (end > 65536) throwUsage({"too many samples", option, "at most 65536", '"' + text + '"'});
    return {static_cast<uint64_t>(begin), static_cast<uint64_t>(end)};
}

int64_t parseWarmUp(const std::string& text, const FrameRange& frames) {
    if (text.empty()) return 0;
    const int64_t warmUp = parseWhole(text, "--warm-up", "a number of frames", 0);
    if (warmUp > frames.begin)
        throwUsage({"there are not so many frames before the first", "--warm-up",
                    "at most " + std::to_string(frames.begin), std::to_string(warmUp)});
    return warmUp;
}

std::vector<std::string> splitList(const std::string& text) {
    std::vector<std::string> parts;
    for (size_t begin = 0; !text.empty() && begin <= text.size();) {
        const size_t end = std::min(text.find(',', begin), text.size());
        parts.push_back(text.substr(begin, end - begin));
        begin = end + 1;
    }
    return parts;
}

FlipExposures parseFlipExposures(const std::string& text, const std::string& option) {
    const char* expected = "START,STOP in stops, or START,STOP,COUNT, as -3,3,5";
    const std::vector<std::string> parts = splitList(text);
    const auto number = [&](const std::string& part) {
        double value = 0;
        const auto [end, code] = std::from_chars(part.data(), part.data() + part.size(), value);
        if (code != std::errc() || end != part.data() + part.size() || !(std::abs(value) <= 100))
            throwUsage({"not understood", option, expected, '"' + text + '"'});
        return value;
    };
    if (parts.size() != 2 && parts.size() != 3) throwUsage({"not understood", option, expected, '"' + text + '"'});
    FlipExposures range{number(parts[0]), number(parts[1]), 2};
    if (range.stop < range.start) throwUsage({"not understood", option, expected, '"' + text + '"'});
    range.count = parts.size() == 3 ? static_cast<int>(std::min<int64_t>(parseWhole(parts[2], option, expected, 1), 1000))
                                    : std::max(2, static_cast<int>(std::ceil(range.stop - range.start)));
    return range;
}

std::array<int, 4> parseCrop(const std::string& text, const std::string& option) {
    const char* expected = "X,Y,W,H in pixels, as 0,0,256,256";
    const std::vector<std::string> parts = splitList(text);
    if (parts.size() != 4) throwUsage({"not understood", option, expected, '"' + text + '"'});
    std::array<int, 4> crop{};
    for (size_t i = 0; i < crop.size(); ++i) {
        const int64_t value = parseWhole(parts[i], option, expected, i < 2 ? 0 : 1);
        if (value > 1 << 20) throwUsage({"too large", option, expected, '"' + text + '"'});
        crop[i] = static_cast<int>(value);
    }
    return crop;
}

void addValues(const SharedText& text, SceneOptions& scene) {
    auto& values = scene.values;
    if (scene.modules.size() > static_cast<size_t>(kViewCount))
        throwUsage({"too many", "--module", fmt::format("one for each of {} views", kViewCount),
                    std::to_string(scene.modules.size())});
    for (size_t i = 0; i < scene.modules.size(); ++i)
        values.push_back({fmt::format("view.{}.module", i), scene.modules[i], "--module"});
    if (!text.size.empty()) {
        const Extent2 size = parseSize(text.size, "--size");
        values.push_back({"render.width", std::to_string(size.width), "--size"});
        values.push_back({"render.height", std::to_string(size.height), "--size"});
    }
    const TypedValue named[] = {{"render.spp", text.spp, "--spp"},
                                {"render.fps", text.fps, "--fps"},
                                {"render.seed", text.seed, "--seed"},
                                {"camera.select", text.camera, "--camera"},
                                {"view.0.exposure", text.exposure, "--exposure"}};
    for (const TypedValue& value : named)
        if (!value.text.empty()) values.push_back(value);
    for (const std::string& entry : text.set) {
        const size_t equals = entry.find('=');
        if (equals == std::string::npos || equals == 0)
            throwUsage({"not understood", "--set", "ID=VALUE", '"' + entry + '"'});
        values.push_back({entry.substr(0, equals), entry.substr(equals + 1), "--set"});
    }
}

}  // namespace lumi
