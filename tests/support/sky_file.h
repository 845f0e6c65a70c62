#pragma once
#include <filesystem>

#include "image/exr.h"

namespace lumi::test {

/// Writes a sky of 4 x 2 pixels that has this radiance, W/(m^2 sr), in every direction and channel.
inline void writeSky(const std::filesystem::path& path, float radiance) {
    Image sky({4, 2}, 3);
    sky.fill(radiance);
    ExrLayers layers;
    layers.add("", "RGB", sky);
    writeExr(path, layers);
}

}  // namespace lumi::test
