#pragma once
#include "trace/bsdf.h"
#include "trace/packets.h"
#include "trace/ray.h"
#include "trace/scene_tables.h"
#include "trace/texture_lookups.h"

namespace lumi {

/// All that shading wants to know of a hit. World space.
struct Surface {
    SurfacePoint point;
    Vec3 position{0};
    Vec3 geometricNormal{0, 0, 1};  ///< unit, on wo's side
    Vec3 normal{0, 0, 1};           ///< unit, on wo's side; bent so that mirror reflections stay above the surface
    Vec3 outwardNormal{0, 0, 1};    ///< geometric normal of the front face, not flipped
    bool frontFace = true;          ///< wo is on the front (outer) side
    int body = -1;                  ///< a light's body, which scatters nothing
    uint32_t material = 0;
    float offset = 0;  ///< metres that rays start off the surface beyond rounding of `position` itself
    Vec3 emitted{0};   ///< radiance towards wo
    BsdfInputs inputs;
};

/// The name of a hit: bodies of lights are named by where they were hit.
SurfacePoint surfacePoint(const SceneTables& tables, const RawHit& hit, const Vec3& hitPosition, float time);

/// Asks the caches for what surfaceGeometry() will read of these hits.
void prefetchSurfaces(const SceneTables& tables, std::span<const RawHit> hits);

/// Where a triangle was hit, before its material is looked up. World space.
struct SurfaceGeometry {
    Vec3 position{0};
    Vec3 edge1{0}, edge2{0};      ///< of the triangle
    Vec3 outwardNormal{0, 0, 1};  ///< as in Surface, and the next two
    bool frontFace = true;
    float offset = 0;
    float footprint = 0;  ///< width of texture lookups on the surface, metres
    float twiceArea = 0;  ///< of the triangle
};

/// The geometry of `point` (not on a light's body) as seen along unit `wo`; `width` is the footprint's width in metres.
/// Asks the caches for the material's texels: shade a little later.
SurfaceGeometry surfaceGeometry(const SceneTables& tables, const SurfacePoint& point, const Vec3& wo, float width);

/// Interpolates and shades `point` as seen along unit `wo`. `geometry` of bodies is not read.
Surface evaluateSurface(const SceneTables& tables, const SurfacePoint& point, const SurfaceGeometry& geometry,
                        const Vec3& wo, MipFilter mips);
Surface evaluateSurface(const SceneTables& tables, const SurfacePoint& point, const Vec3& wo, float width);

/// Shading normal in object space in the mesh's rest pose, on wo's side, unit; normal maps left out.
Vec3 restNormal(const SceneTables& tables, const Surface& surface);
/// The same of a triangle's point, wo on its front side or behind.
Vec3 restNormal(const SceneTables& tables, const SurfacePoint& point, bool frontFace);

/// Unit smooth normal of the front face, normal maps left out.
Vec3 smoothNormal(const SceneTables& tables, const SurfacePoint& point);

/// World position alone; at the previous frame's time for the second.
Vec3 surfacePosition(const SceneTables& tables, const SurfacePoint& point);
Vec3 previousSurfacePosition(const SceneTables& tables, const PosedScene& posed, const SurfacePoint& point);

/// Emission of a triangle's point towards unit wo times its coverage, textures unfiltered: what a light sample there is
/// worth.
Vec3 triangleEmission(const SceneTables& tables, const SurfacePoint& point, const Vec3& wo);

/// A start for rays that leave `position` towards the side of `normal`: moved by a few hundred units in the last place
/// of each coordinate [Waechter & Binder 2019], and by `extra` metres more.
Vec3 offsetOrigin(const Vec3& position, const Vec3& normal, float extra = 0);

}  // namespace lumi
