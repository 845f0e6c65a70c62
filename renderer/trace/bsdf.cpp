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
    if (boundary > 0) {
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
    if (isBlack(boundaryTint_) && isBlack(transmissionTint_)) return;

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
    float share[kSlots], sum = 0;
    for (int slot = 0; slot < kSlots; ++slot) sum += share[slot] = luminance(albedo_[slot]);
    if (!(sum > 0)) return;
    float total = 0;
    for (int slot = 0; slot < kSlots; ++slot) {
        if (!isBlack(albedo_[slot])) share[slot] = std::max(share[slot], kMinLobeShare * sum);
        total += share[slot];
    }
    for (int slot = 0; slot < kSlots; ++slot) probability_[slot] = share[slot] / total;
}

Vec2 Bsdf::schlickAlbedo(float cosTheta) const {
    if (!smooth_) return SchlickAlbedo::get().directional(row_, cosTheta);
    const float s = schlickWeight(cosTheta);
    return {1 - s, s};
}

/// Fresnel term of the reflection lobe for the angle to the facet.
Vec3 Bsdf::reflectance(float cosTheta) const {
    Vec3 f = f0_ + (Vec3(f90_) - f0_) * schlickWeight(cosTheta);
    if (!isBlack(boundaryTint_)) f += boundaryTint_ * fresnelDielectric(std::min(cosTheta, 1.0f), eta_);
    return f;
}

Bsdf::LobeValue Bsdf::diffuse(const Vec3& wi) const {
    if (wi.z <= 0 || probability_[kDiffuse] == 0) return {};
    const float below = std::max(0.0f, 1 - glm::dot(schlickAlbedo(wi.z), Vec2(layerF0_, layerF90_)));
    return {diffuseScale_ * (below * wi.z), pdfCosineHemisphere(wi.z)};
}

Bsdf::LobeValue Bsdf::reflection(const Vec3& wi, const Vec3& h) const {
    const float cosFacet = glm::dot(wo_, h);
    if (wi.z <= 0 || cosFacet <= 0 || smooth_ || probability_[kReflection] == 0) return {};
    const float facets = ggx_.distribution(h) / (4 * wo_.z);
    return {reflectance(cosFacet) * (facets * maskingShadowing(lambdaO_, ggx_.lambda(wi))), facets / (1 + lambdaO_)};
}

/// The reflection lobe of the outer face, mirrored: `mirrored` is wi with z turned up.
Bsdf::LobeValue Bsdf::transmissionThin(const Vec3& mirrored, const Vec3& h) const {
    const float cosFacet = glm::dot(wo_, h);
    if (mirrored.z <= 0 || cosFacet <= 0) return {};
    const float facets = ggx_.distribution(h) / (4 * wo_.z);
    const float through = 1 - fresnelDielectric(std::min(cosFacet, 1.0f), eta_);
    return {transmissionTint_ * (through * facets * maskingShadowing(lambdaO_, ggx_.lambda(mirrored))),
            facets / (1 + lambdaO_)};
}

/// [Walter 2007, eq. 17 and 21], without the square of the index (see the class).
Bsdf::LobeValue Bsdf::transmissionSolid(const Vec3& wi, const Vec3& h) const {
    const float cosO = glm::dot(wo_, h), cosI = glm::dot(wi, h);
    if (wi.z >= 0 || cosO <= 0 || cosI >= 0) return {};
    const float through = 1 - fresnelDielectric(std::min(cosO, 1.0f), eta_);
    const float solidAngles = sqr(eta_) * -cosI / std::max(sqr(cosO + eta_ * cosI), 1e-20f);  // of h a wi
    const float facets = ggx_.distribution(h) * cosO / wo_.z * solidAngles;
    return {transmissionTint_ * (through * facets * maskingBothSides(lambdaO_, ggx_.lambda(wi))),
            facets / (1 + lambdaO_)};
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
        return {Vec3(0), t.f, probability_[kTransmission] * t.pdf};
    }
    const LobeValue d = diffuse(wi), r = reflection(wi, halfVector(wo_ + wi));
    return {d.f, r.f, probability_[kDiffuse] * d.pdf + probability_[kReflection] * r.pdf};
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
    const LobeValue d = diffuse(wi), r = reflection(wi, halfVector(wo_ + wi));
    const float pdf = probability_[kDiffuse] * d.pdf + probability_[kReflection] * r.pdf;
    if (!(pdf > 0)) return {};
    return {wi, (d.f + r.f) / pdf, pdf, false, Lobe::Diffuse};
}

BsdfSample Bsdf::sampleReflection(Vec2 u) const {
    if (smooth_) return deltaSample(kReflection, {-wo_.x, -wo_.y, wo_.z});
    const Vec3 h = ggx_.sampleVisibleNormal(wo_, u);
    const Vec3 wi = glm::normalize(2 * glm::dot(wo_, h) * h - wo_);
    const LobeValue d = diffuse(wi), r = reflection(wi, h);
    const float pdf = probability_[kDiffuse] * d.pdf + probability_[kReflection] * r.pdf;
    if (!(pdf > 0)) return {};
    return {wi, (d.f + r.f) / pdf, pdf, false, Lobe::SpecularReflection};
}

BsdfSample Bsdf::sampleTransmission(Vec2 u) const {
    Vec3 wi;
    if (deltaTransmission_) {
        if (!solid_) return deltaSample(kTransmission, -wo_);
        if (!refract(wo_, {0, 0, 1}, eta_, wi)) return {};
        return deltaSample(kTransmission, glm::normalize(wi));
    }
    const Vec3 h = ggx_.sampleVisibleNormal(wo_, u);
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
    if (!(t.pdf > 0)) return {};
    const float pdf = probability_[kTransmission] * t.pdf;
    return {wi, t.f / pdf, pdf, false, Lobe::SpecularTransmission};
}

BsdfSample Bsdf::sample(float uLobe, Vec2 u) const {
    if (isBlack(albedo_[kDiffuse]) && isBlack(specularAlbedo())) return {};
    if (uLobe < probability_[kDiffuse]) return sampleDiffuse(u);
    // Rounding may leave the sum of shares below uLobe: the last lobe that exists takes it.
    const bool reflects = uLobe < probability_[kDiffuse] + probability_[kReflection];
    if (probability_[kReflection] > 0 && (reflects || probability_[kTransmission] == 0)) return sampleReflection(u);
    if (probability_[kTransmission] > 0) return sampleTransmission(u);
    return sampleDiffuse(u);
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

void Bsdf::prepare(float ior, bool transmits) {
    SchlickAlbedo::get();
    if (transmits) DielectricAlbedo::get(DielectricAlbedo::roundedIor(ior), true);
}

}  // namespace lumi
