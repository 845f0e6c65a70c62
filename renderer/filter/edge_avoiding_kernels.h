#pragma once
#include "base/isa.h"

namespace lumi {

/// One row of one level; see filter/edge_avoiding.h. Planes have no gaps between their rows.
struct EdgeAvoidingRow {
    int width = 0, height = 0, y = 0;
    int step = 1;
    const float* rgb[3];
    const float* normal[3];
    const float* position[3];
    const float* inverseDepth = nullptr;
    float colourScale = 0, normalScale = 0, positionScale = 0;  ///< log2(e) / sigma^2
    float* out[3];
};

struct EdgeAvoidingKernels {
    void (*filterRow)(const EdgeAvoidingRow& row);
};

LUMI_KERNELS(EdgeAvoidingKernels, edgeAvoiding)

}  // namespace lumi
