#include <gtest/gtest.h>

#include <glm/gtc/matrix_inverse.hpp>

#include "math/hash.h"
#include "math/transform.h"
#include "math/warp.h"

namespace lumi {
namespace {

float random(uint32_t i) { return unitFloat(pcgHash(i)); }
Vec3 randomDirection(uint32_t i) { return sampleSphere({random(2 * i), random(2 * i + 1)}); }
void expectNear(const Vec3& a, const Vec3& b, float tolerance) {
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(a[c], b[c], tolerance);
}
Mat4 randomMatrix(uint32_t i) {
    Mat4 m(1);
    for (int c = 0; c < 3; ++c)
        m[c] = Vec4(
            2 * random(16 * i + 3 * static_cast<uint32_t>(c)) * randomDirection(i * 7 + static_cast<uint32_t>(c)), 0);
    m[3] = Vec4(randomDirection(i * 7 + 5), 1);
    return m;
}

TEST(Transform, ScalesThenRotatesThenMoves) {
    const Transform t{Vec3(10, 20, 30), glm::angleAxis(radians(90), Vec3(0, 1, 0)), Vec3(2, 3, 4)};
    // +X scaled to (2,0,0), turned to -Z, moved.
    expectNear(transformPoint(t.matrix(), Vec3(1, 0, 0)), Vec3(10, 20, 28), 1e-5f);
    expectNear(transformVector(t.matrix(), Vec3(0, 1, 0)), Vec3(0, 3, 0), 1e-6f);
    EXPECT_EQ(Transform().matrix(), Mat4(1));
}

TEST(Transform, InterpolationMeetsItsEndsAndTakesTheShortWay) {
    const Transform a{Vec3(0), Quat(1, 0, 0, 0), Vec3(1)},
        b{Vec3(2), -glm::angleAxis(radians(80), Vec3(0, 0, 1)), Vec3(3)};
    const Transform middle = interpolate(a, b, 0.5f);
    EXPECT_EQ(middle.translation, Vec3(1));
    EXPECT_EQ(middle.scale, Vec3(2));
    expectNear(middle.rotation * Vec3(1, 0, 0), {std::cos(radians(40)), std::sin(radians(40)), 0}, 1e-5f);
    expectNear(interpolate(a, b, 1).rotation * Vec3(1, 0, 0), b.rotation * Vec3(1, 0, 0), 1e-6f);
}

TEST(Transform, NormalsStayPerpendicular) {
    for (uint32_t i = 0; i < 200; ++i) {
        const Mat4 m = randomMatrix(i);
        const Vec3 normal = randomDirection(1000 + i);
        const Frame frame(normal);
        const Vec3 moved = glm::normalize(normalMatrix(m) * normal);
        const Vec3 inverse = glm::normalize(glm::inverseTranspose(Mat3(m)) * normal);
        expectNear(moved, inverse, 3e-3f);
        EXPECT_NEAR(glm::dot(moved, glm::normalize(transformVector(m, frame.x))), 0, 3e-3f);
        EXPECT_EQ(isMirroring(m), glm::determinant(Mat3(m)) < 0);
    }
}

TEST(Transform, FlattenedMatricesStillHaveNormals) {
    Mat4 flat(1);
    flat[1] = Vec4(0);
    const Vec3 normal = normalMatrix(flat) * Vec3(0, 1, 0);
    EXPECT_EQ(normal, Vec3(0, 1, 0));
    EXPECT_FALSE(isMirroring(flat));
    Mat4 mirror(1);
    mirror[0] = -mirror[0];
    EXPECT_TRUE(isMirroring(mirror));
    expectNear(normalMatrix(mirror) * Vec3(1, 0, 0), Vec3(-1, 0, 0), 1e-6f);
}

TEST(Transform, LookAtLooksAlongMinusZ) {
    for (const Vec3& target : {Vec3(1, 2, 8), Vec3(1, 9, 3), Vec3(1, -9, 3), Vec3(-5, 4, 0)}) {
        const Vec3 eye(1, 2, 3);
        const Mat4 m = lookAt(eye, target);
        expectNear(transformVector(m, Vec3(0, 0, -1)), glm::normalize(target - eye), 1e-5f);
        EXPECT_EQ(Vec3(m[3]), eye);
        EXPECT_NEAR(glm::determinant(Mat3(m)), 1, 1e-5f);
        EXPECT_GE(transformVector(m, Vec3(0, 1, 0)).y, -1e-5f);
        expectNear(Mat3(m) * glm::transpose(Mat3(m)) * Vec3(1, 2, 3), Vec3(1, 2, 3), 1e-5f);
    }
    EXPECT_TRUE(isFinite(Vec3(lookAt(Vec3(1), Vec3(1))[0])));
}

TEST(Transform, LookAtIsAFrameWhateverItIsGiven) {
    const Vec3 vectors[] = {
        Vec3(0),           Vec3(0, 1, 0),         Vec3(0, 0, 1),           Vec3(1e-30f, 0, 0),   Vec3(3e38f, -3e38f, 0),
        Vec3(0, 1e20f, 0), Vec3(1e-9f, 1, 1e-9f), Vec3(1e9f, 1e9f, -1e9f), Vec3(kInfinity, 0, 0)};
    for (const Vec3& eye : vectors)
        for (const Vec3& target : vectors)
            for (const Vec3& up : vectors) {
                const Mat3 m(lookAt(eye, target, up));
                expectNear(m * glm::transpose(m) * Vec3(1, 2, 3), Vec3(1, 2, 3), 1e-4f);
            }
    expectNear(Vec3(lookAt({0, 0, 5}, {0, 0, 0}, {0, 0, 0})[1]), {0, 1, 0}, 1e-6f);
}

TEST(Transform, FramesAreRightHandedAndOrthonormal) {
    for (uint32_t i = 0; i < 2000; ++i) {
        const Vec3 z = i == 0 ? Vec3(0, 0, -1) : i == 1 ? Vec3(0, 0, 1) : randomDirection(i);
        const Frame frame(z);
        expectNear(glm::cross(frame.x, frame.y), z, 1e-5f);
        EXPECT_NEAR(glm::dot(frame.x, z), 0, 1e-5f);
        EXPECT_NEAR(glm::length(frame.x), 1, 1e-5f);
        const Vec3 v = randomDirection(i + 5000);
        expectNear(frame.toWorld(frame.toLocal(v)), v, 1e-5f);
    }
}

TEST(Bounds, GrowAndMeasure) {
    Bounds3 box;
    EXPECT_TRUE(box.empty());
    EXPECT_EQ(box.size(), Vec3(0));
    box.extend(Vec3(1, 2, 3));
    box.extend(Bounds3{});
    EXPECT_FALSE(box.empty());
    box.extend(Vec3(-1, 2, 5));
    EXPECT_EQ(box.centre(), Vec3(0, 2, 4));
    EXPECT_EQ(box.size(), Vec3(2, 0, 2));
}

}  // namespace
}  // namespace lumi
