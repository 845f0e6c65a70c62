#pragma once
#include "base/isa.h"

namespace lumi {

constexpr int kSsimChunk = 32;  ///< columns that SSIM's kernels take at a time
constexpr int kSsimTile = 256;  ///< most columns of a row: what 11 rows of it need stays near the core

/// One row of a separable convolution: out[x] = sum over k of weights[k] * in[x + k], k in [0, taps).
/// `in` holds width + taps - 1 values, its borders already extended.
struct MeasureKernels {
    void (*convolveRow)(const float* in, const float* weights, int taps, float* out, int width);
    /// out[x] = sum over k of weights[k] * rows[k][x].
    void (*convolveColumn)(const float* const* rows, const float* weights, int taps, float* out, int width);

    /// FLIP's colour difference [Andersson 2020, sec. 4.1]: filtered YCxCz rows of both images to the remapped HyAB
    /// distance of Hunt-adjusted CIELab, in [0,1]. `remap` is {cMax^qc * pc, pt, cMax^qc}.
    void (*flipColour)(const float* const test[3], const float* const reference[3], const float remap[3], float* out,
                       int width);
    /// FLIP's final error [sec. 4.3]: colour^(1 - feature), feature = sqrt(max difference / sqrt 2). Gradients are
    /// {edge x, edge y, point x, point y} of test and reference. Overwrites `colour`.
    void (*flipCombine)(const float* const test[4], const float* const reference[4], float* colour, int width);
    /// Linear RGB to YCxCz [sec. 4.1], the linearised opponent space.
    void (*yCxCzFromLinear)(const float* const rgb[3], float* const out[3], int width);
    /// Exposure, clamp to [0,1], sRGB encoding: what LDR metrics see.
    void (*encodeLdr)(const float* in, float exposureFactor, float* out, int width);
    /// sRGB decoding of values in [0,1].
    void (*decodeSrgb)(const float* in, float* out, int width);
    /// FLIP's tone mappers for HDR: rational a x^2 + b x + c over d x^2 + e x + f, clamped to [0,1].
    void (*toneRational)(const float* in, float exposureFactor, const float coefficients[6], float* out, int width);
    /// SSIM [Wang 2004], first pass: a + b - 1 and a - b of two rows and their squares, each smoothed along the
    /// row by the 11 symmetric `weights` (6 values, the middle one last): out[x] belongs to in[x + 5]. Rows hold
    /// width + 10 values, width a multiple of kSsimChunk and at most kSsimTile.
    void (*ssimSmooth)(const float* a, const float* b, const float* weights, float* const out[4], int width);
    /// Second pass: the four quantities of 11 rows, smoothed down the columns, to SSIM and its contrast-structure part
    /// (eq. 13). rows[4 * k + q] is quantity q of row k.
    void (*ssimRow)(const float* const* rows, const float* weights, float* ssim, float* contrast, int width);
};

LUMI_KERNELS(MeasureKernels, measure)

}  // namespace lumi
