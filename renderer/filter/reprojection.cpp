#include "filter/reprojection.h"

#include <cmath>

namespace lumi {

void ReprojectionSettings::describe(ParameterVisitor& v) {
    v.number("depth-tolerance", depthTolerance,
             {.label = "Depth tolerance",
              .min = 0,
              .max = 1,
              .help = "A history tap is on another surface when its 1/depth differs by more than this part, beside what the "
                      "slope explains (sec. 4.1)"});
    v.number("normal-tolerance", normalToleranceDeg,
             {.label = "Normal tolerance",
              .min = 0,
              .max = 180,
              .unit = "deg",
              .help = "Largest angle between the object-space normals of a pixel and of its history tap (sec. 4.1)"});
    v.toggle("wide-fallback", wideFallback,
             {.label = "3x3 fall-back",
              .help = "Where all four taps are refused, look among the 3x3 pixels around the point (sec. 4.1: thin geometry)"});
}

void SurfaceRecord::copyFrom(const Signals& signals) {
    inverseDepth = signals[Signal::InverseDepth];
    objectNormal = signals[Signal::ObjectNormal];
    objectId = signals.ids(Signal::ObjectId);
}

/// A pixel's point as the previous frame should have seen it.
struct Reprojection::Point {
    uint32_t object;
    float normal[3];
    float inverseDepth;  ///< expected then
    float allowed;       ///< how far a neighbour's may differ
};

Reprojection::Reprojection(const Signals& signals, const SurfaceRecord& previous, const ReprojectionSettings& settings)
    : signals_(signals),
      previous_(previous),
      settings_(settings),
      extent_(signals.extent()),
      normalCosine_(std::cos(radians(settings.normalToleranceDeg)) - 1e-5f) {}

// Written so that NaN in any of the inputs refuses the tap.
uint8_t Reprojection::refusal(const Point& point, int x, int y) const {
    if (x < 0 || y < 0 || x >= extent_.width || y >= extent_.height) return kTapOffScreen;
    uint8_t refused = kTapKept;
    if (previous_.objectId.at(0, x, y) != point.object) refused |= kTapOtherObject;
    const float difference = std::fabs(previous_.inverseDepth.at(0, x, y) - point.inverseDepth);
    if (!(difference <= point.allowed)) refused |= kTapDepth;
    float cosine = 0;
    for (int c = 0; c < 3; ++c) cosine += previous_.objectNormal.at(c, x, y) * point.normal[c];
    if (!(cosine >= normalCosine_)) refused |= kTapNormal;
    return refused;
}

ReprojectedTaps Reprojection::taps(int x, int y) const {
    ReprojectedTaps taps;
    const Image& motion = signals_[Signal::Motion];
    Point point;
    point.object = signals_.ids(Signal::ObjectId).at(0, x, y);
    const float px = static_cast<float>(x) + motion.at(0, x, y), py = static_cast<float>(y) + motion.at(1, x, y);
    const bool near = px > -2 && py > -2 && px < static_cast<float>(extent_.width) + 1 && py < static_cast<float>(extent_.height) + 1;
    if (point.object == 0 || !near) {
        taps.refusals.fill(kTapOffScreen);
        return taps;
    }
    for (int c = 0; c < 3; ++c) point.normal[c] = signals_[Signal::ObjectNormal].at(c, x, y);
    point.inverseDepth = 1 / (signals_[Signal::Depth].at(0, x, y) + motion.at(2, x, y));
    const Image& slope = signals_[Signal::DepthGradient];
    point.allowed = settings_.depthTolerance * point.inverseDepth +
                    2 * (std::fabs(slope.at(0, x, y)) + std::fabs(slope.at(1, x, y)));

    taps.x0 = static_cast<int>(std::floor(px));
    taps.y0 = static_cast<int>(std::floor(py));
    const float fx = px - static_cast<float>(taps.x0), fy = py - static_cast<float>(taps.y0);
    const float bilinear[4] = {(1 - fx) * (1 - fy), fx * (1 - fy), (1 - fx) * fy, fx * fy};
    float lost = 0;
    for (int k = 0; k < 4; ++k) {
        const int qx = taps.x0 + (k & 1), qy = taps.y0 + (k >> 1);
        const size_t at = static_cast<size_t>(k);
        taps.refusals[at] = bilinear[k] > 0 ? refusal(point, qx, qy) : uint8_t(kTapUnused);
        if (taps.refusals[at] != kTapKept) {
            lost += bilinear[k];
            continue;
        }
        taps.index[static_cast<size_t>(taps.count)] = qy * extent_.width + qx;
        taps.weight[static_cast<size_t>(taps.count++)] = bilinear[k];
    }
    if (taps.count > 0) {
        for (int k = 0; k < taps.count; ++k) taps.weight[static_cast<size_t>(k)] += lost / static_cast<float>(taps.count);
        return taps;
    }
    if (!settings_.wideFallback) return taps;
    const int cx = static_cast<int>(std::floor(px + 0.5f)), cy = static_cast<int>(std::floor(py + 0.5f));
    for (int j = -1; j <= 1; ++j)
        for (int i = -1; i <= 1; ++i)
            if (refusal(point, cx + i, cy + j) == kTapKept)
                taps.index[static_cast<size_t>(taps.count++)] = (cy + j) * extent_.width + cx + i;
    for (int k = 0; k < taps.count; ++k) taps.weight[static_cast<size_t>(k)] = 1 / static_cast<float>(taps.count);
    taps.wide = taps.count > 0;
    return taps;
}

float verdictValue(const ReprojectedTaps& taps, bool sky) {
    if (sky) return 0;
    if (taps.wide) return 3;
    uint8_t any = kTapKept, common = kTapUnused - 1;
    for (const uint8_t refused : taps.refusals) {
        if (refused == kTapUnused) continue;
        any |= refused;
        common &= refused;
    }
    if (taps.count > 0) return any == kTapKept ? 1.0f : 2.0f;
    return 4.0f + static_cast<float>(common);
}

}  // namespace lumi
