#pragma once
#include "base/isa.h"
#include "filter/guide_row.h"

namespace lumi {

/// One row of the variance that a neighbourhood shows, for up to two components that share their weights.
struct SpatialVarianceRow {
    static constexpr int kMaxComponents = 2;
    GuideRow guide;
    const float* historyLength = nullptr;  ///< plane
    float minLength = 0;
    int components = 1;
    const float* mean[kMaxComponents] = {nullptr, nullptr};     ///< planes
    const float* centred[kMaxComponents] = {nullptr, nullptr};  ///< planes, second moments about the mean
    float* variance[kMaxComponents] = {nullptr, nullptr};       ///< planes
};

struct SpatialVarianceKernels {
    /// Variance of luminance over a 7x7 window weighted by depth and normals [Schied17, sec. 4.2], where historyLength
    /// < minLength; elsewhere `centred`.
    void (*estimateRow)(const SpatialVarianceRow& row);
};

LUMI_KERNELS(SpatialVarianceKernels, spatialVariance)

}  // namespace lumi
