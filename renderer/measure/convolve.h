#pragma once
#include <span>
#include <vector>

#include "image/image.h"

namespace lumi {

/// Weights of a sampled Gaussian of `taps` (odd) values, normalised to sum 1.
std::vector<float> gaussianWeights(int taps, double sigma);

/// Separable convolution of one channel, borders extended by their edge value; output has the input's extent.
/// Weights have odd lengths. In and out may not overlap.
void convolveClamped(ConstFloatPlane in, std::span<const float> horizontal, std::span<const float> vertical,
                     FloatPlane out);

}  // namespace lumi
