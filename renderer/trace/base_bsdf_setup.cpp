#include "trace/base_bsdf.h"

#include <algorithm>
#include <cmath>

#include "trace/fresnel.h"
#include "trace/visible_normals.h"

namespace lumi {
namespace {

/// Below this product of ggxAlpha and |eta - 1| a refracted lobe is narrower than its half vector can be computed.
constexpr float kDeltaRefraction = 2e-5f;
/// A film may reflect this much more than its mean over few facets says.
constexpr float kFilmMargin = 1.01f;
/// Mean losses below this are none.
constexpr float kLeastLoss = 1e-7f;
/// Below this a highlight is not stretched.
constexpr float kLeastAnisotropy = 1e-3f;

using NarrowLattice = FibonacciLattice<34, 21>;
using WideLattice = FibonacciLattice<144, 89>;

/// To [0, limit]; not a number becomes 0.
Vec3 nonNegative(const Vec3& c, float limit) { return saturate(c / limit) * limit; }

Vec3 usableDirection(Vec3 wo) {
    if (!isFinite(wo)) return {0, 0, 1};
    wo.z = std::max(wo.z, kMinCosine);
    return glm::normalize(wo);
}

/// m of the class's comment.
float manyBounces(float favg, float eavg) { return sqr(favg) * eavg / (1 - favg * (1 - eavg)); }
/// F0 of KHR_materials_specular before its weight.
Vec3 dielectricF0(float ior, const Vec3& specularColor) {
    return glm::min(sqr((ior - 1) / (ior + 1)) * specularColor, Vec3(1));
}
/// Mean of Schlick's term over the hemisphere weighted by the cosine.
float schlickMean(float f0, float f90) { return f0 + (f90 - f0) / 21; }

/// Sums over facets, for the albedos of a film.
struct FilmSums {
    Vec3 reflected{0};                            ///< by the film, of what leaves the facets
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
    const float ior = inputs.ior >= 0 ? std::min(inputs.ior, 1e6f) : 1.5f;
    const Vec3 baseColor = saturate(inputs.baseColor), specularColor = nonNegative(inputs.specularColor, 1e4f);

    setFacets(inputs, saturate(inputs.roughness));
    solid_ = inputs.solid;
    specular_ = saturate(inputs.specular);
    const bool inside = solid_ && !inputs.entering;
    boundaryShare_ = boundary;
    hasBoundary_ = boundary > 0;
    if (hasBoundary_) setBoundary(ior, specularColor, inside);
    if (boundary < 1 || !solid_ || inputs.layered || fresnel_.usesAll()) schlickO_ = schlickTowards(opaque > 0);

    const Vec3 layerF0 = dielectricF0(ior, specularColor) * specular_;
    f0_ = opaque * layerF0 + metallic * baseColor;
    f90_ = opaque * specular_ + metallic;
    if (inputs.layered && inputs.layers.iridescence > 0 && !inside)
        setFilm(inputs.layers, (1 - metallic) * layerF0 + metallic * baseColor, (1 - metallic) * specular_ + metallic);
    const bool multiple = inputs.multipleScattering && !smooth_;
    usesSchlick_ = opaque > 0 || (multiple && metallic > 0);
    if (usesSchlick_ || (multiple && boundary > 0)) schlickMean_ = schlickAverage();
    if (multiple) {
        const float eavg = schlickMean_.x + schlickMean_.y;
        layerMultiple_ = manyBounces(schlickMean(maxComponent(layerF0), specular_), eavg);
        setMultiple(opaque + metallic);
    }

