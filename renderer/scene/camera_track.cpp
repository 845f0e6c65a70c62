#include "scene/camera_track.h"

#include <algorithm>
#include <cmath>

#include "scene/shutter_segments.h"

namespace lumi {
namespace {

/// The world point at a pixel and view depth.
Vec3 placeAt(const CameraPose& pose, Vec2 pixel, float depth) {
    const float size = pose.pixelSizeAt(depth);
    const Vec2 centre(0.5f * static_cast<float>(pose.extent.width), 0.5f * static_cast<float>(pose.extent.height));
    return transformPoint(pose.worldFromCamera, Vec3((pixel.x - centre.x) * size, (centre.y - pixel.y) * size, -depth));
}

/// Does the camera on the straight way from `a` to `b` show what lies in the corners of the true one's image elsewhere,
/// from a quarter of the distance that it looks at to four times that, or is its focus elsewhere?
bool strays(const Camera& a, const Camera& truth, const Camera& b, float part, Extent2 extent) {
    const CameraPose shown = interpolate(poseCamera(a, extent), poseCamera(b, extent), part),
                     meant = poseCamera(truth, extent);
    const float distance = glm::distance(truth.eye, truth.target),
                allowed = kMostShutterStray * static_cast<float>(extent.height);
    for (int corner = 0; corner < 8; ++corner) {
        const Vec2 pixel(corner & 1 ? static_cast<float>(extent.width) : 0.0f,
                         corner & 2 ? static_cast<float>(extent.height) : 0.0f);
        const Vec3 seen = shown.project(placeAt(meant, pixel, distance * (corner & 4 ? 4.0f : 0.25f)));
        if (!(seen.z > 0 && glm::distance(Vec2(seen), pixel) <= allowed)) return true;
    }
    return meant.aperture > 0 && std::abs(shown.focus - meant.focus) > kMostShutterStray * meant.focus;
}

}  // namespace

CameraTrack cameraTrack(const std::function<Camera(float part)>& at, std::span<const float> turns, Extent2 extent) {
    CameraTrack track;
    const auto offTheWay = [&](const Camera& a, const Camera& truth, const Camera& b, float part) {
        return strays(a, truth, b, part, extent);
    };
    for (const Camera& camera : straightSegments(turns, at, offTheWay)) track.push_back(poseCamera(camera, extent));
    const bool still = std::all_of(track.begin(), track.end(), [&](const CameraPose& p) { return p == track[0]; });
    return still ? CameraTrack() : track;
}

}  // namespace lumi
