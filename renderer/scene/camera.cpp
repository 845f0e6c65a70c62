#include "scene/camera.h"

#include <cmath>

#include "math/transform.h"

namespace lumi {

void Camera::describe(ParameterVisitor& v) {
    v.vector("eye", eye, {.label = "Eye", .help = "Where the camera is."});
    v.vector("look-at", target, {.label = "Look at", .help = "The point in the middle of the image."});
    v.vector("up", up, {.label = "Up", .unit = "", .help = "The direction that is up in the image."});
    v.choice("projection", projection,
             {.label = "Projection",
              .options = {"perspective", "orthographic"},
              .help = "Perspective, or orthographic without foreshortening.",
              .redo = Redo::Samples});
    v.when(projection == Projection::Perspective, [&] {
        v.number("fov-y-deg", fovYDeg,
                 {.label = "Field of view", .min = 1, .max = 170, .unit = "deg", .help = "Full vertical angle.", .redo = Redo::Samples});
    });
    v.when(projection == Projection::Orthographic, [&] {
        v.number("y-mag", yMag,
                 {.label = "Half height", .min = 1e-4, .max = 1e6, .scale = Scale::Log, .unit = "m",
                  .help = "Half the height that the image shows.", .redo = Redo::Samples});
    });
    v.number("aperture", aperture,
             {.label = "Aperture", .min = 0, .max = 10, .unit = "m", .help = "Radius of the lens; 0 is a pinhole.", .redo = Redo::Samples});
    v.number("focus", focus,
             {.label = "Focus", .min = 1e-3, .max = 1e6, .scale = Scale::Log, .unit = "m",
              .help = "Distance to the plane in focus.", .redo = Redo::Samples});
}

Vec3 CameraPose::project(const Vec3& positionWorld) const {
    const Vec3 p = transformPoint(cameraFromWorld, positionWorld);
    const float depth = -p.z;
    const float scale = static_cast<float>(extent.height) /
                        (2 * halfHeight * (projection == Projection::Perspective ? depth : 1.0f));
    return {0.5f * static_cast<float>(extent.width) + p.x * scale,
            0.5f * static_cast<float>(extent.height) - p.y * scale, depth};
}

CameraPose poseCamera(const Camera& camera, Extent2 extent) {
    CameraPose pose;
    pose.worldFromCamera = lookAt(camera.eye, camera.target, camera.up);
    // A rigid frame: its inverse is the transpose, which loses no digits.
    const Mat3 rotation = glm::transpose(Mat3(pose.worldFromCamera));
    pose.cameraFromWorld = Mat4(rotation);
    pose.cameraFromWorld[3] = Vec4(-(rotation * camera.eye), 1);
    pose.extent = extent;
    pose.projection = camera.projection;
    pose.halfHeight = camera.projection == Projection::Perspective ? std::tan(0.5f * radians(camera.fovYDeg)) : camera.yMag;
    pose.aperture = camera.aperture;
    pose.focus = camera.focus;
    return pose;
}

}  // namespace lumi
