#include "frame/display.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstring>
#include <numeric>

#include "base/parallel.h"
#include "frame/colour_maps.h"
#include "frame/display_kernels.h"
#include "frame/display_range.h"

namespace lumi {
namespace {

constexpr int kRowsPerTask = 16;

/// How a buffer is turned into colours.
enum class Style {
    Tone,       ///< three planes, or one as grey, through exposure and curve
    Range,      ///< three planes, each over the range
    Wheel,      ///< two planes
    Plane,      ///< one plane through a map
    Luminance,  ///< three planes through a map
    Length      ///< two or three planes through a map
};

struct Plan {
    Style style = Style::Tone;
    std::string map;
    std::array<int, 3> planes{0, 0, 0};
    bool skyIsBlack = false;
};

Plan planFor(std::string_view channels, const std::string& defaultMap, const DisplaySettings& settings, int count) {
    Plan plan;
    plan.map = settings.colourMap == "auto" ? defaultMap : settings.colourMap;
    if (plan.map.empty() || plan.map == "auto") plan.map = "none";
    const bool none = plan.map == "none", wheel = isWheel(plan.map);
    const bool colour = channels.starts_with("RGB");
    const int single = count == 1 ? 0 : std::min(settings.channel, count - 1);
    if (single >= 0) {
        plan.planes = {single, single, single};
        const bool component = count > 1 && !colour;
        // One component of a vector has a sign; a hue without a second component says nothing.
        if (component && (none || wheel)) plan.map = "signed";
        else if (wheel) plan.map = "cyclic";
        plan.style = plan.map == "none" ? Style::Tone : Style::Plane;
        plan.skyIsBlack = channels == "Z";
        return plan;
    }
    plan.planes = {0, 1, count > 2 ? 2 : 1};
    if (colour) plan.style = none ? Style::Tone : Style::Luminance;
    else if (wheel) plan.style = Style::Wheel;
    else plan.style = none ? Style::Range : Style::Length;
    if (colour && wheel) plan.map = "cyclic";
    return plan;
}

constexpr float kLeastMotion = 0.01f;  ///< pixels

/// The number that a map or range is about, one pixel at a time, for percentiles.
struct ScalarAt {
    const Plan& plan;
    const float* a;
    const float* b;
    const float* c;
    bool twoOnly;
    float operator()(int64_t i) const {
        switch (plan.style) {
            case Style::Luminance: return luminance(Vec3(a[i], b[i], c[i]));
            case Style::Wheel: return std::sqrt(a[i] * a[i] + b[i] * b[i]);
            case Style::Length: return std::sqrt(a[i] * a[i] + b[i] * b[i] + (twoOnly ? 0 : c[i] * c[i]));
            case Style::Range: {
                // The component furthest from 0.
                const float x = a[i], y = b[i], z = twoOnly ? 0 : c[i];
                const float xy = std::abs(x) >= std::abs(y) ? x : y;
                return std::abs(xy) >= std::abs(z) ? xy : z;
            }
            default: return a[i];
        }
    }
};

ValueRange rangeFor(const Plan& plan, const ScalarAt& value, int64_t count, const DisplaySettings& settings,
                    const std::optional<ValueRange>& own) {
    if (plan.style == Style::Tone) return {0, 1};
    if (plan.map == "ids") return {0, 1};
    if (!settings.autoRange) return {settings.low, settings.high};
    if (own) return *own;
    const ValueRange found = percentileRange(count, value);
    if (plan.style == Style::Wheel) {
        // Where all but nothing moves, what is left is the rounding of projections.
        const float least = plan.map == "motion" ? kLeastMotion : 0;
        return {0, found.high > least ? found.high : 1};
    }
    if (plan.map == "signed") {
        const float reach = std::max(std::abs(found.low), std::abs(found.high));
        return reach > 0 ? ValueRange{-reach, reach} : ValueRange{-1, 1};
    }
    // Unit vectors keep their customary 0.5 + 0.5 v.
    if (plan.style == Style::Range && std::max(std::abs(found.low), std::abs(found.high)) <= 1.001f) return {-1, 1};
    return opened(found);
}

/// Rows of one image; scratch for derived numbers is the caller's.
class RowConverter {
public:
    RowConverter(const Image& image, const Plan& plan, const ValueRange& range, const DisplaySettings& settings)
        : image_(image), plan_(plan), range_(range), kernels_(displayKernels()) {
        scale_ = std::exp2(settings.exposureEv);
        curve_ = static_cast<int>(settings.curve);
        const float span = range.high - range.low;
        perUnit_ = span != 0 ? 1 / span : 0;
        if (plan.style == Style::Plane || plan.style == Style::Luminance || plan.style == Style::Length)
            table_ = &colourTable(plan.map);
    }

