// The mip pyramid: each texel is the mean, in linear light, of what it covers in the level above.
#include <algorithm>
#include <cmath>

#include "math/colour.h"
#include "scene/texture.h"

namespace lumi {
namespace {

/// Half of an extent, rounded down, at least 1.
Extent2 halved(Extent2 extent) { return {std::max(1, extent.width / 2), std::max(1, extent.height / 2)}; }

/// Encoded byte of a linear value in [0, 2^14): fine enough that the darkest codes keep their own entries.
struct SrgbTables {
    std::vector<uint16_t> linearFromCode = std::vector<uint16_t>(256);
    std::vector<uint8_t> codeFromLinear = std::vector<uint8_t>(1 << 14);
    SrgbTables() {
        for (int i = 0; i < 256; ++i)
            linearFromCode[static_cast<size_t>(i)] =
                static_cast<uint16_t>(std::lround(linearFromSrgb(static_cast<float>(i) / 255) * 65535));
        for (int i = 0; i < (1 << 14); ++i) {
            const float linear = (static_cast<float>(i) + 0.5f) / (1 << 14);
            codeFromLinear[static_cast<size_t>(i)] = static_cast<uint8_t>(std::lround(srgbFromLinear(linear) * 255));
        }
        codeFromLinear[0] = 0;
    }
};

const SrgbTables& srgbTables() {
    static const SrgbTables tables;
    return tables;
}

/// One row of the next level from two rows above it; `step` is the distance in bytes to the right neighbour.
void halveRowSrgb(const uint8_t* top, const uint8_t* bottom, size_t step, int count, uint8_t* out) {
    const uint16_t* linear = srgbTables().linearFromCode.data();
    const uint8_t* code = srgbTables().codeFromLinear.data();
    for (int x = 0; x < count; ++x, top += 8, bottom += 8, out += 4) {
        for (int c = 0; c < 3; ++c) {
            const uint32_t sum =
                uint32_t(linear[top[c]]) + linear[top[step + c]] + linear[bottom[c]] + linear[bottom[step + c]];
            out[c] = code[sum >> 4];
        }
        out[3] = static_cast<uint8_t>((uint32_t(top[3]) + top[step + 3] + bottom[3] + bottom[step + 3] + 2) >> 2);
    }
}

void halveRowLinear(const uint8_t* top, const uint8_t* bottom, size_t step, int count, uint8_t* out) {
    for (int x = 0; x < count; ++x, top += 8, bottom += 8, out += 4)
        for (int c = 0; c < 4; ++c)
            out[c] = static_cast<uint8_t>((uint32_t(top[c]) + top[step + c] + bottom[c] + bottom[step + c] + 2) >> 2);
}

void halveRowFloat(const float* top, const float* bottom, size_t step, int count, float* out) {
    for (int x = 0; x < count; ++x, top += 8, bottom += 8, out += 4)
        for (int c = 0; c < 4; ++c) out[c] = 0.25f * (top[c] + top[step + c] + bottom[c] + bottom[step + c]);
}

/// Of even extents, or extents of one texel: 2x2, 2x1 or 1x2 texels make one.
void halvePairs(const TextureImage::Level& from, bool srgb, TextureImage::Level& to) {
    const size_t rowFrom = 4 * static_cast<size_t>(from.extent.width), rowTo = 4 * static_cast<size_t>(to.extent.width);
    const size_t step = from.extent.width > 1 ? 4 : 0;
    for (int y = 0; y < to.extent.height; ++y) {
        const size_t top = rowFrom * static_cast<size_t>(2 * y);
        const size_t bottom = from.extent.height > 1 ? top + rowFrom : top;
        const size_t out = rowTo * static_cast<size_t>(y);
        if (!from.floats.empty())
            halveRowFloat(&from.floats[top], &from.floats[bottom], step, to.extent.width, &to.floats[out]);
        else if (srgb) halveRowSrgb(&from.bytes[top], &from.bytes[bottom], step, to.extent.width, &to.bytes[out]);
        else halveRowLinear(&from.bytes[top], &from.bytes[bottom], step, to.extent.width, &to.bytes[out]);
    }
}

/// Texels that one of the next level covers along an axis, and their shares in it: of an odd extent three, those at the
/// sides in part, so that all count alike in the end.
struct Cover {
    size_t first = 0;
    int count = 1;
    float share[3] = {1, 0, 0};
};

std::vector<Cover> coversOf(int from, int to) {
    std::vector<Cover> covers(static_cast<size_t>(to));
    if (from == 1) return covers;
    const auto n = static_cast<float>(from);
    for (int i = 0; i < to; ++i) {
        Cover& cover = covers[static_cast<size_t>(i)];
        cover = {static_cast<size_t>(2 * i), 2, {0.5f, 0.5f, 0}};
        if (from % 2 == 0) continue;
        cover.count = 3;
        cover.share[0] = static_cast<float>(to - i) / n;
        cover.share[1] = static_cast<float>(to) / n;
        cover.share[2] = static_cast<float>(i + 1) / n;
    }
    return covers;
}

/// Adds a row of texels to `sum`, as they are stored but for sRGB, which is linear in [0, 1].
void addRow(const TextureImage::Level& from, size_t row, bool srgb, float share, std::vector<float>& sum) {
    const size_t start = row * sum.size();
    if (!from.floats.empty()) {
        const float* in = &from.floats[start];
        for (size_t i = 0; i < sum.size(); ++i) sum[i] += share * in[i];
        return;
    }
    const uint8_t* in = &from.bytes[start];
    if (!srgb) {
        for (size_t i = 0; i < sum.size(); ++i) sum[i] += share * static_cast<float>(in[i]);
        return;
    }
    const float* linear = linearFromSrgbTable();
    for (size_t i = 0; i < sum.size(); i += 4) {
        for (size_t c = 0; c < 3; ++c) sum[i + c] += share * linear[in[i + c]];
        sum[i + 3] += share * static_cast<float>(in[i + 3]);
    }
}

uint8_t rounded(float value) { return static_cast<uint8_t>(value + 0.5f); }

/// Of any extents. Rows are blended first, then texels of the row that makes.
void halveCovers(const TextureImage::Level& from, bool srgb, TextureImage::Level& to) {
    const std::vector<Cover> columns = coversOf(from.extent.width, to.extent.width);
    const std::vector<Cover> rows = coversOf(from.extent.height, to.extent.height);
    const uint8_t* code = srgbTables().codeFromLinear.data();
    std::vector<float> blended(4 * static_cast<size_t>(from.extent.width));
    size_t out = 0;
    for (const Cover& row : rows) {
        std::fill(blended.begin(), blended.end(), 0.0f);
        for (int k = 0; k < row.count; ++k)
            addRow(from, row.first + static_cast<size_t>(k), srgb, row.share[k], blended);
        for (const Cover& column : columns) {
            float mean[4] = {0, 0, 0, 0};
            const float* texel = &blended[4 * column.first];
            for (int k = 0; k < column.count; ++k, texel += 4)
                for (int c = 0; c < 4; ++c) mean[c] += column.share[k] * texel[c];
            for (int c = 0; c < 4; ++c, ++out) {
                if (!from.floats.empty()) to.floats[out] = mean[c];
                else if (!srgb || c == 3) to.bytes[out] = rounded(mean[c]);
                else to.bytes[out] = code[std::min(static_cast<int>(mean[c] * (1 << 14)), (1 << 14) - 1)];
            }
        }
    }
}

bool isPaired(int extent) { return extent == 1 || extent % 2 == 0; }

TextureImage::Level halvedLevel(const TextureImage::Level& from, bool srgb) {
    TextureImage::Level to;
    to.extent = halved(from.extent);
    const size_t values = 4 * static_cast<size_t>(to.extent.area());
    if (!from.floats.empty()) to.floats.resize(values);
    else to.bytes.resize(values);
    if (isPaired(from.extent.width) && isPaired(from.extent.height)) halvePairs(from, srgb, to);
    else halveCovers(from, srgb, to);
    return to;
}

}  // namespace

void buildMips(TextureImage& image) {
    while (image.levels.back().extent.area() > 1) image.levels.push_back(halvedLevel(image.levels.back(), image.srgb));
}

}  // namespace lumi
