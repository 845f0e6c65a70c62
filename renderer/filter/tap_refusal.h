#pragma once
#include <cstdint>

namespace lumi {

/// Why a tap of the history is refused; several may hold at once.
enum TapRefusal : uint8_t {
    kTapKept = 0,
    kTapOffScreen = 1,
    kTapOtherObject = 2,
    kTapDepth = 4,
    kTapNormal = 8,
    kTapUnused = 16  ///< its bilinear weight is 0
};

}  // namespace lumi
