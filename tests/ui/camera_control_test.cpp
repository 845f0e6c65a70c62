#include "ui/camera_control.h"

#include <gtest/gtest.h>

#include "math/transform.h"

namespace lumi {
namespace {

Camera front() {
    Camera camera;
    camera.eye = {0, 1, 5};
    camera.target = {0, 1, 0};
    return camera;
}

TEST(CameraControl, lookingAroundKeepsEyeAndDistance) {
    const Camera turned = lookAround(front(), 0.5f * kPi, 0);
    EXPECT_EQ(turned.eye, front().eye);
    EXPECT_NEAR(glm::distance(turned.eye, turned.target), 5, 1e-4);
    // A quarter turn to the left from -Z looks along -X.
    EXPECT_NEAR(turned.target.x, -5, 1e-4);
    EXPECT_NEAR(turned.target.z, 5, 1e-4);
}

TEST(CameraControl, pitchRaisesTheViewAndStopsAtThePole) {
    EXPECT_GT(lookAround(front(), 0, 0.3f).target.y, 1);
    const Camera up = lookAround(front(), 0, 10);
    const Vec3 direction = glm::normalize(up.target - up.eye);
    EXPECT_LT(direction.y, 1);
    EXPECT_GT(direction.y, 0.99f);
    EXPECT_LT(direction.z, 0) << "it tipped over";
}

TEST(CameraControl, aCameraWithoutUpOrViewStillMoves) {
    for (const Vec3& up : {Vec3(0), Vec3(0, 0, -1), Vec3(0, 1, 0)})
        for (const Vec3& target : {front().target, front().eye}) {
            Camera camera = front();
            camera.up = up, camera.target = target;
            for (const Camera& moved :
                 {lookAround(camera, 0.1f, 0.1f), orbit(camera, 0.1f, 0.1f), flyBy(camera, {1, 2, 3})})
                EXPECT_TRUE(isFinite(moved.eye) && isFinite(moved.target));
            EXPECT_NE(lookAround(camera, 0.1f, 0.2f).target, camera.target);
            EXPECT_GT(glm::distance(flyBy(camera, {0, 1, 0}).eye, camera.eye), 0.99f);
        }
}

TEST(CameraControl, orbitKeepsTargetAndDistance) {
    const Camera moved = orbit(front(), 1.1f, -0.4f);
    EXPECT_EQ(moved.target, front().target);
    EXPECT_NEAR(glm::distance(moved.eye, moved.target), 5, 1e-4);
    EXPECT_GT(moved.eye.y, 1) << "the pointer moves down and the camera rises";
}

TEST(CameraControl, flyingMovesAlongTheCamerasAxes) {
    const Camera moved = flyBy(front(), {1, 2, 3});
    EXPECT_NEAR(glm::distance(moved.eye, Vec3(1, 3, 2)), 0, 1e-5);
    EXPECT_NEAR(glm::distance(moved.target, Vec3(1, 3, -3)), 0, 1e-5);
}

TEST(CameraControl, slidingKeepsTheTargetUnderThePointer) {
    const Camera before = front();
    const Extent2 extent{400, 300};
    const Vec2 delta(37, -21);
    const Camera after = slide(before, delta, static_cast<float>(extent.height));
    const Vec3 seen = poseCamera(after, extent).project(before.target);
    EXPECT_NEAR(seen.x, 200 + delta.x, 0.01);
    EXPECT_NEAR(seen.y, 150 + delta.y, 0.01);
}

}  // namespace
}  // namespace lumi
