#include "frame/display_range.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace lumi {

ValueRange percentileRange(int64_t count, const std::function<float(int64_t)>& value) {
    // An odd step meets all columns of images with even widths.
    const int64_t step = std::max<int64_t>(count / 65536, 1) | 1;
    std::vector<float> finite;
    finite.reserve(static_cast<size_t>(count / step + 1));
    for (int64_t i = 0; i < count; i += step)
        if (const float v = value(i); std::isfinite(v)) finite.push_back(v);
    if (finite.empty()) return {0, 1};
    const auto quantile = [&](double fraction) {
        const auto place = static_cast<std::ptrdiff_t>(std::lround(fraction * static_cast<double>(finite.size() - 1)));
        std::nth_element(finite.begin(), finite.begin() + place, finite.end());
        return finite[static_cast<size_t>(place)];
    };
    const float low = quantile(0.01);
    return {low, quantile(0.99)};
}

ValueRange opened(const ValueRange& range) {
    if (range.high > range.low) return range;
    if (range.low == 0) return {0, 1};
    return {std::min(range.low, 0.0f), std::max(range.low, 0.0f)};
}

}  // namespace lumi
