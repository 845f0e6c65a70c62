#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "frame/display_range.h"
#include "image/image.h"
#include "params/parameter.h"

namespace lumi {

enum class ToneCurve { Clamp, Reinhard, Aces, AgX };

/// How a buffer is shown: `view.<n>.*` in parameter ids. Colours go exposure, curve, sRGB; everything else through a
/// colour map over [low, high].
struct DisplaySettings {
    float exposureEv = 0;
    ToneCurve curve = ToneCurve::Aces;
    /// "auto" (the buffer's own), "none", "viridis", "turbo", "magma", "signed", "cyclic", "ids", "gray"
    std::string colourMap = "auto";
    bool autoRange = true;  ///< the buffer's own, or the 1st to 99th percentile of finite values
    float low = 0, high = 1;
    int channel = -1;  ///< -1 all, 0.. one channel; in parameters "all", "1", ...

    void describe(ParameterVisitor&);
    bool operator==(const DisplaySettings&) const = default;
};

/// What convert() did, for the colour bar and the inspector.
struct DisplayInfo {
    bool falseColour = false;
    bool toneMapped = false;  ///< exposure and tone curve were applied; else the range was
    std::string colourMap;
    float low = 0, high = 1;
    /// pixels with NaN or infinity (NaN shows magenta, infinity cyan; +inf depth is the sky, black)
    int64_t nonFinite = 0;
};

/// RGBA8 of a buffer. `channels` is SignalInfo::channels ("RGB", "XYZ", "Y", ...); `defaultMap` is used for "auto". RGB
/// with map "none" is tone-mapped; XYZ shows 0.5 + 0.5 v; XY and motion show a colour wheel with maps "wheel" and
/// "motion". `own`: the range that an automatic one is, where the buffer has one. Vectorised, on all threads; off the
/// UI thread.
DisplayInfo convert(const Image& image, const char* channels, const char* defaultMap, const DisplaySettings& settings,
                    Image8& out, const std::optional<ValueRange>& own = {});
/// Ids get well-separated colours; 0 is black.
DisplayInfo convert(const IdImage& image, const DisplaySettings& settings, Image8& out);

/// Is it a map of two-dimensional values: hue for their direction, brightness for their length?
inline bool isWheel(std::string_view map) { return map == "wheel" || map == "motion"; }

/// The curve of one linear value (exposure applied before), before sRGB encoding; in [0,1]. Scalar definition.
Vec3 toneMap(const Vec3& linear, ToneCurve curve);
/// Colour (sRGB-encoded, [0,1]) of `t` in [0,1] on a map.
Vec3 colourMapValue(const std::string& map, float t);
const std::vector<const char*>& colourMapNames();

}  // namespace lumi
