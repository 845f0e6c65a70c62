#pragma once
#include <cstdint>

#include "base/isa.h"

namespace lumi {

/// Rows [top, bottom) of an image that is put together from scattered samples; see filter/scattered.h.
struct ScatteredRows {
    int width = 0, height = 0, top = 0, bottom = 0;
    const uint32_t* first = nullptr;
    const float* places = nullptr;    ///< x, y of each sample
    const float* colours = nullptr;   ///< R, G, B of each sample
    const uint8_t* hidden = nullptr;  ///< null: none is
    bool box = false, toneMapped = true;
    float falloff = 0;      ///< 1 / (2 sigma^2)
    float* sums = nullptr;  ///< rows of width + 2 pixels, R, G, B and weight of each; 0 before
};

struct ScatteredKernels {
    void (*splat)(const ScatteredRows& rows);
    /// Colours and weights of one row of sums, its first and last pixel left out, to rows of planes.
    void (*resolve)(const float* sums, int width, float* const out[3], float* weight);
};

LUMI_KERNELS(ScatteredKernels, scattered)

}  // namespace lumi
