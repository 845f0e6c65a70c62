#include "measure/map_range.h"

#include <algorithm>
#include <cmath>

#include "frame/display_range.h"

namespace lumi {
namespace {

float reachOf(const Image& map) {
    const float* values = map.data();
    const float high = percentileRange(map.extent().area(), [values](int64_t i) { return values[i]; }).high;
    if (high > 0) return high;
    float largest = 0;
    for (size_t i = 0; i < map.size(); ++i)
        if (std::isfinite(values[i])) largest = std::max(largest, values[i]);
    return largest;
}

}  // namespace

void MapRange::add(const Image& map) {
    if (!map.empty() && !unit_) reach_ = std::max(reach_, reachOf(map));
}

DisplaySettings MapRange::display() const {
    DisplaySettings settings;
    settings.colourMap = colours_;
    settings.autoRange = false, settings.low = 0, settings.high = high();
    return settings;
}

}  // namespace lumi
