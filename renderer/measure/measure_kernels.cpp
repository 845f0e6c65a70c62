#include "measure/measure_kernels.h"

#include "math/kernel_math.h"

namespace lumi::LUMI_ISA {
namespace {

/// Sums stay in registers for a chunk of pixels while the taps pass over it.
constexpr int kChunk = 64;

void convolveRow(const float* in, const float* weights, int taps, float* out, int width) {
    int x = 0;
    for (; x + kChunk <= width; x += kChunk) {
        float sums[kChunk] = {};
        for (int k = 0; k < taps; ++k) {
            const float weight = weights[k];
            const float* shifted = in + x + k;
            for (int i = 0; i < kChunk; ++i) sums[i] += weight * shifted[i];
        }
        for (int i = 0; i < kChunk; ++i) out[x + i] = sums[i];
    }
    for (; x < width; ++x) {
        float sum = 0;
        for (int k = 0; k < taps; ++k) sum += weights[k] * in[x + k];
        out[x] = sum;
    }
}

void convolveColumn(const float* const* rows, const float* weights, int taps, float* out, int width) {
    int x = 0;
    for (; x + kChunk <= width; x += kChunk) {
        float sums[kChunk] = {};
        for (int k = 0; k < taps; ++k) {
            const float weight = weights[k];
            const float* row = rows[k] + x;
            for (int i = 0; i < kChunk; ++i) sums[i] += weight * row[i];
        }
        for (int i = 0; i < kChunk; ++i) out[x + i] = sums[i];
    }
    for (; x < width; ++x) {
        float sum = 0;
        for (int k = 0; k < taps; ++k) sum += weights[k] * rows[k][x];
        out[x] = sum;
    }
}

inline float clamp01(float x) { return x > 0.0f ? (x < 1.0f ? x : 1.0f) : 0.0f; }
inline float absolute(float x) { return x < 0 ? -x : x; }
inline float squareRoot(float x) { return __builtin_sqrtf(x); }

// sRGB to XYZ [IEC 61966-2-1], and the white point that belongs to it.
constexpr float kWhiteX = 0.950428545f, kWhiteZ = 1.088900371f;

inline float labCurve(float t) {
    const float root = kernelPow(t, 1.0f / 3.0f);
    return t > 0.008856452f ? root : 7.787037037f * t + 0.137931034f;
}

/// Filtered YCxCz to Hunt-adjusted CIELab.
inline void huntLab(float yy, float cx, float cz, float& lightness, float& a, float& b) {
    const float y = (yy + 16.0f) / 116.0f;
    float xyzX = (y + cx / 500.0f) * kWhiteX;
    float xyzY = y;
    float xyzZ = (y - cz / 200.0f) * kWhiteZ;
    const float red = clamp01(3.241003275f * xyzX - 1.537398934f * xyzY - 0.498615861f * xyzZ);
    const float green = clamp01(-0.969224334f * xyzX + 1.875930071f * xyzY + 0.041554224f * xyzZ);
    const float blue = clamp01(0.055639423f * xyzX - 0.204011202f * xyzY + 1.057148933f * xyzZ);
    xyzX = 0.4123865f * red + 0.3575915f * green + 0.1804505f * blue;
    xyzY = 0.2126368f * red + 0.7151830f * green + 0.0721802f * blue;
    xyzZ = 0.0193306f * red + 0.1191972f * green + 0.9503726f * blue;
    const float fx = labCurve(xyzX / kWhiteX), fy = labCurve(xyzY), fz = labCurve(xyzZ / kWhiteZ);
    lightness = 116.0f * fy - 16.0f;
    a = 0.01f * lightness * (500.0f * (fx - fy));
    b = 0.01f * lightness * (200.0f * (fy - fz));
}

void flipColour(const float* const test[3], const float* const reference[3], const float remap[3], float* out,
                int width) {
    const float *t0 = test[0], *t1 = test[1], *t2 = test[2];
    const float *r0 = reference[0], *r1 = reference[1], *r2 = reference[2];
    const float knee = remap[0], share = remap[1], limit = remap[2];
    for (int x = 0; x < width; ++x) {
        float lt, at, bt, lr, ar, br;
        huntLab(t0[x], t1[x], t2[x], lt, at, bt);
        huntLab(r0[x], r1[x], r2[x], lr, ar, br);
        const float distance = absolute(lt - lr) + squareRoot((at - ar) * (at - ar) + (bt - br) * (bt - br));
        const float powered = distance > 0 ? kernelPow(distance, 0.7f) : 0.0f;
        const float low = powered * (share / knee);
        const float high = share + (powered - knee) / (limit - knee) * (1.0f - share);
        out[x] = powered < knee ? low : high;
    }
}

void flipCombine(const float* const test[4], const float* const reference[4], float* colour, int width) {
    const float *tex = test[0], *tey = test[1], *tpx = test[2], *tpy = test[3];
    const float *rex = reference[0], *rey = reference[1], *rpx = reference[2], *rpy = reference[3];
    for (int x = 0; x < width; ++x) {
        const float edges =
            absolute(squareRoot(tex[x] * tex[x] + tey[x] * tey[x]) - squareRoot(rex[x] * rex[x] + rey[x] * rey[x]));
        const float points =
            absolute(squareRoot(tpx[x] * tpx[x] + tpy[x] * tpy[x]) - squareRoot(rpx[x] * rpx[x] + rpy[x] * rpy[x]));
        const float feature = squareRoot(0.70710678f * (edges > points ? edges : points));
        const float powered = kernelPow(colour[x], 1.0f - feature);
        colour[x] = colour[x] > 0 ? (powered < 1.0f ? powered : 1.0f) : 0.0f;
    }
}

void yCxCzFromLinear(const float* const rgb[3], float* const out[3], int width) {
    const float *red = rgb[0], *green = rgb[1], *blue = rgb[2];
    float *o0 = out[0], *o1 = out[1], *o2 = out[2];
    for (int x = 0; x < width; ++x) {
        const float xx = (0.4123865f * red[x] + 0.3575915f * green[x] + 0.1804505f * blue[x]) / kWhiteX;
        const float yy = 0.2126368f * red[x] + 0.7151830f * green[x] + 0.0721802f * blue[x];
        const float zz = (0.0193306f * red[x] + 0.1191972f * green[x] + 0.9503726f * blue[x]) / kWhiteZ;
        o0[x] = 116.0f * yy - 16.0f;
        o1[x] = 500.0f * (xx - yy);
        o2[x] = 200.0f * (yy - zz);
    }
}

void encodeLdr(const float* in, float exposureFactor, float* out, int width) {
    for (int x = 0; x < width; ++x) {
        const float v = clamp01(in[x] * exposureFactor);
        const float curve = 1.055f * kernelPow(v, 1.0f / 2.4f) - 0.055f;
        out[x] = v <= 0.0031308f ? 12.92f * v : curve;
    }
}

void decodeSrgb(const float* in, float* out, int width) {
    for (int x = 0; x < width; ++x) {
        const float v = in[x];
        const float curve = kernelPow((v + 0.055f) / 1.055f, 2.4f);
        out[x] = v <= 0.04045f ? v / 12.92f : curve;
    }
}

void toneRational(const float* in, float exposureFactor, const float c[6], float* out, int width) {
    for (int x = 0; x < width; ++x) {
        const float v = in[x] * exposureFactor;
        out[x] = clamp01((c[0] * v * v + c[1] * v + c[2]) / (c[3] * v * v + c[4] * v + c[5]));
    }
}

/// 11 symmetric taps for a chunk of columns: tap k reads at(k), weights fold around the middle one.
template <class At>
inline void foldedTaps(const At& at, const float* weights, float* sums) {
    const float* middle = at(5);
    for (int i = 0; i < kSsimChunk; ++i) sums[i] = weights[5] * middle[i];
    for (int k = 0; k < 5; ++k) {
        const float weight = weights[k];
        const float *low = at(k), *high = at(10 - k);
        for (int i = 0; i < kSsimChunk; ++i) sums[i] += weight * (low[i] + high[i]);
    }
}

void ssimSmooth(const float* a, const float* b, const float* weights, float* const out[4], int width) {
    float quantities[4][kSsimTile + 10];
    for (int x = 0; x < width + 10; ++x) {
        const float sum = a[x] + b[x] - 1.0f, difference = a[x] - b[x];
        quantities[0][x] = sum;
        quantities[1][x] = difference;
        quantities[2][x] = sum * sum;
        quantities[3][x] = difference * difference;
    }
    for (int q = 0; q < 4; ++q)
        for (int x = 0; x < width; x += kSsimChunk) {
            float sums[kSsimChunk];
            const float* first = quantities[q] + x;
            foldedTaps([first](int k) { return first + k; }, weights, sums);
            float* smooth = out[q] + x;
            for (int i = 0; i < kSsimChunk; ++i) smooth[i] = sums[i];
        }
}

/// With s = a + b - 1 (about 0, for the sake of the variances' last bits) and d = a - b: mean(a) mean(b) = ((ms + 1)^2
/// - md^2) / 4, mean(a)^2 + mean(b)^2 = ((ms + 1)^2 + md^2) / 2, and the same without the 1 for covariance and the sum
/// of variances. Equal images have d = 0, and give 1 to the last bit.
void ssimRow(const float* const* rows, const float* weights, float* ssim, float* contrast, int width) {
    constexpr float c1 = 0.01f * 0.01f, c2 = 0.03f * 0.03f;
    for (int x = 0; x < width; x += kSsimChunk) {
        float means[4][kSsimChunk];
        for (int q = 0; q < 4; ++q) foldedTaps([rows, q, x](int k) { return rows[4 * k + q] + x; }, weights, means[q]);
        for (int i = 0; i < kSsimChunk; ++i) {
            const float ss = means[0][i] * means[0][i], dd = means[1][i] * means[1][i];
            const float sumVariance = means[2][i] - ss, differenceVariance = means[3][i] - dd;
            const float structure =
                (0.5f * (sumVariance - differenceVariance) + c2) / (0.5f * (sumVariance + differenceVariance) + c2);
            const float mean = means[0][i] + 1.0f, both = mean * mean;
            contrast[x + i] = structure;
            ssim[x + i] = (0.5f * (both - dd) + c1) / (0.5f * (both + dd) + c1) * structure;
        }
    }
}

}  // namespace

const MeasureKernels& measureTable() {
    static const MeasureKernels table{convolveRow, convolveColumn, flipColour,   flipCombine, yCxCzFromLinear,
                                      encodeLdr,   decodeSrgb,     toneRational, ssimSmooth,  ssimRow};
    return table;
}

}  // namespace lumi::LUMI_ISA
