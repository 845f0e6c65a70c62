#pragma once
#include <cstdint>

#include "base/isa.h"

namespace lumi {

/// Samples that are sought on a screen: see ScreenPlaces::find() and reprojectSamples().
struct ProjectionRow {
    const float* inWorld = nullptr;  ///< x, y, z of each: position, or direction into the sky
    const uint8_t* flags = nullptr;  ///< SampleSet's
    const float* kept = nullptr;     ///< x, y of each: places that stay as they are; null: places are found
    uint32_t count = 0;
    float view[12] = {};                 ///< columns of the matrix from the world to the camera
    float centre[2] = {}, size[2] = {};  ///< pixels
    float inverseSize = 0;               ///< pixels a metre at depth 1
    bool perspective = true;
    uint32_t nowhere = 0;  ///< row of samples that are not on the screen

    float* places = nullptr;      ///< x, y of each
    uint32_t* targets = nullptr;  ///< 16 * column + sub-pixel; the flag kOccluded is the highest bit
    uint32_t* rows = nullptr;
};

struct ProjectionKernels {
    void (*project)(const ProjectionRow& row);
};

LUMI_KERNELS(ProjectionKernels, projection)

}  // namespace lumi
