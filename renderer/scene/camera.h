#pragma once
#include <string>

#include "params/parameter.h"

namespace lumi {

enum class Projection : uint8_t { Perspective, Orthographic };

/// A camera as a user edits it. It looks from `eye` to `target`.
struct Camera {
    std::string name = "default";
    Vec3 eye{0, 0, 5}, target{0}, up{0, 1, 0};
    Projection projection = Projection::Perspective;
    float fovYDeg = 45;     ///< perspective: full vertical angle
    float yMag = 1;         ///< orthographic: half the visible height in metres
    float aperture = 0;     ///< lens radius in metres; 0 is a pinhole
    float focus = 5;        ///< metres to the plane in focus
    bool operator==(const Camera&) const = default;

    /// Everything a user can move: eye, look-at, up, projection, fov-y-deg, y-mag, aperture, focus.
    void describe(ParameterVisitor&);
};

/// A camera at one moment, ready to make rays for an image of `extent`. Pixels are continuous, (0,0) is the corner of
/// the top-left pixel, (0.5, 0.5) its centre. Camera space looks along -Z; "view depth" is -z there.
struct CameraPose {
    Mat4 worldFromCamera{1}, cameraFromWorld{1};
    Extent2 extent;
    Projection projection = Projection::Perspective;
    float halfHeight = 0.41421356f;  ///< perspective: tan(fovY/2); orthographic: metres
    float aperture = 0, focus = 5;

    Vec3 position() const { return Vec3(worldFromCamera[3]); }
    Vec3 forward() const { return -Vec3(worldFromCamera[2]); }
    /// Height of a pixel's footprint at view depth 1 (perspective) or anywhere (orthographic), metres.
    float pixelSize() const { return 2 * halfHeight / static_cast<float>(extent.height); }
    /// Continuous pixel and linear view depth of a world point. Behind a perspective camera the depth is negative and
    /// the pixel is that of the mirrored point; callers test the depth.
    Vec3 project(const Vec3& positionWorld) const;
    bool operator==(const CameraPose&) const = default;
};

CameraPose poseCamera(const Camera& camera, Extent2 extent);

}  // namespace lumi
