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
                 {.label = "Field of view",
                  .min = 1,
                  .max = 170,
                  .unit = "deg",
                  .help = "Full vertical angle.",
                  .redo = Redo::Samples});
    });
    v.when(projection == Projection::Orthographic, [&] {
        v.number("y-mag", yMag,
                 {.label = "Half height",
                  .min = 1e-4,
                  .max = 1e6,
                  .scale = Scale::Log,
                  .unit = "m",
                  .help = "Half the height that the image shows.",
                  .redo = Redo::Samples});
    });
    v.number("aperture", aperture,
             {.label = "Aperture",
              .min = 0,
              .max = 10,
              .scale = Scale::Log,
              .unit = "m",
              .help = "Radius of the lens; 0 is a pinhole.",
              .redo = Redo::Samples});
    v.number("focus", focus,
             {.label = "Focus",
              .min = 1e-3,
              .max = 1e6,
              .scale = Scale::Log,
              .unit = "m",
              .help = "Distance to the plane in focus.",
              .redo = Redo::Samples});
    v.when(aperture > 0, [&] {
        v.choice("aperture-shape", apertureShape,
                 {.label = "Aperture shape",
                  .options = {"round", "bladed"},
                  .help = "What small bright things look like out of focus: a disk or a polygon.",
                  .redo = Redo::Samples});
        v.when(apertureShape == ApertureShape::Bladed, [&] {
            v.integer(
                "aperture-blades", apertureBlades,
                {.label = "Blades", .min = 3, .max = 16, .help = "Corners of the aperture.", .redo = Redo::Samples});
            v.number("aperture-rotation-deg", apertureRotationDeg,
                     {.label = "Blade rotation",
                      .min = -180,
                      .max = 180,
                      .unit = "deg",
                      .help = "Turns the aperture about the view direction.",
                      .redo = Redo::Samples});
        });
    });
    v.number("shutter", shutter,
             {.label = "Shutter",
              .min = 0,
              .max = 60,
              .scale = Scale::Log,
              .unit = "frames",
              .help = "How long the shutter is open from the frame's time on, in frames: 0.5 is film's half turn, 0 an "
                      "instant without motion blur.",
              .redo = Redo::Build});
    v.choice("stereo", eyeOfPair,
             {.label = "Stereo",
              .options = {"off", "left", "right"},
              .help = "Which eye of a stereo pair is shown; the two look in parallel.",
              .redo = Redo::Samples});
    v.when(eyeOfPair != StereoEye::Centre, [&] {
        v.number("interaxial", interaxial,
                 {.label = "Interaxial",
                  .min = 1e-4,
                  .max = 100,
                  .scale = Scale::Log,
                  .unit = "m",
                  .help = "Distance between the two eyes.",
                  .redo = Redo::Samples});
    });
}

namespace {

/// The inverse of a rigid frame: its rotation is transposed, which loses no digits.
Mat4 rigidInverse(const Mat4& frame) {
    const Mat3 rotation = glm::transpose(Mat3(frame));
    Mat4 inverse(rotation);
    inverse[3] = Vec4(-(rotation * Vec3(frame[3])), 1);
    return inverse;
}

}  // namespace

Vec3 CameraPose::project(const Vec3& positionWorld) const {
    const Vec3 p = transformPoint(cameraFromWorld, positionWorld);
    const float depth = -p.z;
    const float scale =
        static_cast<float>(extent.height) / (2 * halfHeight * (projection == Projection::Perspective ? depth : 1.0f));
    return {0.5f * static_cast<float>(extent.width) + p.x * scale,
            0.5f * static_cast<float>(extent.height) - p.y * scale, depth};
}

CameraPose poseCamera(const Camera& camera, Extent2 extent) {
    CameraPose pose;
    pose.worldFromCamera = lookAt(camera.eye, camera.target, camera.up);
    Vec3 eye = camera.eye;
    if (camera.eyeOfPair != StereoEye::Centre) {
        const float side = camera.eyeOfPair == StereoEye::Left ? -0.5f : 0.5f;
        eye += Vec3(pose.worldFromCamera[0]) * (side * camera.interaxial);
        pose.worldFromCamera[3] = Vec4(eye, 1);
    }
    pose.cameraFromWorld = rigidInverse(pose.worldFromCamera);
    pose.extent = extent;
    pose.projection = camera.projection;
    pose.halfHeight =
        camera.projection == Projection::Perspective ? std::tan(0.5f * radians(camera.fovYDeg)) : camera.yMag;
    pose.aperture = camera.aperture;
    pose.focus = camera.focus;
    pose.blades = camera.apertureShape == ApertureShape::Bladed ? camera.apertureBlades : 0;
    pose.bladeRotation = radians(camera.apertureRotationDeg);
    pose.shutter = camera.shutter;
    return pose;
}

CameraPose interpolate(const CameraPose& a, const CameraPose& b, float t) {
    CameraPose pose = a;
    const Quat from = glm::quat_cast(Mat3(a.worldFromCamera)), to = glm::quat_cast(Mat3(b.worldFromCamera));
    pose.worldFromCamera = glm::mat4_cast(glm::normalize(glm::slerp(from, to, t)));
    pose.worldFromCamera[3] = Vec4(glm::mix(a.position(), b.position(), t), 1);
    pose.cameraFromWorld = rigidInverse(pose.worldFromCamera);
    pose.halfHeight = glm::mix(a.halfHeight, b.halfHeight, t);
    pose.aperture = glm::mix(a.aperture, b.aperture, t);
    pose.focus = glm::mix(a.focus, b.focus, t);
    return pose;
}

}  // namespace lumi
