#pragma once
#include <cstdint>

#include "base/isa.h"

namespace lumi {

/// Rows of the display conversion; pixels come out as 0xAABBGGRR. All return how many pixels held NaN or infinity:
/// NaN is shown magenta, infinity cyan.
struct DisplayKernels {
    /// Linear colour times `scale`, by curve (index of ToneCurve), sRGB-encoded. Planes may be the same for grey.
    int (*tone)(const float* r, const float* g, const float* b, int count, float scale, int curve, uint32_t* out);
    /// (v - low) * perUnit of three planes, as they are.
    int (*range)(const float* x, const float* y, const float* z, int count, float low, float perUnit, uint32_t* out);
    /// table[(v - low) * perUnit * (size - 1)]; `cyclic` wraps instead of clamping; `skyIsBlack`: +infinity is the sky.
    int (*map)(const float* v, int count, float low, float perUnit, const uint32_t* table, int size, bool cyclic,
               bool skyIsBlack, uint32_t* out);
    /// Direction as hue, length * perUnit as brightness.
    int (*wheel)(const float* x, const float* y, int count, float perUnit, uint32_t* out);
    /// One number a pixel: Rec.709 luminance, and length.
    void (*luminance)(const float* r, const float* g, const float* b, int count, float* out);
    void (*length)(const float* x, const float* y, const float* z, int count, float* out);
    /// sRGB encoding of values in [0, 1], as the rows above use it.
    void (*encodeSrgb)(const float* linear, int count, float* out);
};

LUMI_KERNELS(DisplayKernels, display)

}  // namespace lumi
