#pragma once

namespace lumi {

/// Below it a lobe's light is stored undivided, with albedo 1 (frame/signals.h).
constexpr float kLeastAlbedo = 0.01f;
/// The largest that is stored otherwise: 1 is the mark of undivided light, and of the sky.
constexpr float kMostAlbedo = 0x1.fffffep-1f;

/// One channel of a lobe's albedo as the signals store it. NaN counts as none.
inline float storedAlbedo(float albedo) {
    if (!(albedo >= kLeastAlbedo)) return 1;
    return albedo < kMostAlbedo ? albedo : kMostAlbedo;
}

}  // namespace lumi
