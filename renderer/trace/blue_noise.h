#pragma once
#include <cstdint>

namespace lumi {

/// A tile of kSide x kSide pixels that holds every multiple of 1/kSide^2 once, so that numbers near each other stand
/// far from each other: its low frequencies are empty. Made at first use by the void-and-cluster method [Ulichney 1993,
/// "The void-and-cluster method for dither array generation"], the same on every machine. Differs from the paper:
/// nowhere.
class BlueNoiseTile {
public:
    static constexpr int kSide = 64;
    static const BlueNoiseTile& instance();

    /// Number in [0, 1) at a pixel; the tile repeats. The lower bits within a step of the ranks are 0.
    float at(uint32_t x, uint32_t y) const { return values_[(y % kSide) * kSide + x % kSide]; }

private:
    BlueNoiseTile();
    float values_[kSide * kSide];
};

}  // namespace lumi
