#pragma once
#include "scene/camera.h"

namespace lumi {

/// Camera moves as pure functions. Angles are radians; distances metres. The camera keeps its up vector, its distance
/// to the target stays unless a move is about it, and it never tips over the poles.

/// Looks around: yaw > 0 turns left, pitch > 0 looks up.
Camera lookAround(Camera camera, float yaw, float pitch);
/// Moves along the camera's own right, up and forward axes.
Camera flyBy(Camera camera, const Vec3& rightUpForward);
/// Turns around the target.
Camera orbit(Camera camera, float yaw, float pitch);
/// Moves eye and target so that the point at the target's distance follows the pointer; pixels of an image `height`
/// high.
Camera slide(Camera camera, Vec2 deltaPx, float height);

}  // namespace lumi
