#include "trace/spherical_rectangle.h"

#include <algorithm>
#include <cmath>

namespace lumi {

SphericalRectangle::SphericalRectangle(const Vec3& from, const Vec3& corner, const Vec3& edgeX, const Vec3& edgeY)
    : from_(from) {
    const float lengthX = glm::length(edgeX), lengthY = glm::length(edgeY);
    x_ = edgeX / lengthX;
    y_ = edgeY / lengthY;
    z_ = glm::cross(x_, y_);
    // The rectangle in local coordinates, with z pointing away from it.
    const Vec3 d = corner - from;
    z0_ = glm::dot(d, z_);
    if (z0_ > 0) z_ = -z_, z0_ = -z0_;
    x0_ = glm::dot(d, x_), x1_ = x0_ + lengthX;
    y0_ = glm::dot(d, y_), y1_ = y0_ + lengthY;

    // Normals of the planes through the eye and each edge, and the inner angles between them. A cross product of two
    // corners has one vanishing component, so only the two that remain are written.
    const auto unit2 = [](float a, float b) {
        const float length = std::sqrt(a * a + b * b);
        return Vec2(a / length, b / length);
    };
    const Vec2 n0 = unit2(z0_, -y0_);  // (., y, z): edge y = y0
    const Vec2 n1 = unit2(-z0_, x1_);  // (x, ., z): edge x = x1
    const Vec2 n2 = unit2(-z0_, y1_);  // edge y = y1
    const Vec2 n3 = unit2(z0_, -x0_);  // edge x = x0
    const auto angle = [](float cosine) { return std::acos(std::clamp(cosine, -1.0f, 1.0f)); };
    const float g0 = angle(-n0.y * n1.y), g1 = angle(-n1.y * n2.y), g2 = angle(-n2.y * n3.y), g3 = angle(-n3.y * n0.y);
    b0_ = n0.y;
    b1_ = n2.y;
    k_ = 2 * kPi - g2 - g3;
    solidAngle_ = g0 + g1 - k_;
    if (!(solidAngle_ > 0)) solidAngle_ = 0;
}

Vec3 SphericalRectangle::sample(Vec2 u) const {
    // The vertical plane that cuts off the share u.x of the solid angle.
    const float au = u.x * solidAngle_ + k_;
    const float fu = (std::cos(au) * b0_ - b1_) / std::sin(au);
    const float cu = std::clamp(std::copysign(1 / std::sqrt(fu * fu + b0_ * b0_), fu), -1.0f, 1.0f);
    const float sine = std::sqrt(std::max(0.0f, 1 - cu * cu));
    const float xu = std::clamp(sine > 0 ? -cu * z0_ / sine : (cu > 0 ? x1_ : x0_), x0_, x1_);
    // Along it, heights are uniform in the sine of elevation.
    const float d2 = xu * xu + z0_ * z0_;
    const float h0 = y0_ / std::sqrt(d2 + y0_ * y0_), h1 = y1_ / std::sqrt(d2 + y1_ * y1_);
    const float hv = h0 + u.y * (h1 - h0), hv2 = hv * hv;
    const float yv = hv2 < 1 - 1e-6f ? std::clamp(hv * std::sqrt(d2 / (1 - hv2)), y0_, y1_) : (hv > 0 ? y1_ : y0_);
    return from_ + xu * x_ + yv * y_ + z0_ * z_;
}

}  // namespace lumi
