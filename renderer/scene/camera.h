#pragma once
#include <string>
#include <vector>

#include "params/parameter.h"

namespace lumi {

enum class Projection : uint8_t { Perspective, Orthographic };
enum class ApertureShape : uint8_t { Round, Bladed };
enum class StereoEye : uint8_t { Centre, Left, Right };

/// A camera as a user edits it. It looks from `eye` to `target`.
struct Camera {
    std::string name = "default";
    Vec3 eye{0, 0, 5}, target{0}, up{0, 1, 0};
    Projection projection = Projection::Perspective;
    float fovYDeg = 45;  ///< perspective: full vertical angle
    float yMag = 1;      ///< orthographic: half the visible height in metres
    float aperture = 0;  ///< lens radius in metres; 0 is a pinhole
    float focus = 5;     ///< metres to the plane in focus
    ApertureShape apertureShape = ApertureShape::Round;
    int apertureBlades = 6;         ///< bladed: corners of the regular polygon inside the lens
    float apertureRotationDeg = 0;  ///< bladed: counter-clockwise as seen from behind the camera
    float shutter = 0;              ///< how long it is open, in frames; 0: an instant
    StereoEye eyeOfPair = StereoEye::Centre;
    float interaxial = 0.064f;  ///< metres between the two eyes of a stereo pair
    bool operator==(const Camera&) const = default;

    /// Everything a user can move: eye, look-at, up, projection, fov-y-deg, y-mag, aperture, focus, shutter, ...
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
    int blades = 0;           ///< corners of the aperture; 0: round
    float bladeRotation = 0;  ///< radians
    float shutter = 0;        ///< frames that the shutter is open

    Vec3 position() const { return Vec3(worldFromCamera[3]); }
    Vec3 forward() const { return -Vec3(worldFromCamera[2]); }
    /// Height of a pixel's footprint at view depth 1 (perspective) or anywhere (orthographic), metres.
    float pixelSize() const { return 2 * halfHeight / static_cast<float>(extent.height); }
    /// At `depth` metres before the eye.
    float pixelSizeAt(float depth) const { return pixelSize() * (projection == Projection::Perspective ? depth : 1); }
    /// Continuous pixel and linear view depth of a world point. Behind a perspective camera the depth is negative and
    /// the pixel is that of the mirrored point; callers test the depth.
    Vec3 project(const Vec3& positionWorld) const;
    bool operator==(const CameraPose&) const = default;
};

/// The camera, or that eye of its stereo pair: both look the same way from half the interaxial distance to either side,
/// so that the pair is rectified and a point's disparity is `interaxial / depth` over the pixel size.
CameraPose poseCamera(const Camera& camera, Extent2 extent);

/// A camera on its way from `a` to `b`, `t` from 0 to 1: rotation on the shorter arc, all else straight.
CameraPose interpolate(const CameraPose& a, const CameraPose& b, float t);

/// A camera over the time that its shutter is open: poses at equally spaced moments, or a single one if it stands
/// still.
using CameraTrack = std::vector<CameraPose>;

}  // namespace lumi
