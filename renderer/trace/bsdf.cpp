#include "trace/bsdf.h"

#include <algorithm>
#include <cmath>

#include "math/warp.h"
#include "trace/fresnel.h"

namespace lumi {
namespace {

/// Below this product of ggxAlpha and |eta - 1| a refracted lobe is narrower than its half vector can be computed.
constexpr float kDeltaRefraction = 2e-5f;
/// wo is kept at least this far above the horizon.
constexpr float kMinCosine = 1e-4f;

/// To [0, 1]; not a number becomes 0.
float saturate(float x) { return x > 0 ? std::min(x, 1.0f) : 0.0f; }
Vec3 saturate(const Vec3& c) { return {saturate(c.x), saturate(c.y), saturate(c.z)}; }
/// To [0, limit]; not a number becomes 0.
Vec3 nonNegative(const Vec3& c, float limit) { return saturate(c / limit) * limit; }

Vec3 usableDirection(Vec3 wo) {
    if (!isFinite(wo)) return {0, 0, 1};
    wo.z = std::max(wo.z, kMinCosine);
    return glm::normalize(wo);
}

/// Unit half vector on the side z > 0; z = 0 if there is none.
Vec3 halfVector(const Vec3& sum) {
    const float length2 = glm::dot(sum, sum);
    if (!(length2 > 1e-14f)) return Vec3(0);
    return sum * (std::copysign(1.0f, sum.z) / std::sqrt(length2));
}

}  // namespace

Bsdf::Bsdf(const BsdfInputs& inputs, const Vec3& wo) : wo_(usableDirection(wo)) {
    const float roughness = saturate(inputs.roughness);
    const float metallic = saturate(inputs.metallic), transmitting = saturate(inputs.transmission);
    const float opaque = (1 - metallic) * (1 - transmitting), boundary = (1 - metallic) * transmitting;
    const float specular = saturate(inputs.specular);
    const float ior = inputs.ior >= 0 ? std::min(inputs.ior, 100.0f) : 1.5f;
    const Vec3 baseColor = saturate(inputs.baseColor), specularColor = nonNegative(inputs.specularColor, 1e4f);

    smooth_ = roughness < kDeltaRoughness;
    ggx_.alpha = sqr(std::max(roughness, kDeltaRoughness));
    row_ = RoughnessRow(roughness);
    lambdaO_ = ggx_.lambda(wo_);
    solid_ = inputs.solid;

    const Vec3 layerF0 = glm::min(sqr((ior - 1) / (ior + 1)) * specularColor, Vec3(1)) * specular;
    f0_ = opaque * layerF0 + metallic * baseColor;
    f90_ = opaque * specular + metallic;
    if (opaque > 0) setDiffuse(opaque * baseColor, maxComponent(layerF0), specular);

    const bool inside = solid_ && !inputs.entering;
    hasBoundary_ = boundary > 0;
    if (hasBoundary_) {
        const float rounded = DielectricAlbedo::roundedIor(ior);
        eta_ = inside ? 1 / rounded : rounded;
        // Total reflection knows no tint, so the inside of a solid has none.
        boundaryTint_ = inside ? Vec3(boundary) : boundary * glm::min(specular * specularColor, Vec3(1));
        transmissionTint_ = boundary * (solid_ ? glm::sqrt(baseColor) : baseColor);
    }
    setSpecular(inside);
    chooseProbabilities();
}

void Bsdf::setDiffuse(const Vec3& rho, float f0, float f90) {
    layerF0_ = f0, layerF90_ = f90;
    const Vec2 fresnel(f0, f90);
    const Vec2 mean = smooth_ ? Vec2(20.0f / 21, 1.0f / 21) : SchlickAlbedo::get().average(row_);
    const float below = std::max(0.0f, 1 - glm::dot(schlickAlbedo(wo_.z), fresnel));
    albedo_[kDiffuse] = rho * below;
    diffuseScale_ = albedo_[kDiffuse] * (kInvPi / std::max(1 - glm::dot(mean, fresnel), 1e-4f));
}

void Bsdf::setSpecular(bool inside) {
    const Vec2 schlick = schlickAlbedo(wo_.z);
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

void Bsdf::chooseProbabilities() {
    const float diffuse = luminance(albedo_[kDiffuse]), reflected = luminance(albedo_[kReflection]);
    const float transmitted = luminance(albedo_[kTransmission]), specular = reflected + transmitted;
    const float sum = diffuse + specular;
    if (!(sum > 0)) return;
    const float d = diffuse > 0 ? std::max(diffuse, kMinLobeShare * sum) : 0;
    const float s = specular > 0 ? std::max(specular, kMinLobeShare * sum) : 0;
    probability_[kDiffuse] = d / (d + s);
    specularProbability_ = s / (d + s);
    if (specular > 0) reflectedShare_ = reflected / specular;
    probability_[kReflection] = specularProbability_ * reflectedShare_;
    probability_[kTransmission] = specularProbability_ * (1 - reflectedShare_);
}

/// Chance that a specular sample whose facet has this reflectance, and passes on `through` of the light, reflects.
float Bsdf::reflectionChance(const Vec3& reflected, float through) const {
    if (deltaTransmission_) return reflectedShare_;
    const float r = luminance(reflected), t = luminance(transmissionTint_) * through;
    return r > 0 ? r / (r + t) : 0;
}

Vec2 Bsdf::schlickAlbedo(float cosTheta) const {
    if (!smooth_) return SchlickAlbedo::get().directional(row_, cosTheta);
    const float s = schlickWeight(cosTheta);
    return {1 - s, s};
}

/// What a facet does with light at this cosine.
Bsdf::Facet Bsdf::facetAt(float cosTheta) const {
    Facet facet{f0_ + (Vec3(f90_) - f0_) * schlickWeight(cosTheta)};
    if (hasBoundary_) {
        const float f = fresnelDielectric(std::min(cosTheta, 1.0f), eta_);
        facet.reflected += boundaryTint_ * f;
        facet.through = 1 - f;
    }
    facet.reflectionChance = hasBoundary_ ? reflectionChance(facet.reflected, facet.through) : 1;
    return facet;
}

Bsdf::LobeValue Bsdf::diffuse(const Vec3& wi) const {
    if (wi.z <= 0 || probability_[kDiffuse] == 0) return {};
    const float below = std::max(0.0f, 1 - glm::dot(schlickAlbedo(wi.z), Vec2(layerF0_, layerF90_)));
    return {diffuseScale_ * (below * wi.z), pdfCosineHemisphere(wi.z)};
}

Bsdf::LobeValue Bsdf::reflection(const Vec3& wi, const Vec3& h) const {
    const float cosFacet = glm::dot(wo_, h);
    if (wi.z <= 0 || cosFacet <= 0 || smooth_ || probability_[kReflection] == 0) return {};
    const Facet facet = facetAt(cosFacet);
    const float density = ggx_.distribution(h) / (4 * wo_.z);
    return {facet.reflected * (density * maskingShadowing(lambdaO_, ggx_.lambda(wi))),
            facet.reflectionChance * density / (1 + lambdaO_)};
}

/// The reflection lobe of the outer face, mirrored: `mirrored` is wi with z turned up.
Bsdf::LobeValue Bsdf::transmissionThin(const Vec3& mirrored, const Vec3& h) const {
    const float cosFacet = glm::dot(wo_, h);
    if (mirrored.z <= 0 || cosFacet <= 0) return {};
    const Facet facet = facetAt(cosFacet);
    const float density = ggx_.distribution(h) / (4 * wo_.z);
    return {transmissionTint_ * (facet.through * density * maskingShadowing(lambdaO_, ggx_.lambda(mirrored))),
            (1 - facet.reflectionChance) * density / (1 + lambdaO_)};
}

/// [Walter 2007, eq. 17 and 21], without the square of the index (see the class).
Bsdf::LobeValue Bsdf::transmissionSolid(const Vec3& wi, const Vec3& h) const {
    const float cosO = glm::dot(wo_, h), cosI = glm::dot(wi, h);
    if (wi.z >= 0 || cosO <= 0 || cosI >= 0) return {};
    const Facet facet = facetAt(cosO);
    const float solidAngles = sqr(eta_) * -cosI / std::max(sqr(cosO + eta_ * cosI), 1e-20f);  // of h a wi
    const float density = ggx_.distribution(h) * cosO / wo_.z * solidAngles;
    return {transmissionTint_ * (facet.through * density * maskingBothSides(lambdaO_, ggx_.lambda(wi))),
            (1 - facet.reflectionChance) * density / (1 + lambdaO_)};
}

Bsdf::LobeValue Bsdf::transmission(const Vec3& wi) const {
    if (wi.z >= 0 || deltaTransmission_ || probability_[kTransmission] == 0) return {};
    if (solid_) return transmissionSolid(wi, halfVector(wo_ + eta_ * wi));
    const Vec3 mirrored(wi.x, wi.y, -wi.z);
    return transmissionThin(mirrored, halfVector(wo_ + mirrored));
}

BsdfValue Bsdf::evaluate(const Vec3& wi) const {
    if (wi.z < 0) {
        const LobeValue t = transmission(wi);
        return {Vec3(0), t.f, specularProbability_ * t.pdf};
    }
    const LobeValue d = diffuse(wi), r = reflection(wi, halfVector(wo_ + wi));
    return {d.f, r.f, probability_[kDiffuse] * d.pdf + specularProbability_ * r.pdf};
}

Vec3 Bsdf::evaluate(const Vec3& wi, Lobe lobe) const {
    switch (lobe) {
        case Lobe::Diffuse: return diffuse(wi).f;
        case Lobe::SpecularReflection: return reflection(wi, halfVector(wo_ + wi)).f;
        case Lobe::SpecularTransmission: return transmission(wi).f;
        case Lobe::None: break;
    }
    return Vec3(0);
}

BsdfSample Bsdf::deltaSample(Slot slot, const Vec3& wi) const {
    const Lobe lobe = slot == kReflection ? Lobe::SpecularReflection : Lobe::SpecularTransmission;
    return {wi, albedo_[slot] / probability_[slot], 0, true, lobe};
}

BsdfSample Bsdf::sampleDiffuse(Vec2 u) const {
    const Vec3 wi = sampleCosineHemisphere(u);
    return upperSample(wi, halfVector(wo_ + wi), Lobe::Diffuse);
}

BsdfSample Bsdf::upperSample(const Vec3& wi, const Vec3& h, Lobe lobe) const {
    const LobeValue d = diffuse(wi), r = reflection(wi, h);
    const float pdf = probability_[kDiffuse] * d.pdf + specularProbability_ * r.pdf;
    if (!(pdf > 0)) return {};
    return {wi, (d.f + r.f) / pdf, pdf, false, lobe};
}

BsdfSample Bsdf::deltaTransmissionSample() const {
    if (!solid_) return deltaSample(kTransmission, -wo_);
    Vec3 wi;
    if (!refract(wo_, {0, 0, 1}, eta_, wi)) return {};
    return deltaSample(kTransmission, glm::normalize(wi));
}

BsdfSample Bsdf::transmissionSample(const Vec3& h) const {
    Vec3 wi;
    LobeValue t;
    if (solid_) {
        if (!refract(wo_, h, eta_, wi)) return {};
        wi = glm::normalize(wi);
        t = transmissionSolid(wi, h);
    } else {
        const Vec3 mirrored = glm::normalize(2 * glm::dot(wo_, h) * h - wo_);
        wi = {mirrored.x, mirrored.y, -mirrored.z};
        t = transmissionThin(mirrored, h);
    }
    const float pdf = specularProbability_ * t.pdf;
    if (!(pdf > 0)) return {};
    return {wi, t.f / pdf, pdf, false, Lobe::SpecularTransmission};
}

/// Reflects or transmits at one facet, by what that facet does: inside glass a few facets reflect totally, and chosen
/// by the lobes' albedos they would be rare and bright.
BsdfSample Bsdf::sampleSpecular(float choice, Vec2 u) const {
    if (smooth_ && choice < reflectedShare_) return deltaSample(kReflection, {-wo_.x, -wo_.y, wo_.z});
    if (deltaTransmission_ && choice >= reflectedShare_) return deltaTransmissionSample();
    const Vec3 h = ggx_.sampleVisibleNormal(wo_, u);
    const float cosFacet = glm::dot(wo_, h);
    if (hasBoundary_ && choice >= facetAt(cosFacet).reflectionChance) return transmissionSample(h);
    return upperSample(glm::normalize(2 * cosFacet * h - wo_), h, Lobe::SpecularReflection);
}

BsdfSample Bsdf::sample(float uLobe, Vec2 u) const {
    if (specularProbability_ == 0 || uLobe < probability_[kDiffuse]) return sampleDiffuse(u);
    return sampleSpecular(std::min((uLobe - probability_[kDiffuse]) / specularProbability_, 0x1.fffffep-1f), u);
}

Vec3 Bsdf::albedo(Lobe lobe) const {
    switch (lobe) {
        case Lobe::Diffuse: return albedo_[kDiffuse];
        case Lobe::SpecularReflection: return albedo_[kReflection];
        case Lobe::SpecularTransmission: return albedo_[kTransmission];
        case Lobe::None: break;
    }
    return Vec3(0);
}

float Bsdf::probability(Lobe lobe) const {
    return lobe == Lobe::None ? 0 : probability_[static_cast<int>(lobe) - static_cast<int>(Lobe::Diffuse)];
}

bool Bsdf::isDelta() const {
    return probability_[kDiffuse] == 0 && (probability_[kReflection] == 0 || smooth_) &&
           (probability_[kTransmission] == 0 || deltaTransmission_);
}

void Bsdf::keep(bool diffuse, bool specular) {
    if (!diffuse) albedo_[kDiffuse] = Vec3(0);
    if (!specular) albedo_[kReflection] = albedo_[kTransmission] = Vec3(0);
    std::fill(std::begin(probability_), std::end(probability_), 0.0f);
    specularProbability_ = 0, reflectedShare_ = 1;
    chooseProbabilities();
}

void Bsdf::prepare(float ior, bool transmits) {
    SchlickAlbedo::get();
    if (transmits) DielectricAlbedo::get(DielectricAlbedo::roundedIor(ior), true);
}

}  // namespace lumi
