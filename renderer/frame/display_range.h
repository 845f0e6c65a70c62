#pragma once
#include <cstdint>
#include <functional>

namespace lumi {

struct ValueRange {
    float low = 0, high = 1;
};

/// 1st and 99th percentile of the finite ones among value(0) to value(count - 1), from a fixed, evenly spaced subset of
/// at most about 65,000. {0, 1} if none is finite.
ValueRange percentileRange(int64_t count, const std::function<float(int64_t)>& value);

/// The range itself, or if it is empty one that has the value at an end and 0 at the other.
ValueRange opened(const ValueRange& range);

}  // namespace lumi
