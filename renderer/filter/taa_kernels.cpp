#include "filter/taa_kernels.h"

#include <cmath>
#include <cstddef>
#include <cstdint>

#include "filter/index_runs.h"
#include "filter/whole_pixel.h"

namespace lumi::LUMI_ISA {
namespace {

constexpr int kBlock = 256;
constexpr float kLargest = 3.402823466e38f;
constexpr float kLeastRest = 0x1p-24f;  ///< 1 - luma of the brightest that is not 1

inline float finiteOr0(float v) { return std::fabs(v) <= kLargest ? v : 0.0f; }

void compressRow(const float* const rgb[3], float* const out[3], float exposure, int count) {
    for (int x = 0; x < count; ++x) {
        const float r = finiteOr0(rgb[0][x] * exposure), g = finiteOr0(rgb[1][x] * exposure),
                    b = finiteOr0(rgb[2][x] * exposure);
        const float y = 0.25f * r + 0.5f * g + 0.25f * b;
        const float scale = 1.0f / (1.0f + (y > 0.0f ? y : 0.0f));
        out[0][x] = y * scale;
        out[1][x] = 0.5f * (r - b) * scale;
        out[2][x] = (-0.25f * r + 0.5f * g - 0.25f * b) * scale;
    }
}

/// What the steps of a block hand on.
struct Block {
    alignas(64) int32_t x0[kBlock], y0[kBlock];  ///< of the history's tap up and left of the point
    alignas(64) float fx[kBlock], fy[kBlock];
    alignas(64) float inside[kBlock];  ///< 1: the point lay in the previous image
    alignas(64) float history[3][kBlock], mean[3][kBlock], excess[kBlock];
};

/// Rows of a plane, borders repeated.
struct Rows {
    std::ptrdiff_t above, here, below;
};

/// Pixels of a block that have their neighbours at the same offsets: all but those of the borders, which repeat.
struct Range {
    int first, count;  ///< pixels of the row
    int at;            ///< of the first in the block
    int left, right;   ///< offsets of the neighbours
};

template <class Body>
inline void forRanges(const TaaRow& row, int first, int count, Body body) {
    const int last = row.width - 1, end = first + count;
    int x = first;
    if (x == 0) {
        body(Range{0, 1, 0, 0, last > 0 ? 1 : 0});
        x = 1;
    }
    const int inner = end < last ? end : last;
    if (x < inner) {
        body(Range{x, inner - x, x - first, -1, 1});
        x = inner;
    }
    if (x < end) body(Range{x, 1, x - first, -1, 0});
}

/// Where the pixels were, by the motion of the nearest surface of 3x3: silhouettes move with what is in front.
void findPoints(const TaaRow& row, const Rows& rows, const Range& range, Block& block) {
    const float* __restrict mx = row.motion[0];
    const float* __restrict my = row.motion[1];
    int32_t* __restrict outX = block.x0 + range.at;
    int32_t* __restrict outY = block.y0 + range.at;
    float* __restrict outFx = block.fx + range.at;
    float* __restrict outFy = block.fy + range.at;
    float* __restrict outInside = block.inside + range.at;
    const float right = static_cast<float>(row.width - 1), bottom = static_cast<float>(row.height - 1),
                y = static_cast<float>(row.y);
    const int32_t lines[3] = {static_cast<int32_t>(rows.above), static_cast<int32_t>(rows.here),
                              static_cast<int32_t>(rows.below)};
    const int32_t sides[3] = {range.left, 0, range.right};
    const int32_t here = lines[1] + range.first;
    const float* __restrict z = row.nearness + here;
    int32_t offset[9];
    for (int n = 0; n < 9; ++n) offset[n] = lines[n / 3] - lines[1] + sides[n % 3];
    for (int k = 0; k < range.count; ++k) {
        const int32_t x = range.first + k;
        int32_t to = 0;  // its offset; indices of loads are k and what does not change, so that they are read in a row
        float nearest = z[k];
        for (int n = 0; n < 9; ++n) {
            const float there = (z + offset[n])[k];
            const bool nearer = there > nearest;
            nearest = nearer ? there : nearest;
            to = nearer ? offset[n] : to;
        }
        const int32_t at = here + k + to;
        float px = static_cast<float>(x) + mx[at], py = y + my[at];
        const bool near = (px > -1.0f) & (py > -1.0f) & (px < right + 1.0f) & (py < bottom + 1.0f);
        px = wholePixel(near ? px : -1.0f);
        py = wholePixel(near ? py : -1.0f);
        const bool inside = (px >= 0.0f) & (py >= 0.0f) & (px <= right) & (py <= bottom);
        px = inside ? px : 0.0f;
        py = inside ? py : 0.0f;
        const int32_t x0 = static_cast<int32_t>(px), y0 = static_cast<int32_t>(py);
        outInside[k] = inside ? 1.0f : 0.0f;
        outX[k] = x0;
        outY[k] = y0;
        outFx[k] = px - static_cast<float>(x0);
        outFy[k] = py - static_cast<float>(y0);
    }
}

/// Weight of the i-th of four samples of a cubic Catmull-Rom spline, or of linear interpolation, at fraction t between
/// the second and the third.
template <bool CatmullRom, int I>
inline float splineWeight(float t) {
    if constexpr (!CatmullRom) return I == 1 ? 1.0f - t : I == 2 ? t : 0.0f;
    if constexpr (I == 0) return t * (-0.5f + t * (1.0f - 0.5f * t));
    if constexpr (I == 1) return 1.0f + t * t * (-2.5f + 1.5f * t);
    if constexpr (I == 2) return t * (0.5f + t * (2.0f - 1.5f * t));
    return t * t * (-0.5f + 0.5f * t);
}

inline int32_t clamped(int32_t v, int32_t most) {
    v = v < 0 ? 0 : v;
    return v > most ? most : v;
}

/// Adds the J-th of four lines of the history for pixels [begin, end) of the block. InARow: their taps follow each
/// other, all inside the image's columns.
template <bool CatmullRom, int J, bool InARow>
void fetchLine(const TaaRow& row, int begin, int end, Block& block) {
    const int32_t width = row.width, right = row.width - 1, bottom = row.height - 1;
    const int32_t base = clamped(block.y0[begin] + J - 1, bottom) * width + block.x0[begin] - begin;
    for (int c = 0; c < 3; ++c) {
        const float* __restrict from = row.previous[c];
        float* __restrict sum = block.history[c];
        for (int k = begin; k < end; ++k) {
            const int32_t line = clamped(block.y0[k] + J - 1, bottom) * width, x0 = block.x0[k];
            const auto tap = [&](int i) {
                return InARow ? from[base + k + i - 1] : from[line + clamped(x0 + i - 1, right)];
            };
            const float fx = block.fx[k];
            float along = splineWeight<CatmullRom, 1>(fx) * tap(1) + splineWeight<CatmullRom, 2>(fx) * tap(2);
            if constexpr (CatmullRom)
                along += splineWeight<CatmullRom, 0>(fx) * tap(0) + splineWeight<CatmullRom, 3>(fx) * tap(3);
            sum[k] += splineWeight<CatmullRom, J>(block.fy[k]) * along;
        }
    }
}

template <bool CatmullRom, bool InARow>
void fetchLines(const TaaRow& row, int begin, int end, Block& block) {
    if constexpr (CatmullRom) fetchLine<CatmullRom, 0, InARow>(row, begin, end, block);
    fetchLine<CatmullRom, 1, InARow>(row, begin, end, block);
    fetchLine<CatmullRom, 2, InARow>(row, begin, end, block);
    if constexpr (CatmullRom) fetchLine<CatmullRom, 3, InARow>(row, begin, end, block);
}

void fetch(const TaaRow& row, int count, Block& block) {
    float offset = 0;
    for (int k = 0; k < count; ++k) offset += block.fx[k] + block.fy[k];
    if (offset == 0.0f) {  // nothing moved by a part of a pixel
        for (int c = 0; c < 3; ++c) {
            const float* __restrict from = row.previous[c];
            float* __restrict to = block.history[c];
            for (int k = 0; k < count; ++k) to[k] = from[block.y0[k] * row.width + block.x0[k]];
        }
        return;
    }
    for (int c = 0; c < 3; ++c)
        for (int k = 0; k < count; ++k) block.history[c][k] = 0;
    const auto follows = [&](int k) { return block.x0[k] == block.x0[k - 1] + 1 && block.y0[k] == block.y0[k - 1]; };
    forIndexRuns(0, count, follows, [&](int begin, int end, bool inARow) {
        const bool inside = block.x0[begin] > 0 && block.x0[end - 1] + 2 < row.width;
        if (row.catmullRom)
            inARow&& inside ? fetchLines<true, true>(row, begin, end, block)
                            : fetchLines<true, false>(row, begin, end, block);
        else
            inARow&& inside ? fetchLines<false, true>(row, begin, end, block)
                            : fetchLines<false, false>(row, begin, end, block);
    });
}

/// Pulls the history towards the neighbourhood's mean until it lies within gamma standard deviations of it.
void clipToNeighbourhood(const TaaRow& row, const Rows& rows, const Range& range, Block& block) {
    float* __restrict excess = block.excess + range.at;
    for (int k = 0; k < range.count; ++k) excess[k] = 1.0f;
    for (int c = 0; c < 3; ++c) {
        const float* __restrict above = row.compressed[c] + rows.above + range.first;
        const float* __restrict here = row.compressed[c] + rows.here + range.first;
        const float* __restrict below = row.compressed[c] + rows.below + range.first;
        float* __restrict mean = block.mean[c] + range.at;
        const float* __restrict history = block.history[c] + range.at;
        const int l = range.left, r = range.right;
        for (int k = 0; k < range.count; ++k) {
            const float v[9] = {above[k + l], above[k],     above[k + r], here[k + l], here[k],
                                here[k + r],  below[k + l], below[k],     below[k + r]};
            float sum = 0, squares = 0;
            for (int i = 0; i < 9; ++i) sum += v[i];
            sum *= 1.0f / 9;
            for (int i = 0; i < 9; ++i) squares += (v[i] - sum) * (v[i] - sum);
            mean[k] = sum;
            const float most = std::fabs(history[k] - sum) / (row.gamma * std::sqrt(squares * (1.0f / 9)) + 1e-6f);
            excess[k] = most > excess[k] ? most : excess[k];
        }
    }
    for (int c = 0; c < 3; ++c) {
        const float* __restrict mean = block.mean[c] + range.at;
        float* __restrict history = block.history[c] + range.at;
        for (int k = 0; k < range.count; ++k) history[k] = mean[k] + (history[k] - mean[k]) / excess[k];
    }
}

void blend(const TaaRow& row, const Rows& rows, int first, int count, const Block& block, bool hasHistory) {
    float* next[3];
    const float* now[3];
    const float linear = 1.0f / row.exposure;
    for (int c = 0; c < 3; ++c) {
        next[c] = row.next[c] + first;
        now[c] = row.compressed[c] + rows.here + first;
        float* __restrict to = next[c];
        const float* __restrict from = now[c];
        const float* __restrict history = block.history[c];
        for (int k = 0; k < count; ++k) {
            const float past = hasHistory && block.inside[k] > 0.0f ? history[k] : from[k];
            to[k] = past + row.alpha * (from[k] - past);
        }
    }
    for (int k = 0; k < count; ++k) {
        const float y = next[0][k], co = next[1][k], cg = next[2][k], rest = 1.0f - y;
        const float scale = linear / (rest > kLeastRest ? rest : kLeastRest), base = y - cg;
        const float r = (base + co) * scale, g = (y + cg) * scale, b = (base - co) * scale;
        row.out[0][first + k] = r > 0.0f ? r : 0.0f;
        row.out[1][first + k] = g > 0.0f ? g : 0.0f;
        row.out[2][first + k] = b > 0.0f ? b : 0.0f;
    }
}

void resolveRow(const TaaRow& row) {
    Block block;
    const std::ptrdiff_t width = row.width, here = row.y * width;
    const Rows rows{row.y > 0 ? here - width : here, here, row.y + 1 < row.height ? here + width : here};
    const bool hasHistory = row.previous[0] != nullptr;
    for (int first = 0; first < row.width; first += kBlock) {
        const int count = first + kBlock < row.width ? kBlock : row.width - first;
        if (hasHistory) {
            forRanges(row, first, count, [&](const Range& range) { findPoints(row, rows, range, block); });
            fetch(row, count, block);
            if (row.clip)
                forRanges(row, first, count, [&](const Range& range) { clipToNeighbourhood(row, rows, range, block); });
        }
        blend(row, rows, first, count, block, hasHistory);
    }
}

}  // namespace

const TaaKernels& taaTable() {
    static const TaaKernels table{compressRow, resolveRow};
    return table;
}

}  // namespace lumi::LUMI_ISA
