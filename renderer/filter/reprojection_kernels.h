#pragma once
#include <cstdint>

#include "base/isa.h"

namespace lumi {

/// Pixels [begin, end) of row y and the 2x2 pixels of the previous frame around where each was. Planes without gaps
/// between their rows; outputs are rows that begin at pixel `begin`.
struct ReprojectionRow {
    int width = 0, height = 0, y = 0, begin = 0, end = 0;
    const float* motion[3];
    const float* depth = nullptr;
    const float* slope[2];
    const float* objectNormal[3];
    const uint32_t* object = nullptr;
    const float* previousInverseDepth = nullptr;
    const float* previousNormal[3];
    const uint32_t* previousObject = nullptr;
    float depthTolerance = 0, normalCosine = 0;

    int32_t* index[4];     ///< y * width + x of the taps, inside the image
    float* weight[4];      ///< 0 where refused; the rest sums to 1, or all are 0
    int32_t* refusals[4];  ///< TapRefusal bits
};

struct ReprojectionKernels {
    /// 2x2 bilinear taps, each tested; a refused tap's weight is spread uniformly over the others. Returns the number
    /// of pixels that none is left of.
    int (*tapRow)(const ReprojectionRow& row);
    /// Each of `count` numbers is one more than the one before.
    bool (*inARow)(const int32_t* numbers, int count);
};

LUMI_KERNELS(ReprojectionKernels, reprojection)

}  // namespace lumi
