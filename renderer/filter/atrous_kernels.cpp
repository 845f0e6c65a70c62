#include "filter/atrous_kernels.h"

#include <cmath>

#include "filter/atrous_taps.h"
#include "math/kernel_math.h"

namespace lumi::LUMI_ISA {
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

/// 2^x for x in [-126, 0], below that 2^-126; relative error below 4e-6, which weights do not feel. NaN gives 2^-126.
inline float weightExp2(float x) {
    x = x > -126.0f ? x : -126.0f;
    const float shifted = x + 12582912.0f;  // 1.5 * 2^23: the mantissa's low bits become the nearest integer
    const float f = x - (shifted - 12582912.0f);
    float p = 0.00966636852f;  // interpolant of 2^f in the Chebyshev nodes of [-0.5, 0.5], degree 4
    p = p * f + 0.0559219758f;
    p = p * f + 0.24022349f;
    p = p * f + 0.693121045f;
    p = p * f + 1.0f;
    return bitsToFloat(static_cast<int32_t>(static_cast<uint32_t>(floatToBits(p)) + (static_cast<uint32_t>(floatToBits(shifted)) << 23)));
}

/// cosine^sigma. With Squarings >= 0 sigma is 2^Squarings.
template <int Squarings>
inline float normalWeight(float cosine, float sigma) {
    if constexpr (Squarings < 0) return weightExp2(sigma * log2OfCosine(cosine < 1.0f ? cosine : 1.0f));
    float power = cosine > 0.0f ? cosine : 0.0f;
    for (int i = 0; i < Squarings; ++i) power *= power;
    return power;
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

/// Sums of the components, over a block of pixels.
struct Sums {
    alignas(64) float weight[kBlock], r[kBlock], g[kBlock], b[kBlock], variance[kBlock];
};

/// One component as the loops below read and write it: pointers at the block's first pixel.
struct ComponentTap {
    const float* __restrict luminance;
    const float* __restrict r;
    const float* __restrict g;
    const float* __restrict b;
    const float* __restrict variance;
    const float* __restrict scale;
};

inline ComponentTap componentTap(const AtrousRow& row, int c, std::ptrdiff_t at, int first) {
    const IlluminationView& in = row.in[c];
    return {in.luminance + at, in.rgb[0] + at, in.rgb[1] + at, in.rgb[2] + at, in.sampleVariance + at, row.luminanceScale[c] + first};
}

/// w = h w_z w_n w_l of neighbour k + offset, `scaled` being h w_z w_n's parts, onto the sums.
inline void addNeighbour(const ComponentTap& in, std::ptrdiff_t k, std::ptrdiff_t offset, float depthExponent, float hn, float& weight,
                         float& r, float& g, float& b, float& v) {
    const std::ptrdiff_t q = k + offset;
    const float w = hn * weightExp2(depthExponent - std::fabs(in.luminance[k] - in.luminance[q]) * in.scale[k]);
    weight += w;
    r += w * in.r[q];
    g += w * in.g[q];
    b += w * in.b[q];
    v += w * w * in.variance[q];
}

/// Adds the taps at +offset and, with Both, at -offset, which have eq. 3's denominator in common, for pixels
/// [begin, end) of the row.
template <int Components, int Squarings, bool Both>
void addTaps(const AtrousRow& row, const TapSpan& tap, float h, int first, int begin, int end, Sums* sums) {
    const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(row.y) * row.width + first, offset = tap.offset;
    const float* __restrict z = row.inverseDepth + at;
    const float* __restrict sx = row.slopeX + at;
    const float* __restrict sy = row.slopeY + at;
    const float* __restrict nx = row.normal[0] + at;
    const float* __restrict ny = row.normal[1] + at;
    const float* __restrict nz = row.normal[2] + at;
    const ComponentTap in0 = componentTap(row, 0, at, first), in1 = componentTap(row, Components - 1, at, first);
    Sums& s0 = sums[0];
    Sums& s1 = sums[Components - 1];
    const float plane = row.edges.planeDistance ? 1.0f : 0.0f, sigmaZ = row.edges.sigmaDepth, sigmaN = row.edges.sigmaNormal;
    const float dx = tap.dx, dy = tap.dy;
#pragma GCC ivdep
    for (int k = begin - first; k < end - first; ++k) {
        const float rise = sx[k] * dx + sy[k] * dy, planeRise = plane * rise;
        const float perDistance = -kLog2E / (sigmaZ * std::fabs(rise) + kDepthEpsilon * z[k] + 1e-30f);
        const std::ptrdiff_t q = k + offset, m = k - offset;
        const float e = std::fabs(z[q] - z[k] - planeRise) * perDistance;
        const float n = h * normalWeight<Squarings>(nx[k] * nx[q] + ny[k] * ny[q] + nz[k] * nz[q], sigmaN);
        float weight = s0.weight[k], r = s0.r[k], g = s0.g[k], b = s0.b[k], v = s0.variance[k];
        addNeighbour(in0, k, offset, e, n, weight, r, g, b, v);
        float e2 = 0, n2 = 0;
        if constexpr (Both) {
            e2 = std::fabs(z[m] - z[k] + planeRise) * perDistance;
            n2 = h * normalWeight<Squarings>(nx[k] * nx[m] + ny[k] * ny[m] + nz[k] * nz[m], sigmaN);
            addNeighbour(in0, k, -offset, e2, n2, weight, r, g, b, v);
        }
        s0.weight[k] = weight, s0.r[k] = r, s0.g[k] = g, s0.b[k] = b, s0.variance[k] = v;
        if constexpr (Components == 2) {
            weight = s1.weight[k], r = s1.r[k], g = s1.g[k], b = s1.b[k], v = s1.variance[k];
            addNeighbour(in1, k, offset, e, n, weight, r, g, b, v);
            if constexpr (Both) addNeighbour(in1, k, -offset, e2, n2, weight, r, g, b, v);
            s1.weight[k] = weight, s1.r[k] = r, s1.g[k] = g, s1.b[k] = b, s1.variance[k] = v;
        }
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

/// The taps at (dx, dy) and (-dx, -dy) of pixels [first, last).
template <int Components, int Squarings>
void addPair(const AtrousRow& row, int dx, int dy, float h, int first, int last, Sums* sums) {
    const TapSpan plus = tapSpan(row.width, row.height, row.y, dx, dy, first, last);
    const TapSpan minus = tapSpan(row.width, row.height, row.y, -dx, -dy, first, last);
    const int begin = plus.begin > minus.begin ? plus.begin : minus.begin, end = plus.end < minus.end ? plus.end : minus.end;
    const auto one = [&](const TapSpan& tap, int from, int to) {
        if (from < to) addTaps<Components, Squarings, false>(row, tap, h, first, from, to, sums);
    };
    if (begin >= end) {
        one(plus, plus.begin, plus.end);
        one(minus, minus.begin, minus.end);
        return;
    }
    addTaps<Components, Squarings, true>(row, plus, h, first, begin, end, sums);
    one(plus, plus.begin, begin < plus.end ? begin : plus.end);
    one(plus, end > plus.begin ? end : plus.begin, plus.end);
    one(minus, minus.begin, begin < minus.end ? begin : minus.end);
    one(minus, end > minus.begin ? end : minus.begin, minus.end);
}

template <int Components, int Squarings>
void filterBlocks(const AtrousRow& row) {
    Sums sums[Components];
    for (int first = 0; first < row.width; first += kBlock) {
        const int last = first + kBlock < row.width ? first + kBlock : row.width;
        for (int c = 0; c < Components; ++c) startSums(row, c, first, last, sums[c]);
        for (int j = 0; j <= 2; ++j)
            for (int i = j > 0 ? -2 : 1; i <= 2; ++i)
                addPair<Components, Squarings>(row, i * row.step, j * row.step, kSpline[i + 2] * kSpline[j + 2], first, last, sums);
        for (int c = 0; c < Components; ++c) finishSums(row, c, first, last, sums[c]);
    }
}

void filterRow(const AtrousRow& row) {
    const bool squared = row.edges.sigmaNormal == 128.0f;  // 2^7, the paper's
    if (row.components == 1) return squared ? filterBlocks<1, 7>(row) : filterBlocks<1, -1>(row);
    squared ? filterBlocks<2, 7>(row) : filterBlocks<2, -1>(row);
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
        if (pixels == 0) {
            for (int x = first; x < last; ++x) variance[x] = centred[at + x];
            continue;
        }
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
            variance[x] = historyLength[at + x] < minLength ? (estimate > 0 ? estimate : 0.0f) : centred[at + x];
        }
    }
}

}  // namespace

const AtrousKernels& atrousTable() {
    static const AtrousKernels table{filterRow, luminanceScaleRow, luminanceRow, spatialVarianceRow};
    return table;
}

}  // namespace lumi::LUMI_ISA
