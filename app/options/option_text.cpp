#include "app/options/option_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <tuple>

#include "base/error.h"
#include "session/document.h"

namespace lumi {

namespace {

/// One option's text and what should stand there, for the parts of which it is made.
class OptionText {
public:
    OptionText(const std::string& text, const std::string& option, const char* expected)
        : text_(text), option_(option), expected_(expected) {}

    [[noreturn]] void refuse() const { throwUsage({"not understood", option_, expected_, '"' + text_ + '"'}); }
    [[noreturn]] void refuse(const char* what, const char* limit) const {
        throwUsage({what, option_, limit, '"' + text_ + '"'});
    }
    /// A whole number of at least `least`, as a part of the text.
    int64_t whole(const std::string& part, int64_t least) const {
        int64_t value = 0;
        const auto [end, code] = std::from_chars(part.data(), part.data() + part.size(), value);
        if (code != std::errc() || end != part.data() + part.size() || value < least) refuse();
        return value;
    }
    double number(const std::string& part, double limit) const {
        double value = 0;
        const auto [end, code] = std::from_chars(part.data(), part.data() + part.size(), value);
        if (code != std::errc() || end != part.data() + part.size() || !(std::abs(value) <= limit)) refuse();
        return value;
    }
    /// The two numbers around `mark`.
    std::pair<int64_t, int64_t> pair(const char* mark, int64_t least) const {
        const size_t at = text_.find(mark);
        if (at == std::string::npos) refuse();
        return {whole(text_.substr(0, at), least), whole(text_.substr(at + std::string(mark).size()), least)};
    }

private:
    const std::string &text_, &option_;
    const char* expected_;
};

}  // namespace

int64_t parseWhole(const std::string& text, const std::string& option, const char* expected, int64_t least) {
    return OptionText(text, option, expected).whole(text, least);
}

Extent2 parseSize(const std::string& text, const std::string& option) {
    const OptionText typed(text, option, "WIDTHxHEIGHT of at least 1x1, as 1280x720");
    const auto [width, height] = typed.pair("x", 1);
    if (width > 16384 || height > 16384) typed.refuse("too large", "at most 16384x16384");
    return {static_cast<int>(width), static_cast<int>(height)};
}

FrameRange parseFrames(const std::string& text) {
    const std::string option = "--frames";
    const OptionText typed(text, option, "a number N, or a range A..B with A < B");
    FrameRange range;
    if (text.find("..") == std::string::npos) range.end = typed.whole(text, 1);
    else std::tie(range.begin, range.end) = typed.pair("..", 0);
    if (range.begin >= range.end) typed.refuse();
    if (range.end > 10'000'000) typed.refuse("too many frames", "at most 10000000");
    return range;
}

std::pair<uint64_t, uint64_t> parseSamples(const std::string& text, const std::string& option) {
    const OptionText typed(text, option, "A..B with A < B, multiples of 16, as 0..1024");
    const auto [begin, end] = typed.pair("..", 0);
    if (begin >= end || begin % 16 != 0 || end % 16 != 0) typed.refuse();
    if (end > 65536) typed.refuse("too many samples", "at most 65536");
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
        const std::string part = text.substr(begin, end - begin);
        const size_t first = part.find_first_not_of(" \t"), last = part.find_last_not_of(" \t");
        parts.push_back(first == std::string::npos ? "" : part.substr(first, last - first + 1));
        begin = end + 1;
    }
    return parts;
}

FlipExposures parseFlipExposures(const std::string& text, const std::string& option) {
    const OptionText typed(text, option, "START,STOP in stops, or START,STOP,COUNT, as -3,3,5");
    const std::vector<std::string> parts = splitList(text);
    if (parts.size() != 2 && parts.size() != 3) typed.refuse();
    FlipExposures range = FlipExposures::over(typed.number(parts[0], 100), typed.number(parts[1], 100));
    if (range.stop < range.start) typed.refuse();
    if (parts.size() == 3) {
        const int64_t count = typed.whole(parts[2], 1);
        if (count > 64) typed.refuse("too many exposures", "at most 64");
        range.count = static_cast<int>(count);
    }
    return range;
}

std::array<int, 4> parseCrop(const std::string& text, const std::string& option) {
    const OptionText typed(text, option, "X,Y,W,H in pixels, as 0,0,256,256");
    const std::vector<std::string> parts = splitList(text);
    if (parts.size() != 4) typed.refuse();
    std::array<int, 4> crop{};
    for (size_t i = 0; i < crop.size(); ++i) {
        const int64_t value = typed.whole(parts[i], i < 2 ? 0 : 1);
        if (value > 1 << 20) typed.refuse();
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
