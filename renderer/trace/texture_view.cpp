#include "trace/texture_view.h"

#include <emmintrin.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "math/colour.h"
#include "scene/texture_taps.h"

namespace lumi {
namespace {

/// Mesh coordinates into the texture's; those that are no place in it become 0.
Vec2 usable(const TextureView& view, float u, float v) {
    const float x = view.uvX.x * u + view.uvX.y * v + view.offset.x,
                y = view.uvY.x * u + view.uvY.y * v + view.offset.y;
    constexpr float kMost = 1e6f;
    return std::abs(x) < kMost && std::abs(y) < kMost ? Vec2(x, y) : Vec2(0);
}

TexelTaps tapsIn(const TextureView& view, Vec2 uv, int level) {
    const TextureView::Level& in = view.levels[static_cast<size_t>(level)];
    const AxisTap x = linearTap(uv.x, in.width, view.wrapU), y = linearTap(uv.y, in.height, view.wrapV);
    const uint32_t top = static_cast<uint32_t>(y.first) * static_cast<uint32_t>(in.width);
    const uint32_t bottom = static_cast<uint32_t>(y.second) * static_cast<uint32_t>(in.width);
    const auto left = static_cast<uint32_t>(x.first), right = static_cast<uint32_t>(x.second);
    return {
        level, {4 * (top + left), 4 * (top + right), 4 * (bottom + left), 4 * (bottom + right)}, x.weight, y.weight};
}

__m128 linearTexel(const uint8_t* p) {
    const __m128i zero = _mm_setzero_si128();
    int32_t rgba;
    std::memcpy(&rgba, p, sizeof rgba);
    return _mm_cvtepi32_ps(_mm_unpacklo_epi16(_mm_unpacklo_epi8(_mm_cvtsi32_si128(rgba), zero), zero));
}

__m128 srgbTexel(const uint8_t* p, const float* table) {
    return _mm_setr_ps(table[p[0]], table[p[1]], table[p[2]], static_cast<float>(p[3]));
}

__m128 lerp(__m128 a, __m128 b, float weight) {
    return _mm_add_ps(a, _mm_mul_ps(_mm_sub_ps(b, a), _mm_set1_ps(weight)));
}

}  // namespace

bool hasTextureView(const Texture& t) {
    if (t.filter != TextureFilter::Linear || t.image->levels.size() > TextureView::kMostLevels) return false;
    return std::all_of(t.image->levels.begin(), t.image->levels.end(),
                       [](const TextureImage::Level& level) { return !level.bytes.empty(); });
}

TextureView makeTextureView(const Texture& t) {
    TextureView view;
    view.levelCount = static_cast<int>(t.image->levels.size());
    for (size_t k = 0; k < t.image->levels.size(); ++k) {
        const TextureImage::Level& level = t.image->levels[k];
        view.levels[k] = {level.bytes.data(), level.extent.width, level.extent.height};
    }
    view.wrapU = t.wrapU, view.wrapV = t.wrapV;
    if (t.image->srgb) view.decode = linearFromSrgbTable();
    view.offset = t.transformed(Vec2(0));
    const Vec2 x = t.transformed({1, 0}) - view.offset, y = t.transformed({0, 1}) - view.offset;
    view.uvX = {x.x, y.x}, view.uvY = {x.y, y.y};
    view.texelsPerUnit =
        std::sqrt(std::abs(t.scale.x * t.scale.y) * static_cast<float>(t.image->levels.front().extent.area()));
    return view;
}

TexelTaps findTaps(const TextureView& view, float u, float v, float width, float* fraction) {
    const float texels = width * view.texelsPerUnit;
    const float level = texels > 1 ? std::min(coarseLog2(texels), static_cast<float>(view.levelCount - 1)) : 0;
    const int chosen = static_cast<int>(fraction ? level : level + 0.5f);
    if (fraction) *fraction = level - static_cast<float>(chosen);
    return tapsIn(view, usable(view, u, v), chosen);
}

TexelTaps coarser(const TextureView& view, float u, float v, int level) {
    return tapsIn(view, usable(view, u, v), std::min(level + 1, view.levelCount - 1));
}

Vec4 blend(const TextureView& view, const TexelTaps& taps) {
    const uint8_t* bytes = view.levels[static_cast<size_t>(taps.level)].bytes;
    __m128 a, b, c, d, scale;
    if (const float* table = view.decode) {
        a = srgbTexel(bytes + taps.corner[0], table), b = srgbTexel(bytes + taps.corner[1], table);
        c = srgbTexel(bytes + taps.corner[2], table), d = srgbTexel(bytes + taps.corner[3], table);
        scale = _mm_setr_ps(1, 1, 1, 1.0f / 255);
    } else {
        a = linearTexel(bytes + taps.corner[0]), b = linearTexel(bytes + taps.corner[1]);
        c = linearTexel(bytes + taps.corner[2]), d = linearTexel(bytes + taps.corner[3]);
        scale = _mm_set1_ps(1.0f / 255);
    }
    const __m128 value = _mm_mul_ps(lerp(lerp(a, b, taps.x), lerp(c, d, taps.x), taps.y), scale);
    alignas(16) float out[4];
    _mm_store_ps(out, value);
    return {out[0], out[1], out[2], out[3]};
}

}  // namespace lumi
