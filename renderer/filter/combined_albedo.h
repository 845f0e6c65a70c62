#pragma once

namespace lumi {

constexpr float kLeastAlbedo = 0.01f;  ///< below it the signals store a lobe undivided, with albedo 1 (frame/signals.h)

/// What light is divided by: the lobes' albedos together, one channel, as the signals store them; see DemodulatedFrame. An
/// albedo of exactly 1 beside one that is smaller is the mark of an undivided lobe. NaN counts as 1.
[[gnu::always_inline]] inline float combinedAlbedo(float diffuse, float specular) {
    float sum = diffuse + specular;
    sum = specular == 1.0f ? diffuse : sum;
    sum = diffuse == 1.0f ? specular : sum;
    sum = sum < 1.0f ? sum : 1.0f;  // NaN too
    return sum > kLeastAlbedo ? sum : kLeastAlbedo;
}

}  // namespace lumi
