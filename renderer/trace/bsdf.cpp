#include "trace/bsdf.h"

#include "trace/anisotropic_albedo.h"

namespace lumi {

Bsdf::Bsdf(const BsdfInputs& inputs, const Vec3& wo) {
    if (!inputs.layered) {
        base_ = BaseBsdf(inputs, wo);
        return;
    }
    layered_ = true;
    const Vec2 direction = inputs.layers.anisotropyDirection;
    const float length = glm::length(direction);
    if (inputs.layers.anisotropy > 0 && length > 0 && std::isfinite(length)) turn_ = direction / length;
    base_ = BaseBsdf(inputs, turned(wo));
    addLayers(inputs.layers, inputs.solid && !inputs.entering, turnedBack(base_.wo()));
}

void Bsdf::addLayers(const LayerInputs& layers, bool inside, const Vec3& wo) {
    if (inside) return;
    if (layers.clearcoat > 0) {
        coat_.emplace(layers, wo);
        belowCoat_ = 1 - coat_->albedo();
    }
    if (maxComponent(layers.sheenColor) > 0) {
        sheen_.emplace(layers, wo);
        belowSheen_ = sheen_->through();
    }
    chooseProbabilities();
}

void Bsdf::chooseProbabilities() {
    const float base = luminance(base_.specularAlbedo() + base_.albedo(Lobe::Diffuse)) * belowCoat_ * belowSheen_;
    const float coat = coat_ ? coat_->albedo() : 0;
    const float sheen = sheen_ ? luminance(sheen_->albedo()) * belowCoat_ : 0;
    const float sum = base + coat + sheen;
    coatShare_ = sheenShare_ = 0, baseShare_ = 1;
    if (!(coat + sheen > 0)) return;
    const auto atLeast = [&](float albedo) { return albedo > 0 ? std::max(albedo, kMinLayerShare * sum) : 0; };
    const float total = atLeast(base) + atLeast(coat) + atLeast(sheen);
    coatShare_ = atLeast(coat) / total, sheenShare_ = atLeast(sheen) / total, baseShare_ = atLeast(base) / total;
}

BsdfValue Bsdf::evaluate(const Vec3& wi) const {
    if (!layered_) return base_.evaluate(wi);
    BsdfValue value = base_.evaluate(turned(wi));
    const float kept = belowCoat_ * belowSheen_;
    value.diffuse *= kept, value.specular *= kept, value.pdf *= baseShare_;
    if (wi.z <= 0) return value;
    if (coat_) {
        const LobeValue coat = coat_->evaluate(wi);
        value.specular += coat.f;
        value.pdf += coatShare_ * coat.pdf;
    }
    if (sheen_) {
        const LobeValue sheen = sheen_->evaluate(wi);
        value.specular += sheen.f * belowCoat_;
        value.pdf += sheenShare_ * sheen.pdf;
    }
    return value;
}

Vec3 Bsdf::evaluate(const Vec3& wi, Lobe lobe) const {
    if (lobe == Lobe::Clearcoat) return coat_ && wi.z > 0 ? coat_->evaluate(wi).f : Vec3(0);
    if (lobe == Lobe::Sheen) return sheen_ ? sheen_->evaluate(wi).f * belowCoat_ : Vec3(0);
    return layered_ ? base_.evaluate(turned(wi), lobe) * (belowCoat_ * belowSheen_) : base_.evaluate(wi, lobe);
}

BsdfSample Bsdf::combined(const Vec3& wi, Lobe lobe) const {
    const BsdfValue value = evaluate(wi);
    if (!(value.pdf > 0)) return {};
    return {wi, (value.diffuse + value.specular) / value.pdf, value.pdf, false, lobe};
}

BsdfSample Bsdf::sampleCoat(Vec2 u) const {
    const Vec3 wi = coat_->sample(u);
    if (wi.z <= 0) return {};
    if (coat_->isDelta()) return {wi, Vec3(coat_->albedo() / coatShare_), 0, true, Lobe::Clearcoat};
    // Over the surface and yet under the varnish, where that leans: evaluate() knows no such light.
    if (!(coat_->evaluate(wi).pdf > 0)) return {};
    return combined(wi, Lobe::Clearcoat);
}

BsdfSample Bsdf::sample(float uLobe, Vec2 u) const {
    if (!layered_) return base_.sample(uLobe, u);
    if (uLobe < coatShare_) return sampleCoat(u);
    if (uLobe < coatShare_ + sheenShare_) return combined(sheen_->sample(u), Lobe::Sheen);
    if (!(baseShare_ > 0)) return {};
    const float choice = std::clamp((uLobe - coatShare_ - sheenShare_) / baseShare_, 0.0f, 0x1.fffffep-1f);
    BsdfSample sample = base_.sample(choice, u);
    if (sample.lobe == Lobe::None) return sample;
    sample.wi = turnedBack(sample.wi);
    if (!sample.delta) return combined(sample.wi, sample.lobe);
    sample.weight *= belowCoat_ * belowSheen_ / baseShare_;
    return sample;
}

Vec3 Bsdf::albedo(Lobe lobe) const {
    if (lobe == Lobe::Clearcoat) return coat_ ? Vec3(coat_->albedo()) : Vec3(0);
    if (lobe == Lobe::Sheen) return sheen_ ? sheen_->albedo() * belowCoat_ : Vec3(0);
    return layered_ ? base_.albedo(lobe) * (belowCoat_ * belowSheen_) : base_.albedo(lobe);
}

Vec3 Bsdf::specularAlbedo() const {
    if (!layered_) return base_.specularAlbedo();
    return base_.specularAlbedo() * (belowCoat_ * belowSheen_) + albedo(Lobe::Clearcoat) + albedo(Lobe::Sheen);
}

float Bsdf::probability(Lobe lobe) const {
    if (lobe == Lobe::Clearcoat) return coatShare_;
    if (lobe == Lobe::Sheen) return sheenShare_;
    return layered_ ? base_.probability(lobe) * baseShare_ : base_.probability(lobe);
}

bool Bsdf::isDelta() const { return base_.isDelta() && (!coat_ || coat_->isDelta()) && (!sheen_ || sheenShare_ == 0); }

void Bsdf::keep(bool diffuse, bool specular) {
    base_.keep(diffuse, specular);
    if (!layered_) return;
    // What the layers hide stays hidden.
    if (!specular) coat_.reset(), sheen_.reset();
    chooseProbabilities();
}

void Bsdf::prepareLayers(bool sheen, bool anisotropy) {
    if (sheen) Sheen::prepare();
    if (anisotropy) AnisotropicAlbedo::get();
}

}  // namespace lumi
