#pragma once
#include "math/transform.h"
#include "trace/albedo_table.h"
#include "trace/bsdf_inputs.h"
#include "trace/ggx.h"

namespace lumi {

/// Fresnel reflectance of the varnish at a cosine to its normal (Schlick).
float clearcoatReflectance(float cosine);

/// A clear varnish over a surface: GGX reflection under Schlick's Fresnel term at index 1.5, about a normal of its own.
/// Single scattering: what facets of that little reflectance scatter twice is lost.
class Clearcoat {
public:
    /// `wo` in the surface's local frame.
    Clearcoat(const LayerInputs& layers, const Vec3& wo);

    bool isDelta() const { return smooth_; }
    /// Share of light from everywhere that it reflects towards wo; the surface below is seen through the rest.
    float albedo() const { return albedo_; }
    /// `wi` in the surface's local frame. 0 if a delta.
    LobeValue evaluate(const Vec3& wi) const;
    /// A direction by the facets that wo sees, or the mirrored one; it may lie under the surface below, or under the
    /// varnish.
    Vec3 sample(Vec2 u) const;

private:
    Frame frame_;
    Vec3 wo_;  ///< in frame_
    Ggx ggx_;
    float weight_ = 0, lambdaO_ = 0, albedo_ = 0;
    bool smooth_ = false;
};

}  // namespace lumi
