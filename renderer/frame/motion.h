#pragma once
#include "scene/camera.h"

namespace lumi {

/// Motion of a point that has no previous pixel, since it was behind the previous camera: far off any image, so that
/// whoever follows it finds no history. (0, 0) would mean "has not moved".
inline const Vec3 kNoPreviousPixel{-1e6f, -1e6f, 0};

/// Where a surface point was on the previous frame's screen, as Signal::Motion stores it: (x, y) previous minus current
/// pixel, z previous minus current linear view depth in metres. Jitter plays no part: both are projections of world
/// points. A point that was behind or in the plane of the previous camera gets kNoPreviousPixel.
Vec3 surfaceMotion(const CameraPose& camera, const CameraPose& previousCamera, const Vec3& position,
                   const Vec3& previousPosition);

/// The same for what is infinitely far in unit direction `direction`; z is 0.
Vec3 skyMotion(const CameraPose& camera, const CameraPose& previousCamera, const Vec3& direction);

/// Screen derivatives per pixel (x right, y down) of 1/(linear view depth) over the plane through `position` with unit
/// `normal`, world space. A plane seen edge-on gets 0.
Vec2 inverseDepthGradient(const CameraPose& camera, const Vec3& position, const Vec3& normal);

}  // namespace lumi
