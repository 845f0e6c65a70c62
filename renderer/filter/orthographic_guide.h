#pragma once
#include "filter/surface_guide.h"

namespace lumi {

/// surfaceGuide() of a frame that an orthographic camera sees, where depth itself and not 1/depth is affine on a plane:
/// in place of 1/depth stand 1 + (z1 - depth) / height, z1 being the farthest depth of the frame and `height` that of
/// the view in metres, and its slopes. The sky is 0 as ever. `planes` holds the three; the guide points into it.
SurfaceGuide orthographicGuide(const Signals& signals, float height, Image& planes);

}  // namespace lumi
