#pragma once
#include "frame/display.h"
#include "measure/measure.h"

namespace lumi {

/// The one range of colours in which error maps of a metric are shown, so that they can be laid beside each other: from
/// 0, to 1 for maps that have a scale of their own (Metric::unitMap), else to the largest 99th percentile of a map.
/// Where that is 0 to the largest value, and where all are 0 to 1.
class MapRange {
public:
    explicit MapRange(const Metric& metric) : colours_(metric.mapColours), unit_(metric.unitMap) {}
    /// Of a metric of sequences.
    MapRange() = default;

    /// A map with one channel; an empty one, and values that are not finite, count for nothing.
    void add(const Image& map);
    float high() const { return unit_ || reach_ == 0 ? 1 : reach_; }
    /// The metric's colours over this range.
    DisplaySettings display() const;

private:
    const char* colours_ = "magma";
    bool unit_ = false;
    float reach_ = 0;
};

}  // namespace lumi
