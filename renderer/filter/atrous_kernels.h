#pragma once
#include "base/isa.h"
#include "filter/guide_row.h"

namespace lumi {

/// Planes of one illumination component (direct or indirect) at one level of the wavelet transform.
struct IlluminationView {
    const float* rgb[3];
    const float* luminance;
    const float* sampleVariance;  ///< of luminance
};
struct IlluminationOutput {
    float* rgb[3];
    float* luminance;
    float* sampleVariance;
};

/// One row of one level for up to two components that share their geometric weights.
struct AtrousRow {
    static constexpr int kMaxComponents = 2;
    GuideRow guide;
    int step = 1;                   ///< pixels between the kernel's taps, 2^level
    bool variancePrefilter = true;  ///< the 3x3 Gaussian of eq. 5
    int components = 1;
    IlluminationView in[kMaxComponents];
    IlluminationOutput out[kMaxComponents];
};

struct AtrousKernels {
    /// Eq. 1 and the variance of its result, with the weights of eqs. 2 to 5 [Schied17].
    void (*filterRow)(const AtrousRow& row);
};

LUMI_KERNELS(AtrousKernels, atrous)

}  // namespace lumi
