#include "filter/cross_bilateral_kernels.h"

#include <cmath>

#include "filter/atrous_taps.h"
#include "math/kernel_math.h"

namespace lumi::LUMI_ISA {
namespace {

constexpr int kPixels = 128;  ///< of a block

/// Sums of one filter over a block: weights, weighted differences of colour from the pixel's own, and their squares.
struct Sums {
    alignas(64) float weight[kPixels], shift[3][kPixels], square[3][kPixels];
};

inline float squaredDistance(const float* const plane[3], std::ptrdiff_t p, std::ptrdiff_t q) {
    const float x = plane[0][p] - plane[0][q], y = plane[1][p] - plane[1][q], z = plane[2][p] - plane[2][q];
    return x * x + y * y + z * z;
}

/// log2 of the weight of the tap but for its distance in space.
inline void featureExponents(const CrossBilateralRow& row, const TapSpan& tap, int first, float* __restrict exponent) {
    const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(row.y) * row.width;
    const float* const rgb[3] = {row.rgb[0] + at, row.rgb[1] + at, row.rgb[2] + at};
    const float* const normal[3] = {row.normal[0] + at, row.normal[1] + at, row.normal[2] + at};
    const float* const albedo[3] = {row.albedo[0] + at, row.albedo[1] + at, row.albedo[2] + at};
    const float* __restrict z = row.inverseDepth + at;
    const float* __restrict scale = row.colourScale;
    for (int x = tap.begin; x < tap.end; ++x) {
        const std::ptrdiff_t q = x + tap.offset;
        const float relative = (z[q] - z[x]) / (z[x] + 1e-30f);
        const float e = -(scale[x] * squaredDistance(rgb, x, q) + row.normalScale * squaredDistance(normal, x, q) +
                          row.albedoScale * squaredDistance(albedo, x, q) + row.depthScale * (relative * relative));
        exponent[x - first] = z[x] > 0.0f && z[q] > 0.0f ? e : -1e30f;
    }
}

inline void addTap(const CrossBilateralRow& row, const TapSpan& tap, int first, float spatial,
                   const float* __restrict exponent, Sums& sums) {
    const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(row.y) * row.width;
    const float* __restrict r = row.rgb[0] + at;
    const float* __restrict g = row.rgb[1] + at;
    const float* __restrict b = row.rgb[2] + at;
    for (int x = tap.begin; x < tap.end; ++x) {
        const int k = x - first;
        const std::ptrdiff_t q = x + tap.offset;
        const float w = kernelExp2(exponent[k] - spatial);
        const float dr = r[q] - r[x], dg = g[q] - g[x], db = b[q] - b[x];
        sums.weight[k] += w;
        sums.shift[0][k] += w * dr;
        sums.shift[1][k] += w * dg;
        sums.shift[2][k] += w * db;
        sums.square[0][k] += w * (dr * dr);
        sums.square[1][k] += w * (dg * dg);
        sums.square[2][k] += w * (db * db);
    }
}

/// F(c) = sum w c / sum w, and SURE(F) = (F - c)^2 + 2 sigma^2 dF/dc - sigma^2 with
/// dF/dc = 1/sum w + (F(c^2) - F(c)^2) / sigma_r^2 [Li12, eqs. 3 and 10].
inline void finish(const CrossBilateralRow& row, int f, int first, int last, const Sums& sums) {
    const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(row.y) * row.width;
    constexpr float kPerScale = 2.0f / 1.44269504f;  // 1/sigma_r^2 of log2(e) / (2 sigma_r^2)
    for (int x = first; x < last; ++x) {
        const int k = x - first;
        const float inverse = 1.0f / sums.weight[k], variance = row.colourVariance[x];
        float error = 0;
        for (int c = 0; c < 3; ++c) {
            const float shift = sums.shift[c][k] * inverse, spread = sums.square[c][k] * inverse - shift * shift;
            const float slope = inverse + (spread > 0.0f ? spread : 0.0f) * row.colourScale[x] * kPerScale;
            row.out[f][c][x] = row.rgb[c][at + x] + shift;
            error += shift * shift + (2.0f * slope - 1.0f) * variance;
        }
        row.error[f][x] = error * (1.0f / 3);
    }
}

void filterRow(const CrossBilateralRow& row) {
    Sums sums[CrossBilateralRow::kMost];
    alignas(64) float exponent[kPixels];
    const int reach = row.radius[row.filters - 1];
    for (int first = 0; first < row.width; first += kPixels) {
        const int last = first + kPixels < row.width ? first + kPixels : row.width;
        for (int f = 0; f < row.filters; ++f)
            for (int x = first; x < last; ++x) {
                sums[f].weight[x - first] = 1;
                for (int c = 0; c < 3; ++c) sums[f].shift[c][x - first] = sums[f].square[c][x - first] = 0;
            }
        for (int j = -reach; j <= reach; ++j)
            for (int i = -reach; i <= reach; ++i) {
                if (i == 0 && j == 0) continue;
                const TapSpan tap = tapSpan(row.width, row.height, row.y, i, j, first, last);
                if (tap.begin >= tap.end) continue;
                featureExponents(row, tap, first, exponent);
                for (int f = 0; f < row.filters; ++f)
                    if (i >= -row.radius[f] && i <= row.radius[f] && j >= -row.radius[f] && j <= row.radius[f])
                        addTap(row, tap, first, row.spatialScale[f] * static_cast<float>(i * i + j * j), exponent,
                               sums[f]);
            }
        for (int f = 0; f < row.filters; ++f) finish(row, f, first, last, sums[f]);
    }
}

}  // namespace

const CrossBilateralKernels& crossBilateralTable() {
    static const CrossBilateralKernels table{filterRow};
    return table;
}

}  // namespace lumi::LUMI_ISA
