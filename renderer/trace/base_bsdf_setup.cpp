#include "trace/base_bsdf.h"

#include <algorithm>
#include <cmath>

#include "trace/fresnel.h"
#include "trace/visible_normals.h"

namespace lumi {
namespace {

/// Below this product of ggxAlpha and |eta - 1| a refracted lobe is narrower than its half vector can be computed.
constexpr float kDeltaRefraction = 2e-5f;
/// Below this a highlight is not stretched.
constexpr float kLeastAnisotropy = 1e-3f;

/// To [0, limit]; not a number becomes 0.
Vec3 nonNegative(const Vec3& c, float limit) { return saturate(c / limit) * limit; }

Vec3 usableDirection(Vec3 wo) {
    if (!isFinite(wo)) return {0, 0, 1};
    wo.z = std::max(wo.z, kMinCosine);
    return glm::normalize(wo);
}

/// m of the class's comment.
float manyBounces(float favg, float eavg) { return sqr(favg) * eavg / (1 - favg * (1 - eavg)); }
/// Mean of Schlick's term over the hemisphere weighted by the cosine.
float schlickMean(float f0, float f90) { return f0 + (f90 - f0) / 21; }

/// Sums over facets, for the albedos of a film.
struct FilmSums {
    Vec3 reflected{0};                        ///< by the film, of what leaves the facets
    float all = 0, through = 0, bareThrough = 0;  ///< all of that; what a boundary transmits under the film, and bare
    explicit FilmSums(float = 0) {}
    FilmSums& operator+=(const FilmSums& o) {
        reflected += o.reflected, all += o.all, through += o.through, bareThrough += o.bareThrough;
        return *this;
    }
    friend FilmSums operator*(float weight, FilmSums s) {
        s.reflected *= weight, s.all *= weight, s.through *= weight, s.bareThrough *= weight;
        return s;
    }
};

}  // namespace

BaseBsdf::BaseBsdf(const BsdfInputs& inputs, const Vec3& wo) : wo_(usableDirection(wo)) {
    const float metallic = saturate(inputs.metallic), transmitting = saturate(inputs.transmission);
    const float opaque = (1 - metallic) * (1 - transmitting), boundary = (1 - metallic) * transmitting;
    const float specular = saturate(inputs.specular);
    const float ior = inputs.ior >= 0 ? std::min(inputs.ior, 100.0f) : 1.5f;
    const Vec3 baseColor = saturate(inputs.baseColor), specularColor = nonNegative(inputs.specularColor, 1e4f);

    setFacets(inputs, saturate(inputs.roughness));
    solid_ = inputs.solid;

    const Vec3 layerF0 = glm::min(sqr((ior - 1) / (ior + 1)) * specularColor, Vec3(1)) * specular;
    f0_ = opaque * layerF0 + metallic * baseColor;
    f90_ = opaque * specular + metallic;
    const bool inside = solid_ && !inputs.entering;
    if (inputs.layered && inputs.layers.iridescence > 0 && !inside)
        setFilm(inputs.layers, (1 - metallic) * layerF0 + metallic * baseColor, opaque * specular + metallic + boundary);
    if (inputs.multipleScattering && !smooth_) {
        const float eavg = schlickAverage().x + schlickAverage().y;
        layerMultiple_ = manyBounces(schlickMean(maxComponent(layerF0), specular), eavg);
        setMultiple(opaque + metallic);
    }

    hasBoundary_ = boundary > 0;
    if (hasBoundary_) {
        const float rounded = DielectricAlbedo::roundedIor(ior);
        eta_ = inside ? 1 / rounded : rounded;
        // Total reflection knows no tint, so the inside of a solid has none.
        boundaryTint_ = inside ? Vec3(boundary) : boundary * glm::min(specular * specularColor, Vec3(1));
        transmissionTint_ = boundary * (solid_ ? glm::sqrt(baseColor) : baseColor);
    }
    setSpecular(inside);
    if (hasFilm_) applyFilm();
    if (opaque > 0) {
        if (hasFilm_) setDiffuseUnderFilm(opaque * baseColor, specular);
        else setDiffuse(opaque * baseColor, maxComponent(layerF0), specular);
    }
    chooseProbabilities();
}

void BaseBsdf::setFacets(const BsdfInputs& inputs, float roughness) {
    smooth_ = roughness < kDeltaRoughness;
    ggx_.alpha = sqr(std::max(roughness, kDeltaRoughness));
    const float anisotropy = inputs.layered ? saturate(inputs.layers.anisotropy) : 0;
    if (anisotropy > kLeastAnisotropy) {
        smooth_ = false;
        ggx_ = Ggx::anisotropic(ggx_.alpha + (1 - ggx_.alpha) * sqr(anisotropy), ggx_.alpha);
        roughness = std::sqrt(ggx_.alpha);
    }
    row_ = RoughnessRow(roughness);
    lambdaO_ = ggx_.lambda(wo_);
}

void BaseBsdf::setFilm(const LayerInputs& layers, const Vec3& baseF0, float reflecting) {
    hasFilm_ = true;
    filmShare_ = saturate(layers.iridescence);
    filmReflecting_ = filmShare_ * reflecting;
    const float ior = layers.iridescenceIor >= 1 ? std::min(layers.iridescenceIor, 10.0f) : 1.3f;
    const float thickness = layers.iridescenceThickness > 0 ? std::min(layers.iridescenceThickness, 1e5f) : 0;
    film_ = ThinFilm(ior, thickness, saturate(baseF0));
}

void BaseBsdf::setMultiple(float share) {
    if (!(share > 0)) return;
    const Vec2 mean = schlickAverage();
    const float eavg = mean.x + mean.y;
    const Vec3 film = hasFilm_ ? film_.averageReflectance() : Vec3(0);
    for (int c = 0; c < 3; ++c) {
        const float bare = schlickMean(f0_[c], f90_) / share;
        multiple_[c] = share * manyBounces(std::min(bare + (film[c] * f90_ / share - bare) * filmShare_, 1.0f), eavg);
    }
    multipleAlbedo_ = multiple_ * multipleBelow(wo_);
    multipleScale_ = multipleAlbedo_ * (kInvPi / std::max(1 - eavg, 1e-4f));
}

void BaseBsdf::setDiffuse(const Vec3& rho, float f0, float f90) {
    layerF0_ = f0 - layerMultiple_, layerF90_ = f90 - layerMultiple_;
    const Vec2 fresnel(layerF0_, layerF90_);
    const Vec2 mean = schlickAverage();
    const float below = std::max(0.0f, 1 - (glm::dot(schlickAlbedo(wo_), fresnel) + layerMultiple_));
    albedo_[kDiffuse] = rho * below;
    diffuseScale_ = albedo_[kDiffuse] * (kInvPi / std::max(1 - (glm::dot(mean, fresnel) + layerMultiple_), 1e-4f));
}

void BaseBsdf::setDiffuseUnderFilm(const Vec3& rho, float specular) {
    const Vec2 schlick = schlickAlbedo(wo_);
    const float bare = glm::dot(schlick, Vec2(maxComponent(f0_), f90_));
    const float film = specular * maxComponent(filmAlbedo_) * (schlick.x + schlick.y);
    const float many = std::max(layerMultiple_, maxComponent(multiple_)) * (1 - schlick.x - schlick.y);
    layerMultiple_ = 0;
    albedo_[kDiffuse] = rho * std::max(0.0f, 1 - (bare + (film - bare) * filmShare_ + many));
    diffuseScale_ = albedo_[kDiffuse] * kInvPi;
}

void BaseBsdf::setSpecular(bool inside) {
    const Vec2 schlick = schlickAlbedo(wo_);
    albedo_[kReflection] = f0_ * schlick.x + Vec3(f90_ * schlick.y);
    deltaTransmission_ = smooth_;
    if (!hasBoundary_) return;

    Vec2 boundary;  // reflected, transmitted
    if (smooth_) {
        boundary.x = fresnelDielectric(wo_.z, eta_);
        boundary.y = 1 - boundary.x;
    } else {
        boundary = DielectricAlbedo::get(inside ? 1 / eta_ : eta_, !inside).directional(row_, wo_.z);
        if (!solid_) boundary.y = std::max(0.0f, schlick.x + schlick.y - boundary.x);
        deltaTransmission_ = solid_ && ggx_.alpha * std::abs(eta_ - 1) < kDeltaRefraction;
    }
    albedo_[kReflection] += boundaryTint_ * boundary.x;
    albedo_[kTransmission] = transmissionTint_ * boundary.y;
}

/// Exchanges the film's share of albedos for what the film reflects, by a mean over the facets that wo sees.
void BaseBsdf::applyFilm() {
    const Vec2 schlick = schlickAlbedo(wo_);
    const auto atFacet = [&](float cosTheta, float share) {
        FilmSums sums;
        const Vec3 reflectance = film_.reflectance(std::min(cosTheta, 1.0f));
        sums.reflected = reflectance * share;
        sums.all = share;
        if (!hasBoundary_) return sums;
        const float passed = solid_ ? 1 : share;
        sums.through = passed * (1 - maxComponent(reflectance));
        sums.bareThrough = passed * (1 - fresnelDielectric(std::min(cosTheta, 1.0f), eta_));
        return sums;
    };
    const FilmSums sums = smooth_ ? atFacet(wo_.z, 1) : meanOverVisibleNormals<FibonacciLattice<34, 21>>(ggx_, wo_, [&](const Vec3& h) {
        return atFacet(glm::dot(wo_, h), reflectedShare(ggx_, wo_, lambdaO_, h));
    });
    filmAlbedo_ = sums.all > 0 ? sums.reflected / sums.all : Vec3(0);
    const Vec3 film = filmReflecting_ * filmAlbedo_ * (schlick.x + schlick.y);
    albedo_[kReflection] = albedo_[kReflection] * (1 - filmShare_) + film;
    const float through = sums.bareThrough > 0 ? sums.through / sums.bareThrough : 0;
    albedo_[kTransmission] *= 1 - filmShare_ + filmShare_ * through;
}

}  // namespace lumi
