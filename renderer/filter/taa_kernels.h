#pragma once
#include "base/isa.h"

namespace lumi {

/// One row of temporal antialiasing; see filter/taa.h. Planes of compressed YCoCg, without gaps between their rows.
struct TaaRow {
    int width = 0, height = 0, y = 0;
    const float* compressed[3];
    const float* previous[3] = {nullptr, nullptr, nullptr};  ///< null: no history
    const float* nearness = nullptr;  ///< plane, greater where what is seen is nearer (filter/taa.h)
    const float* motion[2];
    float alpha = 0, gamma = 0;
    float exposure = 1;  ///< factor that was applied before compressing
    bool clip = false, catmullRom = false;
    float* next[3];  ///< rows
    float* out[3];   ///< rows, scene-linear
};

struct TaaKernels {
    /// RGB times `exposure` to YCoCg, divided by 1 + luma; what is not finite counts as 0. `rgb` and `out` may be the
    /// same planes.
    void (*compressRow)(const float* const rgb[3], float* const out[3], float exposure, int count);
    void (*resolveRow)(const TaaRow& row);
};

LUMI_KERNELS(TaaKernels, taa)

}  // namespace lumi
