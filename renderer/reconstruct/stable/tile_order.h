#pragma once
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "math/vector.h"

namespace lumi {

/// Neighbouring pixels of a row, 16 at most.
struct PixelRun {
    uint32_t pixel = 0;  ///< the first
    uint32_t count = 0;
};

/// A list of what is to be traced, run after run of pixels, tile after tile of 16 x 16: work in this order is coherent,
/// as rays of neighbours meet the same things. Keeps its memory from frame to frame.
class TileList {
public:
    /// `append` puts what a run has to offer at the end of a vector; it is called from all threads, for each run once.
    std::span<const uint32_t> make(Extent2 extent,
                                   const std::function<void(const PixelRun&, std::vector<uint32_t>&)>& append);
    std::span<const uint32_t> items() const { return items_; }
    size_t bytes() const;

private:
    std::vector<std::vector<uint32_t>> bands_;  ///< of each row of tiles
    std::vector<uint32_t> items_;
};

}  // namespace lumi
