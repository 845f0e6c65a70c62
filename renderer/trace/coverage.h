#pragma once
#include <algorithm>

#include "scene/material.h"

namespace lumi {

/// Alpha of a surface point: the material's, its texture's (level 0) and the vertices', multiplied. `corners` are the
/// triangle's vertices; `colours` and `uv` (both sets) are the mesh's attributes or null.
inline float alphaAt(const Material& material, const UVec3& corners, const Vec4* colours, const Vec2* const uv[2],
                     Vec2 barycentrics) {
    const float b1 = barycentrics.x, b2 = barycentrics.y, b0 = 1 - b1 - b2;
    float alpha = material.alpha;
    if (colours) alpha *= colours[corners.x].w * b0 + colours[corners.y].w * b1 + colours[corners.z].w * b2;
    if (const Texture& texture = material.baseColorTexture)
        if (const Vec2* set = uv[texture.uvSet == 1 ? 1 : 0])
            alpha *= texture.sampleAlpha(set[corners.x] * b0 + set[corners.y] * b1 + set[corners.z] * b2);
    return alpha;
}

/// The share of rays that stop at a point of that alpha: 1 where opaque, 0 or 1 where masked, alpha where blended.
/// Light samples on an emitter count by it, since rays find the emitter that often.
inline float coverage(const Material& material, float alpha) {
    switch (material.alphaMode) {
        case AlphaMode::Mask: return alpha >= material.alphaCutoff ? 1.0f : 0.0f;
        case AlphaMode::Blend: return std::clamp(alpha, 0.0f, 1.0f);
        case AlphaMode::Opaque: break;
    }
    return 1;
}

}  // namespace lumi
