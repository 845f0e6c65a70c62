#pragma once
#include "filter/atrous.h"

namespace lumi {

/// The edge-stopping functions of one pair of pixels, one by one: what views and inspectors show of the kernels'
/// products.
struct EdgeWeights {
    float depth = 0, normal = 0;  ///< eqs. 3 and 4
    float luminance = 0;          ///< eq. 5
    float product() const { return depth * normal * luminance; }
};

/// Of q = p + (dx, dy), both inside the image. `illumination` is the level's input.
EdgeWeights edgeWeights(const SurfaceGuide& guide, const AtrousSettings& settings, const Illumination& illumination,
                        Pixel p, int dx, int dy);

/// The 3x3 Gaussian of eq. 5's variance at a pixel, borders repeated.
float prefilteredVariance(const Image& sampleVariance, Pixel p);

}  // namespace lumi
