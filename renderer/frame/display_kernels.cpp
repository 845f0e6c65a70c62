#include "frame/display_kernels.h"

#include <cmath>
#include <cstdint>

#include "frame/tone_curve_constants.h"
#include "math/kernel_math.h"

namespace lumi {
namespace {

constexpr float kLargest = 3.402823466e38f;
constexpr uint32_t kMagenta = 0xffff00ffu, kCyan = 0xffffff00u, kBlack = 0xff000000u;

struct Rgb {
    float r, g, b;
};

inline float clamped(float x, float high) {
    x = x > 0.0f ? x : 0.0f;  // NaN too
    return x < high ? x : high;
}

/// sRGB encoding on [0, 1]. Above the linear toe the curve 1.055 x^(1/2.4) - 0.055 is smooth in x^(1/4); this is its
/// Chebyshev interpolant of degree 6 there, within 0.0006/255.
inline float srgb(float x) {
    const float s = std::sqrt(std::sqrt(x));
    float curved = 0.0617343075f;
    curved = curved * s - 0.294247637f;
    curved = curved * s + 0.621002284f;
    curved = curved * s - 0.825280017f;
    curved = curved * s + 1.35457265f;
    curved = curved * s + 0.141958263f;
    curved = curved * s - 0.0597390114f;
    return x <= 0.0031308f ? 12.92f * x : curved;
}

/// Colour in [0, 1] to bytes, rounded to nearest.
inline uint32_t packed(Rgb c) {
    const auto byte = [](float x) { return static_cast<uint32_t>(static_cast<int32_t>(x * 255.0f + 0.5f)); };
    return byte(c.r) | byte(c.g) << 8 | byte(c.b) << 16 | 0xff000000u;
}

inline int32_t isNan(float x) { return x != x ? 1 : 0; }
inline int32_t isInfinite(float x) { return std::fabs(x) > kLargest ? 1 : 0; }

inline Rgb multiply(const float (&m)[9], Rgb v) {
    return {m[0] * v.r + m[1] * v.g + m[2] * v.b, m[3] * v.r + m[4] * v.g + m[5] * v.b,
            m[6] * v.r + m[7] * v.g + m[8] * v.b};
}

// The curves; toneMap() in tone_curve.cpp is their definition.

inline Rgb clampCurve(Rgb c) { return c; }

inline Rgb reinhardCurve(Rgb c) {
    const float scale = 1.0f / (1.0f + (0.2126f * c.r + 0.7152f * c.g + 0.0722f * c.b));
    return {c.r * scale, c.g * scale, c.b * scale};
}

inline Rgb acesCurve(Rgb c) {
    const auto fit = [](float x) {
        const float* k = kAcesCurve;
        return (x * (x + k[0]) - k[1]) / (x * (k[2] * x + k[3]) + k[4]);
    };
    const Rgb v = multiply(kAcesIn, {c.r * kAcesExposure, c.g * kAcesExposure, c.b * kAcesExposure});
    return multiply(kAcesOut, {fit(v.r), fit(v.g), fit(v.b)});
}

/// log2 for the sigmoid of AgX, without a division; absolute error below 4e-6.
inline float agxLog2(float x) {
    x = x > 1.17549435e-38f ? x : 1.17549435e-38f;
    const int32_t bits = floatToBits(x);
    // The mantissa in [sqrt(1/2), sqrt(2)): 0x3f3504f3 is sqrt(1/2).
    const int32_t exponent = (bits - 0x3f3504f3) >> 23;
    const float f = bitsToFloat(bits - (exponent << 23)) - 1.0f;
    float p = -0.206858124f;  // Chebyshev interpolant of log2(1 + f) / f
    p = p * f + 0.318407118f;
    p = p * f - 0.366413259f;
    p = p * f + 0.479793884f;
    p = p * f - 0.721208468f;
    p = p * f + 1.4427018f;
    return p * f + static_cast<float>(exponent);
}

/// AgX up to its display gamma, which agxEncode() takes in.
inline Rgb agxCurve(Rgb c) {
    const auto sigmoid = [](float linear) {
        const float ev = agxLog2(linear);
        const float low = ev > kAgxMinEv ? ev : kAgxMinEv;
        const float within = low < kAgxMaxEv ? low : kAgxMaxEv;
        const float x = (within - kAgxMinEv) * (1 / (kAgxMaxEv - kAgxMinEv));
        const float* k = kAgxCurve;
        return (((((k[0] * x + k[1]) * x + k[2]) * x + k[3]) * x + k[4]) * x + k[5]) * x + k[6];
    };
    const Rgb inset = multiply(kAgxInset, c);
    return multiply(kAgxOutset, {sigmoid(inset.r), sigmoid(inset.g), sigmoid(inset.b)});
}

/// sRGB encoding of x^2.2 on [0, 1], nearly x itself: Chebyshev interpolants on both sides of where sRGB's linear toe
/// ends, within 0.015/255.
inline float agxEncode(float x) {
    float low = -129.771751f;
    low = low * x + 37.1588482f;
    low = low * x + 5.79051212f;
    low = low * x - 0.0116970403f;
    low = low * x + 1.15994146e-05f;
    float high = -0.250793326f;
    high = high * x + 0.958308066f;
    high = high * x - 1.50818187f;
    high = high * x + 1.29338514f;
    high = high * x - 0.72593278f;
    high = high * x + 1.28257319f;
    high = high * x - 0.0493808815f;
    return x <= 0.0727212795f ? low : high;
}

/// `encode` takes what `curve` gives, held in [0, 1], to the screen.
template <class Curve, class Encode>
inline int toneRow(const float* r, const float* g, const float* b, int count, float scale, uint32_t* __restrict out,
                   Curve curve, Encode encode) {
    int bad = 0;
    for (int i = 0; i < count; ++i) {
        const Rgb c{clamped(r[i] * scale, kBrightest), clamped(g[i] * scale, kBrightest),
                    clamped(b[i] * scale, kBrightest)};
        const Rgb t = curve(c);
        const uint32_t pixel = packed({encode(clamped(t.r, 1)), encode(clamped(t.g, 1)), encode(clamped(t.b, 1))});
        const int32_t nan = isNan(r[i]) | isNan(g[i]) | isNan(b[i]);
        const int32_t infinite = isInfinite(r[i]) | isInfinite(g[i]) | isInfinite(b[i]);
        out[i] = nan ? kMagenta : infinite ? kCyan : pixel;
        bad += nan | infinite;
    }
    return bad;
}

int tone(const float* r, const float* g, const float* b, int count, float scale, int curve, uint32_t* out) {
    const auto toSrgb = [](float x) { return srgb(x); };
    switch (curve) {
        case 1:
            return toneRow(
                r, g, b, count, scale, out, [](Rgb c) { return reinhardCurve(c); }, toSrgb);
        case 2:
            return toneRow(
                r, g, b, count, scale, out, [](Rgb c) { return acesCurve(c); }, toSrgb);
        case 3:
            return toneRow(
                r, g, b, count, scale, out, [](Rgb c) { return agxCurve(c); }, [](float x) { return agxEncode(x); });
        default:
            return toneRow(
                r, g, b, count, scale, out, [](Rgb c) { return clampCurve(c); }, toSrgb);
    }
}

int range(const float* x, const float* y, const float* z, int count, float low, float perUnit,
          uint32_t* __restrict out) {
    int bad = 0;
    for (int i = 0; i < count; ++i) {
        const uint32_t pixel = packed({clamped((x[i] - low) * perUnit, 1), clamped((y[i] - low) * perUnit, 1),
                                       clamped((z[i] - low) * perUnit, 1)});
        const int32_t nan = isNan(x[i]) | isNan(y[i]) | isNan(z[i]);
        const int32_t infinite = isInfinite(x[i]) | isInfinite(y[i]) | isInfinite(z[i]);
        out[i] = nan ? kMagenta : infinite ? kCyan : pixel;
        bad += nan | infinite;
    }
    return bad;
}

int map(const float* v, int count, float low, float perUnit, const uint32_t* table, int size, bool cyclic,
        bool skyIsBlack, uint32_t* __restrict out) {
    int bad = 0;
    const auto last = static_cast<float>(size - 1);
    for (int i = 0; i < count; ++i) {
        const int32_t nan = isNan(v[i]), infinite = isInfinite(v[i]);
        const int32_t sky = skyIsBlack && v[i] > kLargest ? 1 : 0;
        float t = (v[i] - low) * perUnit;
        if (cyclic) {
            // Beyond 2^22 a float has no fraction worth showing.
            const float above = t > -4194304.0f ? t : -4194304.0f;  // NaN too
            const float held = above < 4194304.0f ? above : 4194304.0f;
            t = held - std::floor(held);
        }
        const uint32_t pixel = table[static_cast<int32_t>(clamped(t, 1) * last + 0.5f)];
        out[i] = nan ? kMagenta : sky ? kBlack : infinite ? kCyan : pixel;
        bad += (nan | infinite) & ~sky;
    }
    return bad;
}

int wheel(const float* x, const float* y, int count, float perUnit, uint32_t* __restrict out) {
    int bad = 0;
    constexpr float kHalfRoot3 = 0.8660254f;
    for (int i = 0; i < count; ++i) {
        const float u = x[i] * perUnit, v = y[i] * perUnit;
        const float squared = u * u + v * v;
        const float size = std::sqrt(squared > 1e-30f ? squared : 1e-30f);
        const float value = clamped(size, 1), c = u / size, s = v / size;
        // Three cosine lobes a third of a turn apart: red to the right, green and blue at +-120 degrees.
        const uint32_t pixel = packed({clamped(value * (0.5f + 0.5f * c), 1),
                                       clamped(value * (0.5f + 0.5f * (-0.5f * c + kHalfRoot3 * s)), 1),
                                       clamped(value * (0.5f + 0.5f * (-0.5f * c - kHalfRoot3 * s)), 1)});
        const int32_t nan = isNan(x[i]) | isNan(y[i]), infinite = isInfinite(x[i]) | isInfinite(y[i]);
        out[i] = nan ? kMagenta : infinite ? kCyan : pixel;
        bad += nan | infinite;
    }
    return bad;
}

void luminance(const float* r, const float* g, const float* b, int count, float* __restrict out) {
    for (int i = 0; i < count; ++i) out[i] = 0.2126f * r[i] + 0.7152f * g[i] + 0.0722f * b[i];
}

void length(const float* x, const float* y, const float* z, int count, float* __restrict out) {
    for (int i = 0; i < count; ++i) out[i] = std::sqrt(x[i] * x[i] + y[i] * y[i] + z[i] * z[i]);
}

void encodeSrgb(const float* linear, int count, float* __restrict out) {
    for (int i = 0; i < count; ++i) out[i] = srgb(clamped(linear[i], 1));
}

}  // namespace

namespace LUMI_ISA {
const DisplayKernels& displayTable() {
    static const DisplayKernels table{tone, range, map, wheel, luminance, length, encodeSrgb};
    return table;
}
}  // namespace LUMI_ISA

}  // namespace lumi
