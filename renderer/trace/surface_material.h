#pragma once
#include "trace/surface.h"
#include "trace/texture_lookups.h"

namespace lumi {

/// Fills the material side of `surface` (inputs, emission): factors times textures times vertex colour.
/// Values that are not finite or out of range become the nearest that are valid.
void evaluateMaterial(const MaterialRecord& material, TextureLookups& lookup, Surface& surface);

/// Asks the caches for the texels of what evaluateMaterial() and mappedNormal() will look up, layers left out.
void prefetchMaterial(const MaterialRecord& material, TextureLookups& lookup);

/// Radiance that the front (or, if two-sided, either) face emits.
Vec3 emissionAt(const MaterialRecord& material, const InstanceRecord& instance, const UVec3& triangle,
                Vec2 barycentrics);

/// The normal map's normal, unit, world space, on the side of `normal`; `normal` itself without a tangent frame.
Vec3 mappedNormal(const Texture& texture, float scale, TextureLookups& lookup, const Vec3& tangent,
                  const Vec3& bitangent, const Vec3& normal);

/// Clearcoat, sheen, anisotropy and iridescence: factors times textures. The direction of anisotropy is left in the
/// tangent frame (bitangent up in glTF's sense); the coat's normal is left alone.
void evaluateLayers(const Material& source, TextureLookups& lookup, BsdfInputs& inputs);

}  // namespace lumi
