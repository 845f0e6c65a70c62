#pragma once
#include <optional>

#include "trace/base_bsdf.h"
#include "trace/clearcoat.h"
#include "trace/sheen.h"

namespace lumi {

/// The scattering function at one point for one outgoing direction, in the local frame (z is the shading normal on
/// wo's side, wo.z > 0): a base (see BaseBsdf) under sheen under clearcoat. Each layer shows what it reflects towards
/// wo, and what lies below keeps the rest, whatever wi: a white furnace stays white, but a layered surface is not
/// reciprocal, though each of its lobes is. Layers cover the outside only: glass seen from inside has none.
class Bsdf {
public:
    static constexpr float kDeltaRoughness = BaseBsdf::kDeltaRoughness;

    Bsdf() = default;
    Bsdf(const BsdfInputs& inputs, const Vec3& wo);

    BsdfValue evaluate(const Vec3& wi) const;
    /// `uLobe` chooses the layer by the luminance of its albedo (but each at least kMinLayerShare), and then the lobe.
    BsdfSample sample(float uLobe, Vec2 u) const;

    /// Directional albedo towards wo of one lobe, and of all but the diffuse one together. In [0,1].
    Vec3 albedo(Lobe lobe) const;
    Vec3 specularAlbedo() const;
    /// One lobe alone, f |cos|, for tests and for modules that replace a term. 0 for delta lobes.
    Vec3 evaluate(const Vec3& wi, Lobe lobe) const;
    /// True if every lobe is a delta: next-event estimation cannot contribute.
    bool isDelta() const;
    /// Does what it transmits go straight on, as through a pane?
    bool isWindow() const { return base_.isWindow(); }
    /// Chance that sample() draws this lobe, lost samples included: exact for deltas, layers and the diffuse lobe.
    float probability(Lobe lobe) const;

    /// Takes lobes away, as if they were black: what a path at a depth limit may no longer use. Albedos go with them.
    void keep(bool diffuse, bool specular);

    /// Makes the albedo tables that materials of this ior need (some 200 ms the first time), so that no path waits.
    /// `transmits`: also those of dielectric boundaries; `clear`: and of solid ones whose specular weight is below 1.
    /// Any thread.
    static void prepare(float ior, bool transmits, bool clear) { BaseBsdf::prepare(ior, transmits, clear); }
    /// And those of layers.
    static void prepareLayers(bool sheen, bool anisotropy);

private:
    static constexpr float kMinLayerShare = 0.05f;

    void addLayers(const LayerInputs& layers, bool inside, const Vec3& wo);
    void chooseProbabilities();
    /// Into the frame whose x is the direction of anisotropy, and back.
    Vec3 turned(const Vec3& w) const { return {turn_.x * w.x + turn_.y * w.y, turn_.x * w.y - turn_.y * w.x, w.z}; }
    Vec3 turnedBack(const Vec3& w) const { return {turn_.x * w.x - turn_.y * w.y, turn_.x * w.y + turn_.y * w.x, w.z}; }
    BsdfSample combined(const Vec3& wi, Lobe lobe) const;
    BsdfSample sampleCoat(Vec2 u) const;

    BaseBsdf base_;
    bool layered_ = false;
    Vec2 turn_{1, 0};
    std::optional<Clearcoat> coat_;
    std::optional<Sheen> sheen_;
    float belowCoat_ = 1, belowSheen_ = 1;                  ///< what each lets through; the base keeps both
    float coatShare_ = 0, sheenShare_ = 0, baseShare_ = 1;  ///< of samples
};

}  // namespace lumi