    int operator()(int y, std::vector<float>& scratch, uint32_t* out) const {
        const int width = image_.width();
        const float* a = image_.plane(plan_.planes[0]).row(y);
        const float* b = image_.plane(plan_.planes[1]).row(y);
        const float* c = image_.plane(plan_.planes[2]).row(y);
        const bool twoOnly = image_.channels() == 2;
        if (plan_.style == Style::Tone) return kernels_.tone(a, b, c, width, scale_, curve_, out);
        if (plan_.style == Style::Wheel) return kernels_.wheel(a, b, width, perUnit_, out);
        scratch.resize(static_cast<size_t>(width));
        if (plan_.style == Style::Range) {
            // Two components: the third is the range's middle.
            std::fill(scratch.begin(), scratch.end(), 0.5f * (range_.low + range_.high));
            return kernels_.range(a, b, twoOnly ? scratch.data() : c, width, range_.low, perUnit_, out);
        }
        const float* values = a;
        if (plan_.style == Style::Luminance) {
            kernels_.luminance(a, b, c, width, scratch.data());
            values = scratch.data();
        } else if (plan_.style == Style::Length) {
            const std::vector<float> zero(twoOnly ? static_cast<size_t>(width) : 0);
            kernels_.length(a, b, twoOnly ? zero.data() : c, width, scratch.data());
            values = scratch.data();
        }
        if (plan_.map == "ids") return ids(values, width, out);
        return kernels_.map(values, width, range_.low, perUnit_, table_->data(), kColourTableSize,
                            plan_.map == "cyclic", plan_.skyIsBlack, out);
    }

private:
    static int ids(const float* values, int width, uint32_t* out) {
        int bad = 0;
        for (int x = 0; x < width; ++x) {
            const bool finite = std::isfinite(values[x]);
            bad += finite ? 0 : 1;
            const float id = std::clamp(finite ? values[x] : 0.0f, 0.0f, 4.0e9f);
            out[x] = finite ? idColour(static_cast<uint32_t>(id)) : std::isnan(values[x]) ? 0xffff00ffu : 0xffffff00u;
        }
        return bad;
    }

    const Image& image_;
    const Plan& plan_;
    ValueRange range_;
    const DisplayKernels& kernels_;
    float scale_ = 1, perUnit_ = 1;
    int curve_ = 0;
    const std::vector<uint32_t>* table_ = nullptr;
};

/// Calls row(y, scratch, pixels) for each row on all threads and stores the pixels; the sum of what it returns.
template <class Row>
int64_t convertRows(Extent2 extent, Image8& out, const Row& row) {
    out.extent = extent;
    out.rgba.resize(static_cast<size_t>(extent.area()) * 4);
    std::vector<int64_t> bad(static_cast<size_t>(extent.height));
    parallelRanges(extent.height, kRowsPerTask, [&](int64_t begin, int64_t end) {
        std::vector<float> scratch;
        std::vector<uint32_t> pixels(static_cast<size_t>(extent.width));
        for (int64_t y = begin; y < end; ++y) {
            bad[static_cast<size_t>(y)] = row(static_cast<int>(y), scratch, pixels.data());
            std::memcpy(out.rgba.data() + y * extent.width * 4, pixels.data(), pixels.size() * 4);
        }
    });
    return std::accumulate(bad.begin(), bad.end(), int64_t(0));
}

}  // namespace

DisplayInfo convert(const Image& image, const char* channels, const char* defaultMap, const DisplaySettings& settings,
                    Image8& out, const std::optional<ValueRange>& own) {
    DisplayInfo info;
    if (image.empty()) {
        out = {};
        return info;
    }
    const Plan plan = planFor(channels, defaultMap ? defaultMap : "none", settings, image.channels());
    const ScalarAt value{plan, image.plane(plan.planes[0]).data, image.plane(plan.planes[1]).data,
                         image.plane(plan.planes[2]).data, image.channels() == 2};
    const ValueRange range = rangeFor(plan, value, image.extent().area(), settings, own);
    info.falseColour = plan.style != Style::Tone && plan.style != Style::Range;
    info.toneMapped = plan.style == Style::Tone;
    info.colourMap = plan.map;
    info.low = range.low, info.high = range.high;
    info.nonFinite = convertRows(image.extent(), out, RowConverter(image, plan, range, settings));
    return info;
}

DisplayInfo convert(const IdImage& image, const DisplaySettings& settings, Image8& out) {
    DisplayInfo info;
    if (image.empty()) {
        out = {};
        return info;
    }
    const int plane = std::clamp(settings.channel, 0, image.channels() - 1);
    convertRows(image.extent(), out, [&](int y, std::vector<float>&, uint32_t* pixels) {
        const uint32_t* ids = image.plane(plane).row(y);
        std::transform(ids, ids + image.width(), pixels, idColour);
        return 0;
    });
    info.falseColour = true;
    info.colourMap = "ids";
    return info;
}

}  // namespace lumi
