#pragma once
#include <cstdint>

#include "base/isa.h"

namespace lumi {

/// A row of pixels whose samples are counted: see localDensity(). Rows above and below may be null: outside the image.
struct DensityRow {
    const uint32_t* above = nullptr;
    const uint32_t* here = nullptr;
    const uint32_t* below = nullptr;
    int width = 0;
    float* density = nullptr;
};

struct AnalysisKernels {
    void (*densityRow)(const DensityRow& row);
};

LUMI_KERNELS(AnalysisKernels, analysis)

}  // namespace lumi
