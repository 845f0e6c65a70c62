#include "math/transform.h"

#include <cmath>

namespace lumi {

Mat4 Transform::matrix() const {
    Mat4 m = glm::mat4_cast(rotation);
    m[0] *= scale.x, m[1] *= scale.y, m[2] *= scale.z;
    m[3] = Vec4(translation, 1);
    return m;
}

Transform interpolate(const Transform& a, const Transform& b, float t) {
    return {glm::mix(a.translation, b.translation, t), glm::normalize(glm::slerp(a.rotation, b.rotation, t)),
            glm::mix(a.scale, b.scale, t)};
}

Mat3 normalMatrix(const Mat4& m) {
    // Cofactors are the inverse transpose times the determinant; the determinant's sign is put back.
    const Vec3 x(m[0]), y(m[1]), z(m[2]);
    const Mat3 cofactor(glm::cross(y, z), glm::cross(z, x), glm::cross(x, y));
    return isMirroring(m) ? -cofactor : cofactor;
}

bool isMirroring(const Mat4& m) { return glm::dot(Vec3(m[0]), glm::cross(Vec3(m[1]), Vec3(m[2]))) < 0; }

Vec3 unitOr(const Vec3& v, const Vec3& otherwise) {
    const float length = glm::length(v), largest = maxComponent(glm::abs(v));
    if (length > 1e-18f && length < 1e18f) return v / length;  // its square is a plain float
    return largest > 0 && isFinite(v) ? glm::normalize(v / largest) : otherwise;
}

Mat4 lookAt(const Vec3& eye, const Vec3& target, const Vec3& up) {
    const Vec3 back = unitOr(eye - target, Vec3(0, 0, 1));
    const float height = glm::length(up);
    Vec3 right = glm::cross(height > 1e-3f && height < 1e6f ? up : unitOr(up, Vec3(0, 1, 0)), back);
    if (glm::length(right) < 1e-6f) right = glm::cross(std::abs(back.z) < 0.9f ? Vec3(0, 0, 1) : Vec3(1, 0, 0), back);
    right = glm::normalize(right);
    return Mat4(Vec4(right, 0), Vec4(glm::cross(back, right), 0), Vec4(back, 0), Vec4(eye, 1));
}

Frame::Frame(const Vec3& n) : z(n) {
    const float sign = std::copysign(1.0f, n.z);
    const float a = -1.0f / (sign + n.z);
    const float b = n.x * n.y * a;
    x = Vec3(1 + sign * n.x * n.x * a, sign * b, -sign * n.x);
    y = Vec3(b, sign + n.y * n.y * a, -n.y);
}

}  // namespace lumi