    transmissionTint_ = boundary * (solid_ ? glm::sqrt(baseColor) : baseColor);
    setSpecular(inside, inputs.multipleScattering);
    if (hasFilm_) applyFilm();
    if (opaque > 0) setDiffuse(opaque * baseColor, maxComponent(layerF0), specular_);
    if (opaque > 0 && hasFilm_) setDiffuseUnderFilm(opaque * baseColor);
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

void BaseBsdf::setBoundary(float ior, const Vec3& specularColor, bool inside) {
    const float rounded = DielectricAlbedo::roundedIor(ior);
    eta_ = inside ? 1 / rounded : rounded;
    // What tables cannot bend any more still reflects as its index says.
    if (std::abs(ior - rounded) < 1e-3f) ior = rounded;
    fresnel_ = BoundaryFresnel(dielectricF0(rounded, Vec3(1)).x, dielectricF0(ior, specularColor), specular_);
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
    const float eavg = schlickMean_.x + schlickMean_.y;
    const Vec3 film = hasFilm_ ? film_.averageReflectance() : Vec3(0);
    filmMultiple_ = manyBounces(specular_ * maxComponent(film), eavg);
    for (int c = 0; c < 3; ++c) {
        const float bare = schlickMean(f0_[c], f90_) / share;
        multiple_[c] = share * manyBounces(std::min(bare + (film[c] * f90_ / share - bare) * filmShare_, 1.0f), eavg);
    }
    multipleAlbedo_ = multiple_ * std::max(0.0f, 1 - schlickO_.x - schlickO_.y);
    multipleScale_ = multipleAlbedo_ * (kInvPi / std::max(1 - eavg, kLeastLoss));
}

void BaseBsdf::setDiffuse(const Vec3& rho, float f0, float f90) {
    layerF0_ = f0 - layerMultiple_, layerF90_ = f90 - layerMultiple_;
    const Vec2 fresnel(layerF0_, layerF90_);
    const float below = std::max(0.0f, 1 - (glm::dot(schlickO_, fresnel) + layerMultiple_));
    albedo_[kDiffuse] = rho * below;
    diffuseScale_ =
        albedo_[kDiffuse] * (kInvPi / std::max(1 - (glm::dot(schlickMean_, fresnel) + layerMultiple_), 1e-4f));
}

/// Exchanges the film's share of the diffuse lobe.
void BaseBsdf::setDiffuseUnderFilm(const Vec3& rho) {
    const float once = schlickO_.x + schlickO_.y;
    const float film = kFilmMargin * specular_ * maxComponent(filmAlbedo_) * once + filmMultiple_ * (1 - once);
    const Vec3 under = rho * (filmShare_ * std::max(0.0f, 1 - film));
    diffuseUnderFilm_ = under * kInvPi;
    diffuseScale_ *= 1 - filmShare_;
    albedo_[kDiffuse] = albedo_[kDiffuse] * (1 - filmShare_) + under;
}

void BaseBsdf::setSpecular(bool inside, bool multiple) {
    albedo_[kReflection] = f0_ * schlickO_.x + Vec3(f90_ * schlickO_.y);
    deltaTransmission_ = smooth_ || (hasBoundary_ && solid_ && ggx_.alpha * std::abs(eta_ - 1) < kDeltaRefraction);
    if (!hasBoundary_) return;
    boundaryRow_ = RoughnessRow(std::sqrt(ggx_.alpha), DielectricAlbedo::kRows);
    const bool tabled = solid_ && !deltaTransmission_ && !ggx_.isAnisotropic();
    if (tabled) {
        const float ior = inside ? 1 / eta_ : eta_;
        near_.exact = &DielectricAlbedo::get(ior, !inside), far_.exact = &DielectricAlbedo::get(ior, inside);
        if (fresnel_.usesClear())
            near_.clear = &DielectricAlbedo::get(ior, !inside, true),
            far_.clear = &DielectricAlbedo::get(ior, inside, true);
    }
    const BoundarySums once = boundaryAlbedo(inside);
    albedo_[kReflection] += boundaryShare_ * fresnel_.reflected(schlickO_.x + schlickO_.y, once.exact.x, once.clear.x);
    albedo_[kTransmission] = transmissionTint_ * fresnel_.through(once.exact.y, once.clear.y);
    // Stretched facets of a solid have no table of losses: they keep to single scattering.
    if (multiple && !deltaTransmission_ && (tabled || !solid_)) setBoundaryMultiple();
}

/// Albedo towards wo under Schlick's term. The table of stretched facets knows its sum better than how it divides,
/// which a diffuse base must not be too bright for.
Vec2 BaseBsdf::schlickTowards(bool dividedWell) const {
    const Vec2 tabled = schlickAlbedo(wo_);
    if (!dividedWell || !ggx_.isAnisotropic()) return tabled;
    const Vec2 found = meanOverVisibleNormals<WideLattice>(ggx_, wo_, [&](const Vec3& h) {
        return reflectedShare(ggx_, wo_, lambdaO_, h) * Vec2(1, schlickWeight(glm::dot(wo_, h)));
    });
    const float sum = tabled.x + tabled.y, grazing = found.x > 0 ? sum * std::min(found.y / found.x, 1.0f) : 0;
    return {sum - grazing, grazing};
}

/// Exchanges the film's share of albedos for what the film reflects, by a mean over the facets that wo sees.
void BaseBsdf::applyFilm() {
    const auto atFacet = [&](float cosTheta, float share) {
        FilmSums sums;
        const Vec3 reflectance = film_.reflectance(std::min(cosTheta, 1.0f));
        sums.reflected = reflectance * share;
        sums.all = share;
        if (!hasBoundary_) return sums;
        const float passed = solid_ ? 1 : share;
        const BoundarySums bare = atBoundary(cosTheta);
        sums.through = passed * (1 - specular_ * maxComponent(reflectance));
        sums.bareThrough = passed * fresnel_.through(bare.exact.y, bare.clear.y);
        return sums;
    };
    const FilmSums sums =
        smooth_ ? atFacet(wo_.z, 1) : meanOverVisibleNormals<NarrowLattice>(ggx_, wo_, [&](const Vec3& h) {
            return atFacet(glm::dot(wo_, h), reflectedShare(ggx_, wo_, lambdaO_, h));
        });
    filmAlbedo_ = sums.all > 0 ? sums.reflected / sums.all : Vec3(0);
    const float facets = schlickO_.x + schlickO_.y;
    albedo_[kReflection] = albedo_[kReflection] * (1 - filmShare_) + filmReflecting_ * filmAlbedo_ * facets;
    if (!hasBoundary_) return;
    // A thin wall passes on what facets see of it; of a solid, the bare boundary's albedo is scaled.
    const Vec3 under = solid_ ? albedo_[kTransmission] * (sums.through / std::max(sums.bareThrough, 1e-12f))
                              : transmissionTint_ * (facets * sums.through / std::max(sums.all, 1e-12f));
    const Vec3 left = glm::max(Vec3(1) - albedo_[kReflection] - multipleAlbedo_ - throughAlbedo_, Vec3(0));
    albedo_[kTransmission] = glm::min(albedo_[kTransmission] * (1 - filmShare_) + under * filmShare_, left);
}

}  // namespace lumi
