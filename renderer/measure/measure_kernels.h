#pragma once
#include "base/isa.h"

namespace lumi {

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
    /// SSIM of one row from local means and second moments [Wang 2004, eq. 13]; also the contrast-structure part.
    void (*ssimRow)(const float* meanA, const float* meanB, const float* squareA, const float* squareB,
                    const float* product, float* ssim, float* contrast, int width);
};

LUMI_KERNELS(MeasureKernels, measure)

}  // namespace lumi
