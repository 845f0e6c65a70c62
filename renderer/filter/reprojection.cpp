#include "filter/reprojection.h"

#include <algorithm>
#include <cmath>

#include "filter/reprojection_kernels.h"
#include "filter/whole_pixel.h"

namespace lumi {

void ReprojectionSettings::describe(ParameterVisitor& v) {
    v.number(
        "depth-tolerance", depthTolerance,
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
    v.toggle(
        "wide-fallback", wideFallback,
        {.label = "3x3 fall-back",
         .help =
             "Where all four taps are refused, look among the 3x3 pixels around the point (sec. 4.1: thin geometry)"});
}

void SurfaceRecord::reset(Extent2 extent) {
    if (objectId.extent() == extent) return;
    inverseDepth.reset(extent, 1);
    objectNormal.reset(extent, 3);
    objectId.reset(extent, 1);
}

void SurfaceRecord::copyRows(const Signals& signals, int begin, int end) {
    const int64_t first = static_cast<int64_t>(begin) * signals.extent().width,
                  last = static_cast<int64_t>(end) * signals.extent().width;
    const auto copy = [&](const auto& from, auto to) {
        std::copy(from.data + first, from.data + last, to.data + first);
    };
    copy(signals[Signal::InverseDepth].plane(0), inverseDepth.plane(0));
    for (int c = 0; c < 3; ++c) copy(signals[Signal::ObjectNormal].plane(c), objectNormal.plane(c));
    copy(signals.ids(Signal::ObjectId).plane(0), objectId.plane(0));
}

ReprojectedRow::ReprojectedRow(int pixels) {
    for (int k = 0; k < 4; ++k) {
        index[k].resize(static_cast<size_t>(pixels));
        refusals[k].resize(static_cast<size_t>(pixels));
        weight[k].resize(static_cast<size_t>(pixels));
    }
}

bool ReprojectedRow::inARow(int count) const {
    bool all = true;
    for (const auto& indices : index) all = all && reprojectionKernels().inARow(indices.data(), count);
    return all;
}

bool ReprojectedRow::follows(int k) const {
    const auto at = static_cast<size_t>(k);
    bool all = true;
    for (const auto& indices : index) all = all && indices[at] == indices[at - 1] + 1;
    return all;
}

bool ReprojectedRow::lost(int k) const {
    const auto at = static_cast<size_t>(k);
    return refusals[0][at] != 0 && refusals[1][at] != 0 && refusals[2][at] != 0 && refusals[3][at] != 0;
}

ReprojectedTaps ReprojectedRow::pixel(int k) const {
    ReprojectedTaps taps;
    const auto at = static_cast<size_t>(k);
    for (size_t t = 0; t < 4; ++t) {
        taps.refusals[t] = static_cast<uint8_t>(refusals[t][at]);
        if (refusals[t][at] != kTapKept) continue;
        taps.index[static_cast<size_t>(taps.count)] = index[t][at];
        taps.weight[static_cast<size_t>(taps.count++)] = weight[t][at];
    }
    return taps;
}

Reprojection::Reprojection(const Signals& signals, const SurfaceRecord& previous, const ReprojectionSettings& settings)
    : signals_(signals),
      previous_(previous),
      settings_(settings),
      normalCosine_(std::cos(radians(settings.normalToleranceDeg)) - 1e-5f) {}

int Reprojection::tapRange(int y, int begin, int end, int32_t* const index[4], float* const weight[4],
                           int32_t* const refusals[4]) const {
    ReprojectionRow row;
    row.width = signals_.extent().width;
    row.height = signals_.extent().height;
    row.y = y;
    row.begin = begin;
    row.end = end;
    for (int c = 0; c < 3; ++c) {
        row.motion[c] = signals_[Signal::Motion].plane(c).data;
        row.objectNormal[c] = signals_[Signal::ObjectNormal].plane(c).data;
        row.previousNormal[c] = previous_.objectNormal.plane(c).data;
    }
    for (int c = 0; c < 2; ++c) row.slope[c] = signals_[Signal::DepthGradient].plane(c).data;
    row.depth = signals_[Signal::Depth].data();
    row.object = signals_.ids(Signal::ObjectId).data();
    row.previousInverseDepth = previous_.inverseDepth.data();
    row.previousObject = previous_.objectId.data();
    row.depthTolerance = settings_.depthTolerance;
    row.normalCosine = normalCosine_;
    for (int k = 0; k < 4; ++k) {
        row.index[k] = index[k];
        row.weight[k] = weight[k];
        row.refusals[k] = refusals[k];
    }
    return reprojectionKernels().tapRow(row);
}

int Reprojection::row(int y, int begin, int end, ReprojectedRow& row) const {
    int32_t *index[4], *refusals[4];
    float* weight[4];
    for (int k = 0; k < 4; ++k) {
        index[k] = row.index[k].data();
        weight[k] = row.weight[k].data();
        refusals[k] = row.refusals[k].data();
    }
    return tapRange(y, begin, end, index, weight, refusals);
}

ReprojectedTaps Reprojection::taps(int x, int y) const {
    ReprojectedRow one(1);
    row(y, x, x + 1, one);
    ReprojectedTaps taps = one.pixel(0);
    const float px = static_cast<float>(x) + signals_[Signal::Motion].at(0, x, y),
                py = static_cast<float>(y) + signals_[Signal::Motion].at(1, x, y);
    if (std::fabs(px) < 1e6f && std::fabs(py) < 1e6f) {
        taps.x0 = wholeBelow(wholePixel(px));
        taps.y0 = wholeBelow(wholePixel(py));
    }
    if (taps.count > 0) return taps;
    const ReprojectedTaps wide = widen(x, y);
    if (wide.count == 0) return taps;
    taps.count = wide.count;
    taps.wide = true;
    taps.index = wide.index;
    taps.weight = wide.weight;
    return taps;
}

ReprojectedTaps Reprojection::widen(int x, int y) const {
    ReprojectedTaps taps;
    const Extent2 extent = signals_.extent();
    const Image& motion = signals_[Signal::Motion];
    const uint32_t object = signals_.ids(Signal::ObjectId).at(0, x, y);
    const float px = static_cast<float>(x) + motion.at(0, x, y), py = static_cast<float>(y) + motion.at(1, x, y);
    const bool near =
        px > -2 && py > -2 && px < static_cast<float>(extent.width) + 1 && py < static_cast<float>(extent.height) + 1;
    if (!settings_.wideFallback || object == 0 || !near) return taps;
    const float expected = 1 / (signals_[Signal::Depth].at(0, x, y) + motion.at(2, x, y));
    const Image& slope = signals_[Signal::DepthGradient];
    const float allowed =
        settings_.depthTolerance * expected + 2 * (std::fabs(slope.at(0, x, y)) + std::fabs(slope.at(1, x, y)));
    const int cx = static_cast<int>(std::floor(px + 0.5f)), cy = static_cast<int>(std::floor(py + 0.5f));
    for (int j = std::max(cy - 1, 0); j <= std::min(cy + 1, extent.height - 1); ++j)
        for (int i = std::max(cx - 1, 0); i <= std::min(cx + 1, extent.width - 1); ++i) {
            float cosine = 0;
            for (int c = 0; c < 3; ++c)
                cosine += previous_.objectNormal.at(c, i, j) * signals_[Signal::ObjectNormal].at(c, x, y);
            const bool alike = previous_.objectId.at(0, i, j) == object && cosine >= normalCosine_ &&
                               std::fabs(previous_.inverseDepth.at(0, i, j) - expected) <= allowed;
            if (alike) taps.index[static_cast<size_t>(taps.count++)] = j * extent.width + i;
        }
    for (int k = 0; k < taps.count; ++k) taps.weight[static_cast<size_t>(k)] = 1 / static_cast<float>(taps.count);
    taps.wide = taps.count > 0;
    return taps;
}

void VerdictImages::unused(Extent2 extent) const {
    if (verdict) verdict->reset(extent, 1), verdict->fill(kVerdictUnused);
    if (refusals) refusals->reset(extent, 4), refusals->fill(0);
}

std::array<float, 4> refusalMasks(const std::array<uint8_t, 4>& refusals) {
    constexpr uint8_t reasons[4] = {kTapOtherObject, kTapDepth, kTapNormal, kTapOffScreen};
    std::array<float, 4> masks{};
    for (size_t r = 0; r < 4; ++r)
        for (size_t tap = 0; tap < 4; ++tap)
            if (refusals[tap] & reasons[r]) masks[r] += static_cast<float>(1 << tap);
    return masks;
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
