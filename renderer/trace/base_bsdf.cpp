#include "trace/base_bsdf.h"

#include <algorithm>
#include <cmath>

#include "math/warp.h"
#include "trace/anisotropic_albedo.h"
#include "trace/fresnel.h"

namespace lumi {

void BaseBsdf::chooseProbabilities() {
    const float diffuse = luminance(albedo_[kDiffuse]), transmitted = luminance(albedo_[kTransmission]);
    const float once = luminance(albedo_[kReflection]), through = luminance(throughAlbedo_);
    const float multiple = luminance(multipleAlbedo_) + through;
    const float specular = once + multiple + transmitted, sum = diffuse + specular;
    if (!(sum > 0)) return;
    const float d = diffuse > 0 ? std::max(diffuse, kMinLobeShare * sum) : 0;
    const float s = specular > 0 ? std::max(specular, kMinLobeShare * sum) : 0;
    probability_[kDiffuse] = d / (d + s);
    specularProbability_ = s / (d + s);
    if (specular > 0) multipleShare_ = multiple / specular;
    if (multiple > 0) multipleThrough_ = through / multiple;
    if (once + transmitted > 0) reflectedShare_ = once / (once + transmitted);
    const float facets = 1 - multipleShare_;
    probability_[kReflection] =
        specularProbability_ * (multipleShare_ * (1 - multipleThrough_) + facets * reflectedShare_);
    probability_[kTransmission] =
        specularProbability_ * (multipleShare_ * multipleThrough_ + facets * (1 - reflectedShare_));
}

/// Chance that a specular sample whose facet has this reflectance, and passes on `through` of the light, reflects.
float BaseBsdf::reflectionChance(const Vec3& reflected, float through) const {
    if (deltaTransmission_) return reflectedShare_;
    const float r = luminance(reflected), t = luminance(transmissionTint_) * through;
    return r > 0 ? r / (r + t) : 0;
}

Vec2 BaseBsdf::schlickAlbedo(const Vec3& w) const {
    if (ggx_.isAnisotropic()) return AnisotropicAlbedo::get().directional(ggx_, w);
    if (!smooth_) return SchlickAlbedo::get().directional(row_, {ggx_.alpha, w.z});
    const float s = schlickWeight(w.z);
    return {1 - s, s};
}

Vec2 BaseBsdf::schlickAverage() const {
    if (ggx_.isAnisotropic()) return AnisotropicAlbedo::get().average(ggx_);
    return smooth_ ? Vec2(20.0f / 21, 1.0f / 21) : SchlickAlbedo::get().average(row_, ggx_.alpha);
}

/// Looked up once for all lobes of a direction.
Vec2 BaseBsdf::schlickWhereUsed(const Vec3& w) const { return usesSchlick_ && w.z > 0 ? schlickAlbedo(w) : Vec2(1, 0); }

/// What a facet does with light at this cosine.
BaseBsdf::Facet BaseBsdf::facetAt(float cosTheta) const {
    Facet facet{f0_ + (Vec3(f90_) - f0_) * schlickWeight(cosTheta)};
    if (hasBoundary_) {
        const BoundarySums at = atBoundary(cosTheta);
        facet.reflected += boundaryShare_ * fresnel_.reflected(1, at.exact.x, at.clear.x);
        facet.through = fresnel_.through(at.exact.y, at.clear.y);
    }
    if (hasFilm_) {
        const Vec3 film = film_.reflectance(std::min(cosTheta, 1.0f));
        facet.reflected = facet.reflected * (1 - filmShare_) + filmReflecting_ * film;
        facet.through += (1 - specular_ * maxComponent(film) - facet.through) * filmShare_;
    }
    facet.reflectionChance = hasBoundary_ ? reflectionChance(facet.reflected, facet.through) : 1;
    return facet;
}

LobeValue BaseBsdf::diffuse(const Vec3& wi, Vec2 schlick) const {
    if (wi.z <= 0 || probability_[kDiffuse] == 0) return {};
    const float below = std::max(0.0f, 1 - (glm::dot(schlick, Vec2(layerF0_, layerF90_)) + layerMultiple_));
    Vec3 f = diffuseScale_ * (below * wi.z);
    if (hasFilm_) f += diffuseUnderFilm_ * wi.z;
    return {f, pdfCosineHemisphere(wi.z)};
}

/// `schlick` is schlickWhereUsed(wi).
LobeValue BaseBsdf::reflection(const Vec3& wi, const Vec3& h, Vec2 schlick) const {
    if (wi.z <= 0 || smooth_ || probability_[kReflection] == 0) return {};
    LobeValue value;
    const float cosFacet = glm::dot(wo_, h);
    if (cosFacet > 0) {
        const Facet facet = facetAt(cosFacet);
        const float density = ggx_.distribution(h) / (4 * wo_.z);
        value.f = facet.reflected * (density * maskingShadowing(lambdaO_, ggx_.lambda(wi)));
        value.pdf = facet.reflectionChance * density / (1 + lambdaO_);
    }
    if (multipleShare_ > 0) {
        if (!isBlack(multipleScale_)) value.f += multipleScale_ * (multipleBelow(schlick) * wi.z);
        if (!isBlack(boundaryScale_)) value.f += boundaryScale_ * (boundaryReturned(wi) * wi.z);
        value.pdf =
            (1 - multipleShare_) * value.pdf + multipleShare_ * (1 - multipleThrough_) * pdfCosineHemisphere(wi.z);
    }
    return value;
}

/// The reflection lobe of the outer face, mirrored: `mirrored` is wi with z turned up.
LobeValue BaseBsdf::transmissionThin(const Vec3& mirrored, const Vec3& h) const {
    const float cosFacet = glm::dot(wo_, h);
    if (mirrored.z <= 0 || cosFacet <= 0) return {};
    const Facet facet = facetAt(cosFacet);
    const float density = ggx_.distribution(h) / (4 * wo_.z);
    return {transmissionTint_ * (facet.through * density * maskingShadowing(lambdaO_, ggx_.lambda(mirrored))),
            (1 - multipleShare_) * (1 - facet.reflectionChance) * density / (1 + lambdaO_)};
}

/// [Walter 2007, eq. 17 and 21], without the square of the index (see the class).
LobeValue BaseBsdf::transmissionSolid(const Vec3& wi, const Vec3& h) const {
    const float cosO = glm::dot(wo_, h), cosI = glm::dot(wi, h);
    if (wi.z >= 0 || cosO <= 0 || cosI >= 0) return {};
    const Facet facet = facetAt(cosO);
    const float solidAngles = sqr(eta_) * -cosI / std::max(sqr(cosO + eta_ * cosI), 1e-20f);  // of h a wi
    const float density = ggx_.distribution(h) * cosO / wo_.z * solidAngles;
    return {transmissionTint_ * (facet.through * density * maskingBothSides(lambdaO_, ggx_.lambda(wi))),
            (1 - multipleShare_) * (1 - facet.reflectionChance) * density / (1 + lambdaO_)};
}

LobeValue BaseBsdf::transmission(const Vec3& wi) const {
    if (wi.z >= 0 || deltaTransmission_ || probability_[kTransmission] == 0) return {};
    if (solid_) return withMultiple(transmissionSolid(wi, halfVector(wo_ + eta_ * wi)), wi);
    const Vec3 mirrored(wi.x, wi.y, -wi.z);
    return withMultiple(transmissionThin(mirrored, halfVector(wo_ + mirrored)), wi);
}

/// Adds what comes through after many facets.
LobeValue BaseBsdf::withMultiple(LobeValue once, const Vec3& wi) const {
    if (multipleThrough_ == 0) return once;
    once.f += throughScale_ * (boundaryReturned(wi) * -wi.z);
    once.pdf += multipleShare_ * multipleThrough_ * pdfCosineHemisphere(-wi.z);
    return once;
}

BsdfValue BaseBsdf::evaluate(const Vec3& wi) const {
    if (wi.z < 0) {
        const LobeValue t = transmission(wi);
        return {Vec3(0), t.f, specularProbability_ * t.pdf};
    }
    const Vec2 schlick = schlickWhereUsed(wi);
    const LobeValue d = diffuse(wi, schlick), r = reflection(wi, halfVector(wo_ + wi), schlick);
    return {d.f, r.f, probability_[kDiffuse] * d.pdf + specularProbability_ * r.pdf};
}

Vec3 BaseBsdf::evaluate(const Vec3& wi, Lobe lobe) const {
    switch (lobe) {
        case Lobe::Diffuse: return diffuse(wi, schlickWhereUsed(wi)).f;
        case Lobe::SpecularReflection: return reflection(wi, halfVector(wo_ + wi), schlickWhereUsed(wi)).f;
        case Lobe::SpecularTransmission: return transmission(wi).f;
        default: break;
    }
    return Vec3(0);
}

BsdfSample BaseBsdf::deltaSample(Slot slot, const Vec3& wi) const {
    const Lobe lobe = slot == kReflection ? Lobe::SpecularReflection : Lobe::SpecularTransmission;
    return {wi, albedo_[slot] / probability_[slot], 0, true, lobe};
}

BsdfSample BaseBsdf::sampleDiffuse(Vec2 u) const {
    const Vec3 wi = sampleCosineHemisphere(u);
    return upperSample(wi, halfVector(wo_ + wi), Lobe::Diffuse);
}

BsdfSample BaseBsdf::upperSample(const Vec3& wi, const Vec3& h, Lobe lobe) const {
    const Vec2 schlick = schlickWhereUsed(wi);
    const LobeValue d = diffuse(wi, schlick), r = reflection(wi, h, schlick);
    const float pdf = probability_[kDiffuse] * d.pdf + specularProbability_ * r.pdf;
    if (!(pdf > 0)) return {};
    return {wi, (d.f + r.f) / pdf, pdf, false, lobe};
}

BsdfSample BaseBsdf::deltaTransmissionSample() const {
    if (!solid_) return deltaSample(kTransmission, -wo_);
    Vec3 wi;
    if (!refract(wo_, {0, 0, 1}, eta_, wi)) return {};
    return deltaSample(kTransmission, glm::normalize(wi));
}

BsdfSample BaseBsdf::transmissionSample(const Vec3& h) const {
    Vec3 wi;
    LobeValue t;
    if (solid_) {
        if (!refract(wo_, h, eta_, wi)) return {};
        wi = glm::normalize(wi);
        t = withMultiple(transmissionSolid(wi, h), wi);
    } else {
        const Vec3 mirrored = glm::normalize(2 * glm::dot(wo_, h) * h - wo_);
        wi = {mirrored.x, mirrored.y, -mirrored.z};
        t = withMultiple(transmissionThin(mirrored, h), wi);
    }
    return lowerSample(wi, t);
}

BsdfSample BaseBsdf::lowerSample(const Vec3& wi, const LobeValue& t) const {
    const float pdf = specularProbability_ * t.pdf;
    if (!(pdf > 0) || wi.z >= 0) return {};
    return {wi, t.f / pdf, pdf, false, Lobe::SpecularTransmission};
}

/// Reflects or transmits at one facet, by what that facet does: inside glass a few facets reflect totally, and chosen
/// by the lobes' albedos they would be rare and bright.
BsdfSample BaseBsdf::sampleSpecular(float choice, Vec2 u) const {
    if (multipleShare_ > 0) {
        if (choice < multipleShare_) {
            const Vec3 wi = sampleCosineHemisphere(u), below(wi.x, wi.y, -wi.z);
            if (choice < multipleShare_ * multipleThrough_) return lowerSample(below, transmission(below));
            return upperSample(wi, halfVector(wo_ + wi), Lobe::SpecularReflection);
        }
        choice = std::min((choice - multipleShare_) / (1 - multipleShare_), 0x1.fffffep-1f);
    }
    if (smooth_ && choice < reflectedShare_) return deltaSample(kReflection, {-wo_.x, -wo_.y, wo_.z});
    if (deltaTransmission_ && choice >= reflectedShare_) return deltaTransmissionSample();
    const Vec3 h = ggx_.sampleVisibleNormal(wo_, u);
    const float cosFacet = glm::dot(wo_, h);
    if (hasBoundary_ && choice >= facetAt(cosFacet).reflectionChance) return transmissionSample(h);
    return upperSample(glm::normalize(2 * cosFacet * h - wo_), h, Lobe::SpecularReflection);
}

BsdfSample BaseBsdf::sample(float uLobe, Vec2 u) const {
    if (specularProbability_ == 0 || uLobe < probability_[kDiffuse]) return sampleDiffuse(u);
    return sampleSpecular(std::min((uLobe - probability_[kDiffuse]) / specularProbability_, 0x1.fffffep-1f), u);
}

Vec3 BaseBsdf::albedo(Lobe lobe) const {
    switch (lobe) {
        case Lobe::Diffuse: return albedo_[kDiffuse];
        case Lobe::SpecularReflection: return albedo_[kReflection] + multipleAlbedo_;
        case Lobe::SpecularTransmission: return albedo_[kTransmission] + throughAlbedo_;
        default: break;
    }
    return Vec3(0);
}

float BaseBsdf::probability(Lobe lobe) const {
    return lobe == Lobe::None || lobe > Lobe::SpecularTransmission
               ? 0
               : probability_[static_cast<int>(lobe) - static_cast<int>(Lobe::Diffuse)];
}

bool BaseBsdf::isDelta() const {
    return probability_[kDiffuse] == 0 && (probability_[kReflection] == 0 || smooth_) &&
           (probability_[kTransmission] == 0 || deltaTransmission_);
}

void BaseBsdf::keep(bool diffuse, bool specular) {
    if (!diffuse) albedo_[kDiffuse] = Vec3(0);
    if (!specular) albedo_[kReflection] = albedo_[kTransmission] = multipleAlbedo_ = throughAlbedo_ = Vec3(0);
    std::fill(std::begin(probability_), std::end(probability_), 0.0f);
    specularProbability_ = 0, multipleShare_ = 0, multipleThrough_ = 0, reflectedShare_ = 1;
    chooseProbabilities();
}

void BaseBsdf::prepare(float ior, bool transmits, bool clear) {
    SchlickAlbedo::get();
    if (!transmits) return;
    DielectricAlbedo::get(DielectricAlbedo::roundedIor(ior), true);
    if (clear) DielectricAlbedo::get(DielectricAlbedo::roundedIor(ior), true, true);
}

}  // namespace lumi
