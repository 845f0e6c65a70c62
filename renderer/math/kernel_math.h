#pragma once
#include <cstdint>
#include <cstring>

/// Elementary functions for kernels: branch-free, so that loops over rows vectorise, and made of plain additions and
/// multiplications, so that every instruction set and compiler gives the same bits (libm's do not). Include only from
/// kernel files: everything here has internal linkage, each instruction set compiles its own copy.
namespace lumi {
namespace {

inline float bitsToFloat(int32_t bits) {
    float value;
    std::memcpy(&value, &bits, sizeof value);
    return value;
}
inline int32_t floatToBits(float value) {
    int32_t bits;
    std::memcpy(&bits, &value, sizeof bits);
    return bits;
}

/// 2^x for x in [-126, 127], clamped outside; relative error below 2e-7. NaN gives 2^-126.
[[maybe_unused]] inline float kernelExp2(float x) {
    x = x > -126.0f ? x : -126.0f;
    x = x < 127.0f ? x : 127.0f;
    const float shifted = x + 12582912.0f;  // 1.5 * 2^23: the mantissa's low bits become the nearest integer
    const float whole = shifted - 12582912.0f;
    const float f = x - whole;  // [-0.5, 0.5]
    // Taylor series of 2^f, ln(2)^k / k!.
    float p = 1.5403530e-4f;
    p = p * f + 1.3333558e-3f;
    p = p * f + 9.6181291e-3f;
    p = p * f + 5.5504109e-2f;
    p = p * f + 2.4022651e-1f;
    p = p * f + 6.9314718e-1f;
    p = p * f + 1.0f;
    return p * bitsToFloat((static_cast<int32_t>(whole) + 127) << 23);
}

/// log2(x) for x > 0; absolute error below 3e-7 around 1, relative 2e-7 elsewhere. 0 and below give about -127.
[[maybe_unused]] inline float kernelLog2(float x) {
    x = x > 1.17549435e-38f ? x : 1.17549435e-38f;
    const int32_t bits = floatToBits(x);
    // The mantissa in [sqrt(1/2), sqrt(2)): 0x3f3504f3 is sqrt(1/2).
    const int32_t exponent = (bits - 0x3f3504f3) >> 23;
    const float m = bitsToFloat(bits - (exponent << 23));
    // log(m) = 2 atanh(s), s = (m - 1)/(m + 1) in [-0.1716, 0.1716].
    const float s = (m - 1.0f) / (m + 1.0f);
    const float z = s * s;
    float p = 0.3205989f;  // 2/(9 ln 2)
    p = p * z + 0.4121986f;
    p = p * z + 0.5770780f;
    p = p * z + 0.9617967f;
    p = p * z + 2.8853901f;
    return p * s + static_cast<float>(exponent);
}

/// e^x, as kernelExp2; x below -87 gives about 1e-38.
[[maybe_unused]] inline float kernelExp(float x) { return kernelExp2(x * 1.44269504f); }

/// x^y for x >= 0; 0^y is about 0 for y > 0.
[[maybe_unused]] inline float kernelPow(float x, float y) { return kernelExp2(y * kernelLog2(x)); }

}  // namespace
}  // namespace lumi
