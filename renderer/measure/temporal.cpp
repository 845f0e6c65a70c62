#include "measure/temporal.h"

#include <fmt/format.h>

#include <cmath>

#include "base/error.h"
#include "base/parallel.h"

namespace lumi {
namespace {

constexpr float kDepthTolerance = 0.05f;

Vec3 colourAt(const Image& image, int x, int y) { return {image.at(0, x, y), image.at(1, x, y), image.at(2, x, y)}; }

bool finite(const Image& image, int x, int y) {
    const Vec3 c = colourAt(image, x, y);
    return std::isfinite(c.x) && std::isfinite(c.y) && std::isfinite(c.z);
}

/// Luminance as shown; NaN where the pixel is not finite.
Image shownLuminance(const Image& linear, float exposureEv) {
    const Image shown = ldrImage(linear, exposureEv);
    Image out(linear.extent(), 1);
    parallelRanges(linear.height(), 16, [&](int64_t begin, int64_t end) {
        for (int y = static_cast<int>(begin); y < end; ++y)
            for (int x = 0; x < linear.width(); ++x)
                out.at(0, x, y) = finite(linear, x, y) ? luminance(colourAt(shown, x, y)) : std::nanf("");
    });
    return out;
}

/// Bilinear value of the previous frame where a pixel's point was, or nothing if that cannot be known.
class Follower {
public:
    Follower(const TemporalPair& pair, const Image& previous) : pair_(pair), previous_(previous) {}

    bool follow(int x, int y, float& value) const {
        const Image& motion = *pair_.motion;
        const float px = static_cast<float>(x) + motion.at(0, x, y), py = static_cast<float>(y) + motion.at(1, x, y);
        if (!(px >= 0 && py >= 0 && px <= static_cast<float>(previous_.width() - 1) &&
              py <= static_cast<float>(previous_.height() - 1)))
            return false;
        const int left = static_cast<int>(px), top = static_cast<int>(py);
        const float fx = px - static_cast<float>(left), fy = py - static_cast<float>(top);
        value = 0;
        for (int tap = 0; tap < 4; ++tap) {
            const int dx = tap & 1, dy = tap >> 1;
            const float weight = (dx ? fx : 1 - fx) * (dy ? fy : 1 - fy);
            if (weight == 0) continue;
            if (!sameSurface(x, y, left + dx, top + dy)) return false;
            value += weight * previous_.at(0, left + dx, top + dy);
        }
        return true;
    }

private:
    bool sameSurface(int x, int y, int px, int py) const {
        if (!pair_.depth || !pair_.previousDepth) return true;
        const float depth = pair_.depth->at(0, x, y), seen = pair_.previousDepth->at(0, px, py);
        if (std::isinf(depth) || std::isinf(seen))
            return std::isinf(depth) && std::isinf(seen);  // the sky stays the sky
        const float was = depth + (pair_.motion->channels() > 2 ? pair_.motion->at(2, x, y) : 0);
        return std::abs(seen - was) <= kDepthTolerance * std::abs(was);
    }

    const TemporalPair& pair_;
    const Image& previous_;
};

void checkExtents(const TemporalPair& pair) {
    const Extent2 extent = pair.image.extent();
    for (const Image* other : {&pair.previous, pair.motion, pair.depth, pair.previousDepth, pair.mask})
        if (other && !(other->extent() == extent))
            throwBadInput({"frames differ in size", "", fmt::format("{}x{}", extent.width, extent.height),
                           fmt::format("{}x{}", other->width(), other->height())});
}

Measurement difference(const TemporalPair& pair, bool follows, bool wantMap) {
    checkExtents(pair);
    const Image now = shownLuminance(pair.image, pair.exposureEv),
                before = shownLuminance(pair.previous, pair.exposureEv);
    const Follower follower(pair, before);
    Image map(now.extent(), 1);
    double sum = 0;
    int64_t count = 0, asked = 0, broken = 0;
    for (int y = 0; y < now.height(); ++y) {
        double row = 0;
        for (int x = 0; x < now.width(); ++x) {
            broken += std::isnan(now.at(0, x, y)) || std::isnan(before.at(0, x, y));
            if (pair.mask && !(pair.mask->at(0, x, y) > 0.5f)) continue;
            ++asked;
            float earlier = before.at(0, x, y);
            if (follows && pair.motion && !follower.follow(x, y, earlier)) continue;
            const float error = std::abs(now.at(0, x, y) - earlier);
            if (!std::isfinite(error)) continue;
            map.at(0, x, y) = error;
            row += error;
            ++count;
        }
        sum += row;
    }
    Measurement result;
    if (count > 0) result.value = sum / static_cast<double>(count);
    else
        result.reason = asked == 0                      ? "the mask leaves no pixel"
                        : broken >= now.extent().area() ? "no pixel is finite in both frames"
                        : follows                       ? "no point was seen in the frame before"
                                                        : "no pixel that counts is finite in both frames";
    result.details.emplace_back("nonfinite_pixels", static_cast<double>(broken));
    if (follows)
        result.details.emplace_back("covered",
                                    asked > 0 ? static_cast<double>(count) / static_cast<double>(asked) : 0.0);
    if (wantMap) result.map = std::move(map);
    return result;
}

}  // namespace

Measurement measureTemporal(const TemporalPair& pair, bool wantMap) { return difference(pair, false, wantMap); }
Measurement measureReprojectedTemporal(const TemporalPair& pair, bool wantMap) {
    return difference(pair, true, wantMap);
}

}  // namespace lumi
