#pragma once
#include "trace/bsdf_inputs.h"

namespace lumi {

/// Fibres that stand on a surface and shine at grazing angles: the "Charlie" distribution with its fitted masking
/// [Estevez & Kulla 2017, "Production Friendly Microfacet Sheen BRDF"], held below 1 where it
/// would reflect more than arrives. Reciprocal.
class Sheen {
public:
    static constexpr float kLeastRoughness = 0.07f;

    /// `wo` in the local frame, wo.z > 0.
    Sheen(const LayerInputs& layers, const Vec3& wo);

    /// Share of light from everywhere that it reflects towards wo. In [0,1].
    Vec3 albedo() const { return color_ * directional_; }
    /// What the surface below keeps.
    float through() const { return 1 - maxComponent(color_) * directional_; }
    /// Density of sample(): uniform over the hemisphere, since the lobe is broad and strongest at its rim.
    LobeValue evaluate(const Vec3& wi) const;
    Vec3 sample(Vec2 u) const;

    /// Makes the table of albedos (some 100 ms the first time). Any thread.
    static void prepare();

private:
    Vec3 color_, wo_;
    float roughness_ = 1, lambdaO_ = 0, excessO_ = 1, directional_ = 0;
};

}  // namespace lumi
