#include "trace/clearcoat.h"

#include "trace/fresnel.h"

namespace lumi {
namespace {

constexpr float kF0 = 0.04f;  ///< of index 1.5

Vec3 usableNormal(const Vec3& normal, const Vec3& wo) {
    const float length = glm::length(normal);
    return length > 0 && isFinite(normal) && glm::dot(normal, wo) > 0 ? normal / length : Vec3(0, 0, 1);
}

}  // namespace

float clearcoatReflectance(float cosine) { return kF0 + (1 - kF0) * schlickWeight(saturate(cosine)); }

Clearcoat::Clearcoat(const LayerInputs& layers, const Vec3& wo) : frame_(usableNormal(layers.clearcoatNormal, wo)) {
    wo_ = frame_.toLocal(wo);
    wo_.z = std::max(wo_.z, kMinCosine);
    wo_ = glm::normalize(wo_);
    const float roughness = saturate(layers.clearcoatRoughness);
    weight_ = saturate(layers.clearcoat);
    smooth_ = roughness < kTabledRoughness;
    ggx_.alpha = sqr(std::max(roughness, kTabledRoughness));
    lambdaO_ = ggx_.lambda(wo_);
    const float s = schlickWeight(wo_.z);
    const Vec2 schlick =
        smooth_ ? Vec2(1 - s, s) : SchlickAlbedo::get().directional(RoughnessRow(roughness), {ggx_.alpha, wo_.z});
    albedo_ = weight_ * (kF0 * schlick.x + schlick.y);
}

LobeValue Clearcoat::evaluate(const Vec3& direction) const {
    const Vec3 wi = frame_.toLocal(direction), h = halfVector(wo_ + wi);
    const float cosFacet = glm::dot(wo_, h);
    if (wi.z <= 0 || cosFacet <= 0 || smooth_) return {};
    const float fresnel = clearcoatReflectance(cosFacet), density = ggx_.distribution(h) / (4 * wo_.z);
    return {Vec3(weight_ * fresnel * density * maskingShadowing(lambdaO_, ggx_.lambda(wi))), density / (1 + lambdaO_)};
}

Vec3 Clearcoat::sample(Vec2 u) const {
    const Vec3 h = smooth_ ? Vec3(0, 0, 1) : ggx_.sampleVisibleNormal(wo_, u);
    return glm::normalize(frame_.toWorld(2 * glm::dot(wo_, h) * h - wo_));
}

}  // namespace lumi
