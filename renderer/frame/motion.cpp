#include "frame/motion.h"

#include <cmath>

#include "math/transform.h"

namespace lumi {
namespace {

Vec3 finiteOrZero(const Vec3& v) { return isFinite(v) ? v : Vec3(0); }

/// The camera at the world's origin: it sees directions as points.
CameraPose atOrigin(CameraPose camera) {
    camera.worldFromCamera[3] = camera.cameraFromWorld[3] = Vec4(0, 0, 0, 1);
    return camera;
}

}  // namespace

Vec3 surfaceMotion(const CameraPose& camera, const CameraPose& previousCamera, const Vec3& position,
                   const Vec3& previousPosition) {
    const Vec3 before = previousCamera.project(previousPosition);
    if (previousCamera.projection == Projection::Perspective && !(before.z > 0)) return kNoPreviousPixel;
    return finiteOrZero(before - camera.project(position));
}

Vec3 skyMotion(const CameraPose& camera, const CameraPose& previousCamera, const Vec3& direction) {
    // Parallel rays have no vanishing point to follow.
    if (camera.projection != Projection::Perspective || previousCamera.projection != Projection::Perspective)
        return Vec3(0);
    // Only rotation moves what is infinitely far.
    const Vec3 now = atOrigin(camera).project(direction);
    const Vec3 before = atOrigin(previousCamera).project(direction);
    if (!(before.z > 0) || !(now.z > 0)) return kNoPreviousPixel;
    return finiteOrZero(Vec3(before.x - now.x, before.y - now.y, 0));
}

Vec2 inverseDepthGradient(const CameraPose& camera, const Vec3& position, const Vec3& normal) {
    const Vec3 p = transformPoint(camera.cameraFromWorld, position);
    const Vec3 n = transformVector(camera.cameraFromWorld, normal);
    const float scale = camera.pixelSize();
    Vec2 gradient(0);
    if (camera.projection == Projection::Perspective) {
        // On the ray (X, Y, -1) t the plane n.x = c lies at 1/t = n.(X, Y, -1)/c, affine in X and Y.
        const float c = glm::dot(n, p);
        gradient = Vec2(n.x, -n.y) * (scale / c);
    } else {
        // Depth t = (n.x X + n.y Y - c)/n.z is affine; its reciprocal changes by -1/t^2 of that.
        gradient = Vec2(n.x, -n.y) * (scale / n.z) * (-1 / sqr(p.z));
    }
    return std::isfinite(gradient.x) && std::isfinite(gradient.y) ? gradient : Vec2(0);
}

}  // namespace lumi
