#include "filter/atrous_kernels.h"

#include <cmath>

#include "filter/atrous_taps.h"
#include "math/kernel_math.h"

namespace lumi::LUMI_ISA {
const AtrousKernels& atrousTable();
namespace {

constexpr float kLog2E = 1.44269504f;

/// log2(x) for x in (0, 1.4], absolute error below 7e-7, without kernelLog2's division; tiny x gives about -126.
inline float log2OfCosine(float x) {
    x = x > 1.17549435e-38f ? x : 1.17549435e-38f;
    const int32_t bits = floatToBits(x);
    const int32_t exponent = (bits - 0x3f3504f3) >> 23;  // the mantissa in [sqrt(1/2), sqrt(2)): 0x3f3504f3 is sqrt(1/2)
    const float t = bitsToFloat(bits - (exponent << 23)) - 1.0f;
    // Interpolant of log2(1 + t)/t in the Chebyshev nodes, degree 6.
    float p = 0.16818659f;
    p = p * t - 0.26796387f;
    p = p * t + 0.29611956f;
    p = p * t - 0.35952446f;
    p = p * t + 0.48061313f;
    p = p * t - 0.72136018f;
    p = p * t + 1.4426965f;
    return p * t + static_cast<float>(exponent);
}

/// log2 of w_z w_n (eqs. 3 and 4) of the tap for pixels [tap.begin, tap.end), into `exponent[x - first]`.
inline void geometryExponents(const AtrousRow& row, const TapSpan& tap, int first, float* __restrict exponent) {
    const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(row.y) * row.width;
    const float* __restrict z = row.inverseDepth + at;
    const float* __restrict sx = row.slopeX + at;
    const float* __restrict sy = row.slopeY + at;
    const float* __restrict nx = row.normal[0] + at;
    const float* __restrict ny = row.normal[1] + at;
    const float* __restrict nz = row.normal[2] + at;
    const float* __restrict zq = z + tap.offset;
    const float* __restrict nxq = nx + tap.offset;
    const float* __restrict nyq = ny + tap.offset;
    const float* __restrict nzq = nz + tap.offset;
    const float plane = row.edges.planeDistance ? 1.0f : 0.0f, sigmaZ = row.edges.sigmaDepth, sigmaN = row.edges.sigmaNormal;
    for (int x = tap.begin; x < tap.end; ++x) {
        const float rise = sx[x] * tap.dx + sy[x] * tap.dy;
        const float distance = std::fabs(zq[x] - z[x] - plane * rise);
        const float allowed = sigmaZ * std::fabs(rise) + kDepthEpsilon * z[x] + 1e-30f;
        const float cosine = nx[x] * nxq[x] + ny[x] * nyq[x] + nz[x] * nzq[x];
        exponent[x - first] = sigmaN * log2OfCosine(cosine) - kLog2E * distance / allowed;
    }
}

struct Sums {
    alignas(64) float weight[kBlock], r[kBlock], g[kBlock], b[kBlock], variance[kBlock];
};

/// Adds a tap to a component's sums: w = h w_z w_n w_l.
inline void addTap(const AtrousRow& row, int c, const TapSpan& tap, int first, float h, const float* __restrict exponent,
                   Sums& sums) {
    const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(row.y) * row.width;
    const IlluminationView& in = row.in[c];
    const float* __restrict l = in.luminance + at;
    const float* __restrict lq = l + tap.offset;
    const float* __restrict rq = in.rgb[0] + at + tap.offset;
    const float* __restrict gq = in.rgb[1] + at + tap.offset;
    const float* __restrict bq = in.rgb[2] + at + tap.offset;
    const float* __restrict vq = in.sampleVariance + at + tap.offset;
    const float* __restrict scale = row.luminanceScale[c];
    float* __restrict weight = sums.weight;
    float* __restrict r = sums.r;
    float* __restrict g = sums.g;
    float* __restrict b = sums.b;
    float* __restrict v = sums.variance;
    for (int x = tap.begin; x < tap.end; ++x) {
        const int k = x - first;
        const float w = h * kernelExp2(exponent[k] - std::fabs(l[x] - lq[x]) * scale[x]);
        weight[k] += w;
        r[k] += w * rq[x];
        g[k] += w * gq[x];
        b[k] += w * bq[x];
        v[k] += w * w * vq[x];
    }
}

inline void startSums(const AtrousRow& row, int c, int first, int last, Sums& sums) {
    constexpr float h = kSpline[2] * kSpline[2];  // the pixel itself: w(p, p) = 1
    const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(row.y) * row.width;
    const IlluminationView& in = row.in[c];
    for (int x = first; x < last; ++x) {
        const int k = x - first;
        sums.weight[k] = h;
        sums.r[k] = h * in.rgb[0][at + x];
        sums.g[k] = h * in.rgb[1][at + x];
        sums.b[k] = h * in.rgb[2][at + x];
        sums.variance[k] = h * h * in.sampleVariance[at + x];
    }
}

inline void finishSums(const AtrousRow& row, int c, int first, int last, const Sums& sums) {
    const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(row.y) * row.width;
    const IlluminationOutput& out = row.out[c];
    float* __restrict r = out.rgb[0] + at;
    float* __restrict g = out.rgb[1] + at;
    float* __restrict b = out.rgb[2] + at;
    float* __restrict l = out.luminance + at;
    float* __restrict v = out.sampleVariance + at;
    for (int x = first; x < last; ++x) {
        const int k = x - first;
        const float inverse = 1.0f / sums.weight[k];
        r[x] = sums.r[k] * inverse;
        g[x] = sums.g[k] * inverse;
        b[x] = sums.b[k] * inverse;
        v[x] = sums.variance[k] * inverse * inverse;
        l[x] = 0.2126f * r[x] + 0.7152f * g[x] + 0.0722f * b[x];
    }
}

void filterRow(const AtrousRow& row) {
    Sums sums[AtrousRow::kMaxComponents];
    alignas(64) float exponent[kBlock];
    for (int first = 0; first < row.width; first += kBlock) {
        const int last = first + kBlock < row.width ? first + kBlock : row.width;
        for (int c = 0; c < row.components; ++c) startSums(row, c, first, last, sums[c]);
        for (int j = -2; j <= 2; ++j)
            for (int i = -2; i <= 2; ++i) {
                if (i == 0 && j == 0) continue;
                const TapSpan tap = tapSpan(row.width, row.height, row.y, i * row.step, j * row.step, first, last);
                if (tap.begin >= tap.end) continue;
                geometryExponents(row, tap, first, exponent);
                const float h = kSpline[i + 2] * kSpline[j + 2];
                for (int c = 0; c < row.components; ++c) addTap(row, c, tap, first, h, exponent, sums[c]);
            }
        for (int c = 0; c < row.components; ++c) finishSums(row, c, first, last, sums[c]);
    }
}

void luminanceScaleRow(const float* variance, int width, int height, int y, float sigmaLuminance, bool prefilter,
                       float* __restrict scale) {
    const float* __restrict at = variance + static_cast<std::ptrdiff_t>(y) * width;
    if (!prefilter) {
        for (int x = 0; x < width; ++x) scale[x] = at[x];
    } else {
        const float* __restrict above = at - (y > 0 ? width : 0);
        const float* __restrict below = at + (y + 1 < height ? width : 0);
        const auto column = [&](int x) { return above[x] + 2.0f * at[x] + below[x]; };
        for (int x = 1; x + 1 < width; ++x) scale[x] = (column(x - 1) + 2.0f * column(x) + column(x + 1)) * (1.0f / 16);
        const int end = width - 1;
        scale[0] = (3.0f * column(0) + column(end < 1 ? end : 1)) * (1.0f / 16);
        if (end > 0) scale[end] = (column(end - 1) + 3.0f * column(end)) * (1.0f / 16);
    }
    for (int x = 0; x < width; ++x) scale[x] = kLog2E / (sigmaLuminance * std::sqrt(scale[x] + kVarianceEpsilon) + 1e-30f);
}

void luminanceRow(const float* const rgb[3], float* __restrict out, int width) {
    const float* __restrict r = rgb[0];
    const float* __restrict g = rgb[1];
    const float* __restrict b = rgb[2];
    for (int x = 0; x < width; ++x) out[x] = 0.2126f * r[x] + 0.7152f * g[x] + 0.0722f * b[x];
}

void spatialVarianceRow(const AtrousRow& row, const float* historyLength, float minLength, const float* mean,
                        const float* centred, float* __restrict variance) {
    constexpr int kRadius = 3, kNarrow = 64;
    alignas(64) float exponent[kNarrow], weight[kNarrow], sum[kNarrow], squares[kNarrow];
    const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(row.y) * row.width;
    for (int first = 0; first < row.width; first += kNarrow) {
        const int last = first + kNarrow < row.width ? first + kNarrow : row.width;
        int pixels = 0;
        for (int x = first; x < last; ++x) pixels += historyLength[at + x] < minLength ? 1 : 0;
        if (pixels == 0) continue;
        for (int x = first; x < last; ++x) {
            weight[x - first] = 1;
            sum[x - first] = 0;
            squares[x - first] = centred[at + x];
        }
        const float* __restrict m = mean + at;
        for (int j = -kRadius; j <= kRadius; ++j)
            for (int i = -kRadius; i <= kRadius; ++i) {
                if (i == 0 && j == 0) continue;
                const TapSpan tap = tapSpan(row.width, row.height, row.y, i * row.step, j * row.step, first, last);
                if (tap.begin >= tap.end) continue;
                geometryExponents(row, tap, first, exponent);
                const float* __restrict mq = m + tap.offset;
                const float* __restrict vq = centred + at + tap.offset;
                for (int x = tap.begin; x < tap.end; ++x) {
                    const float w = kernelExp2(exponent[x - first]), difference = mq[x] - m[x];
                    weight[x - first] += w;
                    sum[x - first] += w * difference;
                    squares[x - first] += w * (vq[x] + difference * difference);
                }
            }
        for (int x = first; x < last; ++x) {
            const float shift = sum[x - first] / weight[x - first];
            const float estimate = squares[x - first] / weight[x - first] - shift * shift;
            variance[x] = historyLength[at + x] < minLength ? (estimate > 0 ? estimate : 0.0f) : variance[x];
        }
    }
}

}  // namespace

const AtrousKernels& atrousTable() {
    static const AtrousKernels table{filterRow, luminanceScaleRow, luminanceRow, spatialVarianceRow};
    return table;
}

}  // namespace lumi::LUMI_ISA
