#include "scene/camera_frame.h"

#include "math/transform.h"

namespace lumi {

Vec3 unitUp(const Camera& camera) {
    if (isBlack(camera.up)) return Vec3(lookAt(camera.eye, camera.target)[1]);
    // Seen from its own tip the up vector is what lies towards the eye.
    return Vec3(lookAt(camera.up, Vec3(0))[2]);
}

Vec3 viewDirection(const Camera& camera) { return -Vec3(lookAt(camera.eye, camera.target, camera.up)[2]); }

}  // namespace lumi
