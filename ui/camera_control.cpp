#include "ui/camera_control.h"

#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>

#include "math/transform.h"
#include "scene/camera_frame.h"

namespace lumi {

namespace {

constexpr float kNearestToPole = 0.02f;  ///< radians left between the view and the up vector

Vec3 rotated(const Vec3& v, float angle, const Vec3& axis) {
    return Vec3(glm::rotate(Mat4(1), angle, axis) * Vec4(v, 0));
}

Vec3 rightOf(const Camera& camera) { return Vec3(lookAt(camera.eye, camera.target, camera.up)[0]); }

/// `direction` turned by yaw around up and by pitch around right, kept off the poles.
Vec3 turned(const Camera& camera, const Vec3& direction, float yaw, float pitch) {
    const Vec3 up = unitUp(camera);
    const float fromUp = std::acos(std::clamp(glm::dot(viewDirection(camera), up), -1.0f, 1.0f));
    const float newFromUp = std::clamp(fromUp - pitch, kNearestToPole, kPi - kNearestToPole);
    const Vec3 pitched = rotated(direction, fromUp - newFromUp, rightOf(camera));
    return rotated(pitched, yaw, up);
}

}  // namespace

Camera lookAround(Camera camera, float yaw, float pitch) {
    const Vec3 arm = camera.target - camera.eye;
    camera.target = camera.eye + turned(camera, isBlack(arm) ? viewDirection(camera) : arm, yaw, pitch);
    return camera;
}

Camera flyBy(Camera camera, const Vec3& rightUpForward) {
    const Mat4 frame = lookAt(camera.eye, camera.target, camera.up);
    const Vec3 move =
        Vec3(frame[0]) * rightUpForward.x + unitUp(camera) * rightUpForward.y - Vec3(frame[2]) * rightUpForward.z;
    camera.eye += move;
    camera.target += move;
    return camera;
}

Camera orbit(Camera camera, float yaw, float pitch) {
    camera.eye = camera.target - turned(camera, camera.target - camera.eye, yaw, pitch);
    return camera;
}

Camera slide(Camera camera, Vec2 deltaPx, float height) {
    const Mat4 frame = lookAt(camera.eye, camera.target, camera.up);
    const float visible = camera.projection == Projection::Orthographic
                              ? 2 * camera.yMag
                              : 2 * std::tan(0.5f * radians(camera.fovYDeg)) * glm::distance(camera.eye, camera.target);
    const float metresPerPixel = visible / std::max(height, 1.0f);
    const Vec3 move = (Vec3(frame[0]) * -deltaPx.x + Vec3(frame[1]) * deltaPx.y) * metresPerPixel;
    camera.eye += move;
    camera.target += move;
    return camera;
}

}  // namespace lumi
