#pragma once
#include "math/vector.h"

namespace lumi {

/// The solid angle that a right-angled rectangle fills as seen from a point, sampled uniformly
/// [Urena, Fajardo & King 2013, "An Area-Preserving Parametrization for Spherical Rectangles", section 4].
/// Differs from the paper: nowhere. Callers fall back to sampling by area where `solidAngle` is so small that single
/// precision loses it (below kLeast).
class SphericalRectangle {
public:
    static constexpr float kLeast = 0.01f;  ///< sr

    /// Rectangle with `corner` and edges `edgeX`, `edgeY` at a right angle, seen from `from`.
    SphericalRectangle(const Vec3& from, const Vec3& corner, const Vec3& edgeX, const Vec3& edgeY);

    float solidAngle() const { return solidAngle_; }
    /// The world point on the rectangle for u in [0,1)^2; density 1/solidAngle() per solid angle.
    Vec3 sample(Vec2 u) const;

private:
    Vec3 from_, x_, y_, z_;
    float x0_, x1_, y0_, y1_, z0_;
    float b0_, b1_, k_;
    float solidAngle_;
};

}  // namespace lumi
