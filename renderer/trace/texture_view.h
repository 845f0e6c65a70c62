#pragma once
#include <array>

#include "scene/texture.h"
#include "trace/scene_tables.h"

namespace lumi {

/// Where a bilinear lookup reads, and how it blends: found early so that the texels can be asked for.
struct TexelTaps {
    int level = 0;
    uint32_t corner[4] = {0, 0, 0, 0};  ///< bytes into the level: both of the upper row, both of the lower
    float x = 0, y = 0;                 ///< weights of the right and of the lower ones
};

/// Can there be a view of the texture, which has an image? Others go by Texture::sample().
bool hasTextureView(const Texture& texture);
TextureView makeTextureView(const Texture& texture);

/// Linear RGBA where `taps` point to.
Vec4 blend(const TextureView& view, const TexelTaps& taps);

/// Taps at mesh coordinates (u, v) in the mip level nearest to a footprint `width` wide in uv. `fraction` (may be null)
/// receives how far from `level` towards the next the footprint is; `level` is the finer of both then.
TexelTaps findTaps(const TextureView& view, float u, float v, float width, float* fraction = nullptr);

/// The same place in the next coarser level.
TexelTaps coarser(const TextureView& view, float u, float v, int level);

inline void prefetch(const TextureView& view, const TexelTaps& taps) {
    const uint8_t* bytes = view.levels[static_cast<size_t>(taps.level)].bytes;
    __builtin_prefetch(bytes + taps.corner[0]);
    __builtin_prefetch(bytes + taps.corner[2]);
}

}  // namespace lumi
