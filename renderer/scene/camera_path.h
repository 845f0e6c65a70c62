#pragma once
#include <filesystem>
#include <string>

#include "scene/scene.h"

namespace lumi {

/// Keys that a camera moves along, apart from any scene.
struct CameraPath {
    std::vector<SceneCamera::Key> keys;  ///< at least one; times ascend, seconds
    Interpolation interpolation = Interpolation::CatmullRom;
    float aperture = 0;  ///< radius of the lens in metres

    /// The key at `time`, before the first and after the last one's own.
    SceneCamera::Key at(float time) const;
    float duration() const { return keys.back().time; }
};

/// Reads our own JSON (`"format": "lumiscope-camera-path"`, version 1) or instant-ngp's, by what the file holds.
/// instant-ngp: R is a quaternion x y z w whose matrix has right, down and forward as columns in a world with +Y up, T
/// the eye, `scale` the distance to the point that is looked at, `slice` how far behind it the plane in focus lies,
/// `fov` the vertical angle in degrees, `aperture_size` the lens; keys without times are spread evenly over
/// `duration_seconds` (1 s a key if that is missing). A turn about the line of sight is not kept: our keys have none.
/// Its splines of higher order than 1 are read as Catmull-Rom. Throws Error(BadInput) naming file and key.
CameraPath readCameraPath(const std::filesystem::path& path);

enum class CameraPathFormat { Lumiscope, InstantNgp };
/// Both are read back by readCameraPath(); instant-ngp's lacks nothing but the kind of interpolation beyond linear or
/// not.
std::string formatCameraPath(const CameraPath& path, CameraPathFormat format);
/// InstantNgp for names that end in `.ngp.json`.
CameraPathFormat cameraPathFormatOf(const std::filesystem::path& file);

/// The movement of a scene's camera: its own keys, or one at each of `fps` frames a second where nodes move it; one key
/// for a camera that stands still. Throws Error(BadInput) for an animation of a million frames and more.
CameraPath cameraPathOf(const Scene& scene, int camera, float fps);

}  // namespace lumi
