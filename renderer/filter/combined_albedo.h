#pragma once
#include "frame/stored_albedo.h"

namespace lumi {

/// What light is divided by: the lobes' albedos together, one channel, as the signals store them; see DemodulatedFrame.
/// A lobe that is stored undivided, of an albedo below 0.01, counts as none, so that what is divided changes by a
/// factor of two at most where a dark texture or metal passes that mark. NaN counts as 1.
[[gnu::always_inline]] inline float combinedAlbedo(float diffuse, float specular) {
    float sum = (diffuse == 1.0f ? 0.0f : diffuse) + (specular == 1.0f ? 0.0f : specular);
    sum = sum < 1.0f ? sum : 1.0f;  // NaN too
    return sum > kLeastAlbedo ? sum : kLeastAlbedo;
}

}  // namespace lumi
