#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "math/vector.h"

namespace lumi {

enum class Wrap : uint8_t { Repeat, MirroredRepeat, ClampToEdge };
enum class TextureFilter : uint8_t { Nearest, Linear };

/// Decoded pixels with their mip pyramid. Level 0 is the file's, row 0 its top row; level k is half of level k-1,
/// rounded down, at least 1, each texel the mean of what it covers there in linear light: all levels have the same
/// mean. Either 8-bit RGBA (colour textures keep sRGB encoding until lookup) or float RGBA (HDR).
struct TextureImage {
    struct Level {
        Extent2 extent;
        std::vector<uint8_t> bytes;  ///< RGBA8, empty for float images
        std::vector<float> floats;   ///< RGBA32F, empty for 8-bit images
    };
    std::string name;   ///< file name or "image 3", for messages
    bool srgb = false;  ///< RGB is sRGB-encoded; alpha never is
    std::vector<Level> levels;

    size_t byteCount() const;
};

/// A texture as a material uses it: image, sampler, UV set and KHR_texture_transform.
struct Texture {
    std::shared_ptr<const TextureImage> image;  ///< null: no texture, lookups give 1
    Wrap wrapU = Wrap::Repeat, wrapV = Wrap::Repeat;
    TextureFilter filter = TextureFilter::Linear;
    int uvSet = 0;
    Vec2 offset{0}, scale{1};
    float rotation = 0;  ///< radians, counter-clockwise in texture space as KHR_texture_transform defines it

    explicit operator bool() const { return image != nullptr; }
    bool operator==(const Texture&) const = default;
    /// Texture-space coordinates (v down) of the mesh's uv.
    Vec2 transformed(Vec2 uv) const;
    /// Linear RGBA at mesh coordinates `uv`. `width` is the lookup's footprint in units of uv (0: level 0, bilinear);
    /// between levels the lookup is trilinear. NaN coordinates give level 0's first texel.
    Vec4 sample(Vec2 uv, float width = 0) const;
    /// As sample(), but from the one mip level nearest to the footprint: for lookups that are averaged anyway.
    Vec4 sampleNearestLevel(Vec2 uv, float width) const;
    /// Asks the caches for what sampleNearestLevel() will read, and most of what sample() will.
    void prefetch(Vec2 uv, float width) const;
    /// Alpha channel alone, level 0: for alpha tests during traversal.
    float sampleAlpha(Vec2 uv) const;

private:
    /// Fractional mip level, within the pyramid, of a footprint that is `width` wide in uv.
    float levelOf(float width) const;
};

/// Builds the pyramid above level 0. `image.levels` holds exactly level 0.
void buildMips(TextureImage& image);

}  // namespace lumi
