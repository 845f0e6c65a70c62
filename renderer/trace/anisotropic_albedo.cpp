#include "trace/anisotropic_albedo.h"

#include "trace/fresnel.h"
#include "trace/visible_normals.h"

namespace lumi {
namespace {

/// The quadrature's own error, added so that what facets scatter more than once is not overstated.
constexpr float kMargin = 6e-4f;

Ggx facets(float roughnessX, float roughnessY) { return Ggx::anisotropic(sqr(roughnessX), sqr(roughnessY)); }
float roughnessX(const Ggx& ggx) { return std::sqrt(ggx.alpha * ggx.stretch); }
float roughnessY(const Ggx& ggx) { return std::sqrt(ggx.alpha * ggx.shrink); }
float meanSquare(const Ggx& ggx) { return 0.5f * sqr(ggx.alpha) * (sqr(ggx.stretch) + sqr(ggx.shrink)); }

/// Of the difference's table.
RoughnessRow evenRow(float roughness, int rows) {
    const float position = (roughness - kTabledRoughness) / (1 - kTabledRoughness) * static_cast<float>(rows - 1);
    RoughnessRow at;
    at.row = std::clamp(static_cast<int>(position), 0, rows - 2);
    at.fraction = std::clamp(position - static_cast<float>(at.row), 0.0f, 1.0f);
    return at;
}
float evenRoughness(int row, int rows) {
    return kTabledRoughness + (1 - kTabledRoughness) * static_cast<float>(row) / static_cast<float>(rows - 1);
}

/// GgxAlpha along this azimuth: FacetView wants nothing else of stretched facets.
float alphaAlong(const Ggx& ggx, float cosAzimuth, float sinAzimuth) {
    return ggx.alpha * std::sqrt(sqr(cosAzimuth * ggx.stretch) + sqr(sinAzimuth * ggx.shrink));
}

/// Quarter turns of the azimuth half way to the stretched one, and back to cosine and sine of the true one.
float tabledAzimuth(const Ggx& ggx, float x, float y) {
    return std::atan2(std::abs(y) * ggx.shrink, std::abs(x)) * (2 * kInvPi);
}
Vec2 trueAzimuth(const Ggx& ggx, float tabled) {
    return glm::normalize(Vec2(std::cos(tabled * kPi / 2), std::sin(tabled * kPi / 2) * ggx.stretch));
}

Vec2 exactSmooth(const Ggx& ggx, Vec2 azimuth, float cosTheta, float length) {
    const float c = std::max(cosTheta, 1e-5f), r = std::sqrt(std::max(0.0f, 1 - c * c));
    const Vec3 wo(r * azimuth.x, r * azimuth.y, c);
    const float lambdaO = ggx.lambda(wo);
    const Vec2 albedo = meanOverVisibleNormals<FibonacciLattice<610, 377>>(ggx, wo, [&](const Vec3& h) {
        const float share = reflectedShare(ggx, wo, lambdaO, h), s = schlickWeight(glm::dot(wo, h));
        return Vec2(share * (1 - s), share * s);
    });
    return SchlickAlbedo::joined(albedo, length);
}

}  // namespace

const AnisotropicAlbedo& AnisotropicAlbedo::get() {
    static const AnisotropicAlbedo table;
    return table;
}

AnisotropicAlbedo::AnisotropicAlbedo() {
    tabulateDifference();
    tabulateAverage();
}

void AnisotropicAlbedo::tabulateDifference() {
    difference_.resize(cell(kRows, 0));
    for (int x = 0; x < kRows; ++x)
        for (int y = 0; y <= x; ++y) {
            const Ggx ggx = facets(evenRoughness(x, kRows), evenRoughness(y, kRows));
            const RoughnessRow mean(std::sqrt(std::sqrt(meanSquare(ggx))));
            for (int a = 0; a < kAzimuths; ++a)
                for (int column = 0; column < kColumns; ++column) {
                    const Vec2 azimuth = trueAzimuth(ggx, static_cast<float>(a) / (kAzimuths - 1));
                    const float alpha = alphaAlong(ggx, azimuth.x, azimuth.y);
                    const float at = static_cast<float>(column) / (kColumns - 1);
                    const float cosTheta = FacetView::cosineAt(at, alpha);
                    Vec2 d = exactSmooth(ggx, azimuth, cosTheta, FacetView(alpha, cosTheta).length) -
                             SchlickAlbedo::get().smooth(mean, at);
                    d.x += kMargin;
                    difference_[cell(x, y) + static_cast<size_t>(a * kColumns + column)] = d;
                    // The same facets, turned.
                    difference_[cell(y, x) + static_cast<size_t>((kAzimuths - 1 - a) * kColumns + column)] = d;
                }
        }
}

void AnisotropicAlbedo::tabulateAverage() {
    constexpr int kSectors = 12, kSteps = 48;
    average_.resize(static_cast<size_t>(kMeanRows * kMeanRows));
    for (int x = 0; x < kMeanRows; ++x)
        for (int y = 0; y <= x; ++y) {
            const Ggx ggx = facets(evenRoughness(x, kMeanRows), evenRoughness(y, kMeanRows));
            Vec2 sum(0);
            for (int sector = 0; sector < kSectors; ++sector) {
                const float azimuth = kPi / 2 * (static_cast<float>(sector) + 0.5f) / kSectors;
                const float c = std::cos(azimuth), s = std::sin(azimuth), alpha = alphaAlong(ggx, c, s);
                float previous = 1;
                for (int i = 0; i < kSteps; ++i) {
                    // Steps crowd at the last column, as for isotropic facets.
                    const auto cosineAt = [&](float t) { return FacetView::cosineAt(1 - t * t, alpha); };
                    const float next = i + 1 < kSteps ? cosineAt(static_cast<float>(i + 1) / kSteps) : 0;
                    const float z = cosineAt((static_cast<float>(i) + 0.5f) / kSteps), r = std::sqrt(1 - z * z);
                    const Vec2 albedo = directional(ggx, {r * c, r * s, z});
                    sum += (previous * previous - next * next) / kSectors * Vec2(1 - albedo.x - albedo.y, albedo.y);
                    previous = next;
                }
            }
            sum.x /= meanSquare(ggx);
            average_[static_cast<size_t>(x * kMeanRows + y)] = average_[static_cast<size_t>(y * kMeanRows + x)] = sum;
        }
}

Vec2 AnisotropicAlbedo::difference(RoughnessRow x, RoughnessRow y, float column, float azimuth) const {
    const float along = column * (kColumns - 1), sector = std::clamp(azimuth, 0.0f, 1.0f) * (kAzimuths - 1);
    const int c = std::clamp(static_cast<int>(along), 0, kColumns - 2),
              a = std::min(static_cast<int>(sector), kAzimuths - 2);
    const float fc = along - static_cast<float>(c), fa = sector - static_cast<float>(a);
    Vec2 sum(0);
    for (int i = 0; i < 4; ++i) {
        const int dx = i & 1, dy = i >> 1;
        const float weight = (dx ? x.fraction : 1 - x.fraction) * (dy ? y.fraction : 1 - y.fraction);
        const Vec2* p = &difference_[cell(x.row + dx, y.row + dy) + static_cast<size_t>(a * kColumns + c)];
        sum += weight * glm::mix(glm::mix(p[0], p[1], fc), glm::mix(p[kColumns], p[kColumns + 1], fc), fa);
    }
    return sum;
}

Vec2 AnisotropicAlbedo::directional(const Ggx& ggx, const Vec3& w) const {
    const float side2 = w.x * w.x + w.y * w.y, scale = side2 > 1e-12f ? 1 / std::sqrt(side2) : 0;
    const Vec2 azimuth = scale > 0 ? Vec2(w.x, w.y) * scale : Vec2(1, 0);
    const FacetView view(alphaAlong(ggx, azimuth.x, azimuth.y), w.z);
    const RoughnessRow mean(std::sqrt(std::sqrt(meanSquare(ggx))));
    Vec2 smooth = SchlickAlbedo::get().smooth(mean, view.column) +
                  difference(evenRow(roughnessX(ggx), kRows), evenRow(roughnessY(ggx), kRows), view.column,
                             tabledAzimuth(ggx, azimuth.x, azimuth.y));
    smooth.x = std::clamp(smooth.x, 0.0f, 1.0f);
    return SchlickAlbedo::split(smooth, view.length);
}

Vec2 AnisotropicAlbedo::average(const Ggx& ggx) const {
    const RoughnessRow x = evenRow(roughnessX(ggx), kMeanRows), y = evenRow(roughnessY(ggx), kMeanRows);
    const auto at = [&](int dx, int dy) {
        return average_[static_cast<size_t>((x.row + dx) * kMeanRows + y.row + dy)];
    };
    const Vec2 mean =
        glm::mix(glm::mix(at(0, 0), at(1, 0), x.fraction), glm::mix(at(0, 1), at(1, 1), x.fraction), y.fraction);
    return {1 - mean.x * meanSquare(ggx) - mean.y, mean.y};
}

}  // namespace lumi
