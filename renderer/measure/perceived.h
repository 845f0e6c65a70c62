#pragma once
#include <array>

#include "image/image.h"

namespace lumi {

/// The parts of FLIP [Andersson 2020] that its LDR and HDR forms share.

constexpr float kFlipPixelsPerDegree = 67.0206f;  ///< 0.7 m from a 0.7 m wide monitor of 3840 pixels

/// One image as FLIP compares it.
struct FlipFeatures {
    Image filtered;   ///< YCxCz after the contrast sensitivity filters (sec. 4.1.1)
    Image gradients;  ///< edge x, edge y, point x, point y of the achromatic channel (sec. 4.2)
};

/// `linear`: RGB in [0,1], linear light.
FlipFeatures flipFeatures(const Image& linear);

/// FLIP error of each pixel, in [0,1].
Image flipError(const FlipFeatures& test, const FlipFeatures& reference);

}  // namespace lumi
