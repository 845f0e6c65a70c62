#pragma once
#include <cstdint>

#include "image/image.h"
#include "math/hash.h"

namespace lumi::test {

/// Reproducible values in [0, scale).
inline Image noiseImage(Extent2 extent, int channels, float scale = 1, uint32_t seed = 1) {
    Image image(extent, channels);
    for (size_t i = 0; i < image.size(); ++i)
        image.data()[i] = scale * unitFloat(hashCombine(seed, static_cast<uint32_t>(i)));
    return image;
}

inline Image8 noiseImage8(Extent2 extent, uint32_t seed = 1) {
    Image8 image{extent, std::vector<uint8_t>(static_cast<size_t>(extent.area()) * 4)};
    for (size_t i = 0; i < image.rgba.size(); ++i)
        image.rgba[i] = static_cast<uint8_t>(hashCombine(seed, static_cast<uint32_t>(i)));
    return image;
}

}  // namespace lumi::test
