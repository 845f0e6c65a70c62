#pragma once
#include <functional>
#include <span>

#include "scene/camera.h"

namespace lumi {

/// A camera over the time that its shutter is open, from what it is `at` a part of it, 0 to 1: as many poses as it
/// takes for the image never to be a thousandth of its height off the true one, within straightSegments()'s limit; none
/// if it stands still. `turns` are shutterTurns().
CameraTrack cameraTrack(const std::function<Camera(float part)>& at, std::span<const float> turns, Extent2 extent);

}  // namespace lumi
