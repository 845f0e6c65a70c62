#include "reconstruct/stable/tile_order.h"

#include <algorithm>

namespace lumi {

std::vector<PixelRun> tileOrder(Extent2 extent) {
    constexpr int kTile = 16;
    std::vector<PixelRun> runs;
    for (int top = 0; top < extent.height; top += kTile)
        for (int left = 0; left < extent.width; left += kTile)
            for (int y = top; y < std::min(top + kTile, extent.height); ++y)
                runs.push_back({static_cast<uint32_t>(y * extent.width + left), static_cast<uint32_t>(std::min(kTile, extent.width - left))});
    return runs;
}

}  // namespace lumi
