#include "trace/anisotropic_albedo.h"

#include <algorithm>
#include <cmath>

#include "trace/fresnel.h"
#include "trace/visible_normals.h"

namespace lumi {
namespace {

using Points = FibonacciLattice<144, 89>;

/// Isotropic facets of the roughness along the azimuth of `w`; along x if it has none.
Vec2 alongAzimuth(const Ggx& ggx, const Vec3& w) {
    const float x2 = w.x * w.x, y2 = w.y * w.y, sum = x2 + y2;
    const float share = sum > 1e-12f ? y2 / sum : 0;
    const float alpha = ggx.alpha * std::sqrt((1 - share) * sqr(ggx.stretch) + share * sqr(ggx.shrink));
    return SchlickAlbedo::get().directional(RoughnessRow(std::sqrt(alpha)), w.z);
}

Vec2 exact(const Ggx& ggx, const Vec3& wo) {
    const float lambdaO = ggx.lambda(wo);
    return meanOverVisibleNormals<Points>(ggx, wo, [&](const Vec3& h) {
        const float share = reflectedShare(ggx, wo, lambdaO, h), s = schlickWeight(glm::dot(wo, h));
        return Vec2(share * (1 - s), share * s);
    });
}

Vec3 directionAt(float cosTheta, float azimuth) {
    cosTheta = std::clamp(cosTheta, 1e-4f, 0.99999f);
    const float r = std::sqrt(1 - cosTheta * cosTheta);
    return {r * std::cos(azimuth), r * std::sin(azimuth), cosTheta};
}

Ggx facets(float roughnessX, float roughnessY) { return Ggx::anisotropic(sqr(roughnessX), sqr(roughnessY)); }
RoughnessRow rowAlongX(const Ggx& ggx, int rows) { return RoughnessRow(std::sqrt(ggx.alpha * ggx.stretch), rows); }
RoughnessRow rowAlongY(const Ggx& ggx, int rows) { return RoughnessRow(std::sqrt(ggx.alpha * ggx.shrink), rows); }

}  // namespace

const AnisotropicAlbedo& AnisotropicAlbedo::get() {
    static const AnisotropicAlbedo table;
    return table;
}

AnisotropicAlbedo::AnisotropicAlbedo() {
    difference_.resize(cell(kRows, 0) * kAzimuths * kColumns);
    average_.resize(cell(kRows, 0));
    for (int x = 0; x < kRows; ++x)
        for (int y = 0; y < kRows; ++y) {
            const Ggx ggx = facets(RoughnessRow::roughnessOf(x, kRows), RoughnessRow::roughnessOf(y, kRows));
            Vec2* out = &difference_[cell(x, y) * kAzimuths * kColumns];
            Vec2 sum(0);
            float weights = 0;
            for (int a = 0; a < kAzimuths; ++a)
                for (int column = 0; column < kColumns; ++column) {
                    const float root = static_cast<float>(column) / (kColumns - 1);
                    const Vec3 wo = directionAt(root * root, 0.5f * kPi * static_cast<float>(a) / (kAzimuths - 1));
                    const Vec2 found = exact(ggx, wo);
                    *out++ = found - alongAzimuth(ggx, wo);
                    const bool inner = column > 0 && column < kColumns - 1;
                    const float weight = (a > 0 && a < kAzimuths - 1 ? 1.0f : 0.5f) * (inner ? 1.0f : 0.5f) * root * root * root;
                    sum += weight * found;
                    weights += weight;
                }
            average_[cell(x, y)] = sum / weights;
        }
}

Vec2 AnisotropicAlbedo::difference(RoughnessRow x, RoughnessRow y, float cosTheta, float azimuth) const {
    const float column = std::sqrt(std::clamp(cosTheta, 0.0f, 1.0f)) * (kColumns - 1);
    const float sector = std::clamp(azimuth * (2 * kInvPi), 0.0f, 1.0f) * (kAzimuths - 1);
    const int c = std::min(static_cast<int>(column), kColumns - 2), a = std::min(static_cast<int>(sector), kAzimuths - 2);
    const float fc = column - static_cast<float>(c), fa = sector - static_cast<float>(a);
    Vec2 sum(0);
    for (int i = 0; i < 4; ++i) {
        const int dx = i & 1, dy = i >> 1;
        const float weight = (dx ? x.fraction : 1 - x.fraction) * (dy ? y.fraction : 1 - y.fraction);
        const Vec2* p = &difference_[(cell(x.row + dx, y.row + dy) * kAzimuths + static_cast<size_t>(a)) * kColumns +
                                     static_cast<size_t>(c)];
        sum += weight * glm::mix(glm::mix(p[0], p[1], fc), glm::mix(p[kColumns], p[kColumns + 1], fc), fa);
    }
    return sum;
}

Vec2 AnisotropicAlbedo::directional(const Ggx& ggx, const Vec3& w) const {
    const bool upright = w.x * w.x + w.y * w.y <= 1e-12f;
    const float azimuth = upright ? 0 : std::atan2(std::abs(w.y), std::abs(w.x));
    const Vec2 albedo = alongAzimuth(ggx, w) + difference(rowAlongX(ggx, kRows), rowAlongY(ggx, kRows), w.z, azimuth);
    const Vec2 positive = glm::max(albedo, Vec2(0));
    return positive / std::max(1.0f, positive.x + positive.y);
}

Vec2 AnisotropicAlbedo::average(const Ggx& ggx) const {
    const RoughnessRow x = rowAlongX(ggx, kRows), y = rowAlongY(ggx, kRows);
    return glm::mix(glm::mix(average_[cell(x.row, y.row)], average_[cell(x.row + 1, y.row)], x.fraction),
                    glm::mix(average_[cell(x.row, y.row + 1)], average_[cell(x.row + 1, y.row + 1)], x.fraction), y.fraction);
}

}  // namespace lumi
