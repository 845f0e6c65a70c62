#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "math/vector.h"

namespace lumi {

/// Runs of neighbouring pixels, 16 in a row, tile after tile of 16 x 16: work in this order is coherent, as rays of
/// neighbours meet the same things.
struct PixelRun {
    uint32_t pixel = 0;  ///< the first
    uint32_t count = 0;
};
std::vector<PixelRun> tileOrder(Extent2 extent);

}  // namespace lumi
