#pragma once
#include "image/image.h"
#include "params/parameter.h"

namespace lumi {

/// A smooth daylight sky: a gradient from horizon to zenith, dim ground, and a soft sun that a path tracer finds
/// easily. Its looks are chosen, not measured.
struct Sky {
    float radiance = 1;          ///< mean luminance over the whole sphere
    float sunElevationDeg = 40;  ///< above the horizon
    float sunAzimuthDeg = 40;    ///< counter-clockwise from +Z seen from above
    float sunShare = 0.45f;      ///< of all light
    float sunSizeDeg = 6;        ///< radius at which the sun has fallen to 1/e
    Vec3 zenith{0.30f, 0.50f, 0.95f}, horizon{0.95f, 0.97f, 1.0f}, ground{0.24f, 0.21f, 0.18f};

    void describe(ParameterVisitor&);
    /// Equirectangular RGB radiance, 512x256 (layout as Environment::image).
    Image build() const;
};

}  // namespace lumi
