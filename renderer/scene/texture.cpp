#include "scene/texture.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "math/colour.h"
#include "scene/texture_taps.h"

namespace lumi {
namespace {

[[gnu::always_inline]] inline size_t texelOffset(const TextureImage::Level& level, int x, int y) {
    return 4 * (static_cast<size_t>(y) * static_cast<size_t>(level.extent.width) + static_cast<size_t>(x));
}

/// Values of the 256 codes as they are stored in an image: linear or sRGB.
const float* byteTable(bool srgb) {
    static const std::array<float, 256> linear = [] {
        std::array<float, 256> values{};
        for (size_t i = 0; i < 256; ++i) values[i] = static_cast<float>(i) * (1.0f / 255);
        return values;
    }();
    return srgb ? linearFromSrgbTable() : linear.data();
}

[[gnu::always_inline]] inline Vec4 decoded(const uint8_t* p, const float* colour, const float* alpha) {
    return {colour[p[0]], colour[p[1]], colour[p[2]], alpha[p[3]]};
}

Vec4 texel(const TextureImage& image, const TextureImage::Level& level, int x, int y) {
    const size_t offset = texelOffset(level, x, y);
    if (level.floats.empty()) return decoded(level.bytes.data() + offset, byteTable(image.srgb), byteTable(false));
    const float* p = level.floats.data() + offset;
    return {p[0], p[1], p[2], p[3]};
}

Vec4 sampleLevel(const Texture& texture, const TextureImage::Level& level, Vec2 uv) {
    const TextureImage& image = *texture.image;
    const auto [width, height] = level.extent;
    if (texture.filter == TextureFilter::Nearest)
        return texel(image, level, nearestTexel(uv.x, width, texture.wrapU), nearestTexel(uv.y, height, texture.wrapV));
    const AxisTap x = linearTap(uv.x, width, texture.wrapU);
    const AxisTap y = linearTap(uv.y, height, texture.wrapV);
    const auto blended = [&](const Vec4& a, const Vec4& b, const Vec4& c, const Vec4& d) {
        const Vec4 top = a * (1 - x.weight) + b * x.weight, bottom = c * (1 - x.weight) + d * x.weight;
        return top * (1 - y.weight) + bottom * y.weight;
    };
    const size_t corners[] = {texelOffset(level, x.first, y.first), texelOffset(level, x.second, y.first),
                              texelOffset(level, x.first, y.second), texelOffset(level, x.second, y.second)};
    if (level.floats.empty()) {
        const float *colour = byteTable(image.srgb), *alpha = byteTable(false);
        const auto at = [&](size_t corner) { return decoded(level.bytes.data() + corners[corner], colour, alpha); };
        return blended(at(0), at(1), at(2), at(3));
    }
    const auto at = [&](size_t corner) {
        const float* p = level.floats.data() + corners[corner];
        return Vec4(p[0], p[1], p[2], p[3]);
    };
    return blended(at(0), at(1), at(2), at(3));
}

bool finite(Vec2 v) { return std::isfinite(v.x) && std::isfinite(v.y); }

}  // namespace

size_t TextureImage::byteCount() const {
    size_t bytes = 0;
    for (const Level& level : levels) bytes += level.bytes.size() + level.floats.size() * sizeof(float);
    return bytes;
}

Vec2 Texture::transformed(Vec2 uv) const {
    const Vec2 scaled = uv * scale;
    if (rotation == 0) return scaled + offset;
    const float c = std::cos(rotation), s = std::sin(rotation);
    return Vec2(c * scaled.x + s * scaled.y, c * scaled.y - s * scaled.x) + offset;
}

float Texture::levelOf(float width) const {
    const TextureImage::Level& finest = image->levels.front();
    const float texels = width * std::sqrt(std::abs(scale.x * scale.y) * static_cast<float>(finest.extent.area()));
    return texels > 1 ? std::min(coarseLog2(texels), static_cast<float>(image->levels.size() - 1)) : 0;
}

Vec4 Texture::sample(Vec2 uv, float width) const {
    if (!image) return Vec4(1);
    uv = transformed(uv);
    if (!finite(uv)) return texel(*image, image->levels.front(), 0, 0);
    const float level = levelOf(width);
    if (filter == TextureFilter::Nearest)
        return sampleLevel(*this, image->levels[static_cast<size_t>(level + 0.5f)], uv);
    const size_t lower = static_cast<size_t>(level);
    const float weight = level - static_cast<float>(lower);
    const Vec4 fine = sampleLevel(*this, image->levels[lower], uv);
    if (weight == 0) return fine;
    return fine * (1 - weight) + sampleLevel(*this, image->levels[lower + 1], uv) * weight;
}

Vec4 Texture::sampleNearestLevel(Vec2 uv, float width) const {
    if (!image) return Vec4(1);
    uv = transformed(uv);
    if (!finite(uv)) return texel(*image, image->levels.front(), 0, 0);
    return sampleLevel(*this, image->levels[static_cast<size_t>(levelOf(width) + 0.5f)], uv);
}

void Texture::prefetch(Vec2 uv, float width) const {
    uv = transformed(uv);
    if (!image || !finite(uv)) return;
    const TextureImage::Level& level = image->levels[static_cast<size_t>(levelOf(width) + 0.5f)];
    const auto [columns, rows] = level.extent;
    const int x = nearestTexel(uv.x, columns, wrapU);
    const AxisTap y = linearTap(uv.y, rows, wrapV);
    for (const int row : {y.first, y.second}) {
        const size_t start = texelOffset(level, x, row);
        if (level.floats.empty()) __builtin_prefetch(level.bytes.data() + start);
        else __builtin_prefetch(level.floats.data() + start);
    }
}

float Texture::sampleAlpha(Vec2 uv) const {
    if (!image) return 1;
    const TextureImage::Level& level = image->levels.front();
    uv = transformed(uv);
    const auto alpha = [&](int x, int y) {
        const size_t place =
            4 * (static_cast<size_t>(y) * static_cast<size_t>(level.extent.width) + static_cast<size_t>(x)) + 3;
        return level.floats.empty() ? static_cast<float>(level.bytes[place]) * (1.0f / 255) : level.floats[place];
    };
    if (!finite(uv)) return alpha(0, 0);
    const auto [columns, rows] = level.extent;
    if (filter == TextureFilter::Nearest)
        return alpha(nearestTexel(uv.x, columns, wrapU), nearestTexel(uv.y, rows, wrapV));
    const AxisTap x = linearTap(uv.x, columns, wrapU);
    const AxisTap y = linearTap(uv.y, rows, wrapV);
    const float top = alpha(x.first, y.first) * (1 - x.weight) + alpha(x.second, y.first) * x.weight;
    const float bottom = alpha(x.first, y.second) * (1 - x.weight) + alpha(x.second, y.second) * x.weight;
    return top * (1 - y.weight) + bottom * y.weight;
}

}  // namespace lumi
