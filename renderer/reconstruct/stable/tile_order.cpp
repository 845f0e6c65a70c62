#include "reconstruct/stable/tile_order.h"

#include <algorithm>

#include "base/parallel.h"

namespace lumi {

std::span<const uint32_t> TileList::make(Extent2 extent,
                                         const std::function<void(const PixelRun&, std::vector<uint32_t>&)>& append) {
    constexpr int kTile = 16;
    bands_.resize(static_cast<size_t>((extent.height + kTile - 1) / kTile));
    parallelFor(static_cast<int64_t>(bands_.size()), [&](int64_t band) {
        std::vector<uint32_t>& items = bands_[static_cast<size_t>(band)];
        items.clear();
        const int top = static_cast<int>(band) * kTile;
        for (int left = 0; left < extent.width; left += kTile)
            for (int y = top; y < std::min(top + kTile, extent.height); ++y)
                append({static_cast<uint32_t>(y * extent.width + left),
                        static_cast<uint32_t>(std::min(kTile, extent.width - left))},
                       items);
    });
    std::vector<size_t> begins;
    size_t sum = 0;
    for (const auto& band : bands_) begins.push_back(sum), sum += band.size();
    items_.resize(sum);
    parallelFor(static_cast<int64_t>(bands_.size()), [&](int64_t band) {
        const auto& items = bands_[static_cast<size_t>(band)];
        std::copy(items.begin(), items.end(),
                  items_.begin() + static_cast<ptrdiff_t>(begins[static_cast<size_t>(band)]));
    });
    return items_;
}

size_t TileList::bytes() const {
    size_t words = items_.capacity();
    for (const auto& band : bands_) words += band.capacity();
    return words * 4;
}

}  // namespace lumi
