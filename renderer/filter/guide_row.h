#pragma once
#include "filter/edge_stopping.h"

namespace lumi {

/// Row y of the G-buffer that steers a filter, as kernels take it: planes of SurfaceGuide, without gaps between their
/// rows.
struct GuideRow {
    int width = 0, height = 0, y = 0;
    const float* inverseDepth = nullptr;
    const float* slopeX = nullptr;
    const float* slopeY = nullptr;
    const float* normal[3] = {nullptr, nullptr, nullptr};
    EdgeStopping edges;
};

}  // namespace lumi
