#pragma once
#include "base/isa.h"

namespace lumi {

/// One row of a bank of cross-bilateral filters that differ in their spatial sigma; see filter/cross_bilateral.h.
/// Planes have no gaps between their rows.
struct CrossBilateralRow {
    static constexpr int kMost = 4;  ///< filters
    int width = 0, height = 0, y = 0;
    int filters = 0;
    float spatialScale[kMost];  ///< log2(e) / (2 sigma_s^2), rising sigma_s
    int radius[kMost];          ///< of the windows, rising
    const float* rgb[3];
    const float* normal[3];
    const float* albedo[3];
    const float* inverseDepth = nullptr;                     ///< 0: the sky, which neither gives nor takes
    const float* colourScale = nullptr;                      ///< row: log2(e) / (2 sigma_r^2) of its pixels
    const float* colourVariance = nullptr;                   ///< row: of one channel of a pixel
    float normalScale = 0, albedoScale = 0, depthScale = 0;  ///< log2(e) / (2 sigma^2)
    float* out[kMost][3];                                    ///< rows
    float* error[kMost];  ///< rows: Stein's unbiased estimate of the squared error, mean of the channels
};

struct CrossBilateralKernels {
    void (*filterRow)(const CrossBilateralRow& row);
};

LUMI_KERNELS(CrossBilateralKernels, crossBilateral)

}  // namespace lumi
