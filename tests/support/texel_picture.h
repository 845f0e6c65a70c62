#pragma once
#include <memory>
#include <vector>

#include "scene/texture.h"

namespace lumi::test {

/// A linear texture whose texels, row by row, are `colours`; read without blending and without repeating.
inline Texture texelPicture(Extent2 extent, const std::vector<Vec3>& colours) {
    auto image = std::make_shared<TextureImage>();
    TextureImage::Level level;
    level.extent = extent;
    for (const Vec3& colour : colours)
        for (const float channel : {colour.x, colour.y, colour.z, 1.0f}) level.floats.push_back(channel);
    image->levels.push_back(level);
    buildMips(*image);
    Texture texture;
    texture.image = image;
    texture.wrapU = texture.wrapV = Wrap::ClampToEdge;
    texture.filter = TextureFilter::Nearest;
    return texture;
}

}  // namespace lumi::test
