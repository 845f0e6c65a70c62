#pragma once
#include "math/vector.h"

namespace lumi {

/// Translation, rotation, scale, applied in the order scale, rotate, translate (glTF's).
struct Transform {
    Vec3 translation{0};
    Quat rotation{1, 0, 0, 0};
    Vec3 scale{1};

    Mat4 matrix() const;
    bool operator==(const Transform&) const = default;
};

/// Interpolates translation and scale linearly, rotation on the shorter great arc.
Transform interpolate(const Transform& a, const Transform& b, float t);

/// `v` made unit, however long or short it is; `otherwise` if it has no direction: it is zero or not finite.
Vec3 unitOr(const Vec3& v, const Vec3& otherwise);

inline Vec3 transformPoint(const Mat4& m, const Vec3& p) { return Vec3(m * Vec4(p, 1)); }
inline Vec3 transformVector(const Mat4& m, const Vec3& v) { return Vec3(m * Vec4(v, 0)); }

/// The matrix that carries normals along with `m` (inverse transpose, up to a positive factor); a matrix of zero
/// determinant gives its cofactor matrix, which is defined and finite.
Mat3 normalMatrix(const Mat4& m);

/// True if `m` turns right-handed frames into left-handed ones.
bool isMirroring(const Mat4& m);

/// Camera-to-world rotation and position looking from `eye` to `target`; the camera looks along -Z, +Y is up.
/// A view straight along `up` falls back to another up vector.
Mat4 lookAt(const Vec3& eye, const Vec3& target, const Vec3& up = Vec3(0, 1, 0));

/// Right-handed orthonormal frame around unit `z` [Duff 2017], continuous except at z = -Z.
struct Frame {
    Vec3 x, y, z;
    explicit Frame(const Vec3& unitZ);
    Frame(const Vec3& x_, const Vec3& y_, const Vec3& z_) : x(x_), y(y_), z(z_) {}
    Vec3 toLocal(const Vec3& v) const { return {glm::dot(v, x), glm::dot(v, y), glm::dot(v, z)}; }
    Vec3 toWorld(const Vec3& v) const { return x * v.x + y * v.y + z * v.z; }
};

}  // namespace lumi
