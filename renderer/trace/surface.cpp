#include "trace/surface.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "trace/clearcoat.h"
#include "trace/coverage.h"
#include "trace/moving_triangle.h"
#include "trace/quick_unit.h"
#include "trace/surface_material.h"

namespace lumi {
namespace {

/// Half-precision of the reflection's height above the surface that a bent normal keeps.
constexpr float kLeastCosine = 1e-3f;

template <class T>
T interpolate(const T* values, const UVec3& t, Vec2 b) {
    return values[t.x] * (1 - b.x - b.y) + values[t.y] * b.x + values[t.z] * b.y;
}

/// Bends the shading normal so that the mirror direction of wo stays above the geometric surface
/// [Keller et al. 2017, "The Iray Light Transport Simulation and Rendering System", appendix].
Vec3 consistentNormal(const Vec3& shading, const Vec3& geometric, const Vec3& wo) {
    const Vec3 mirrored = 2 * glm::dot(wo, shading) * shading - wo;
    const float height = glm::dot(mirrored, geometric);
    if (height >= kLeastCosine && glm::dot(wo, shading) > 0) return shading;
    const Vec3 lifted = mirrored + geometric * (kLeastCosine - height);
    return quickUnitOr(wo + quickUnitOr(lifted, geometric), geometric);
}

/// The triangle's tangent frame for its normal map: mesh tangents, or the directions of growing u and of falling v
/// (glTF's images have v down, their green channel points up).
struct TangentFrame {
    Vec3 tangent{0}, bitangent{0};
};

TangentFrame tangentFrame(const InstanceRecord& r, uint32_t primitive, const UVec3& t, Vec2 b, const Vec3& objectNormal,
                          const Vec3& edge1, const Vec3& edge2, const Vec3& worldNormal, const Texture& texture) {
    const Mat3 directions(r.worldFromObject);
    if (r.tangents) {
        const Vec3 tangent =
            r.deformedTangents ? interpolate(r.deformedTangents, t, b) : Vec3(interpolate(r.tangents, t, b));
        const float hand = r.tangents[t.x].w < 0 ? -1.0f : 1.0f;
        const Vec3 across =
            r.deformedBitangents ? interpolate(r.deformedBitangents, t, b) : glm::cross(objectNormal, tangent);
        return {directions * tangent, directions * (across * hand)};
    }
    const Vec2* uv = r.uv[texture.uvSet == 1 ? 1 : 0];
    if (!uv) return {};
    const Vec2 d1 = uv[t.y] - uv[t.x], d2 = uv[t.z] - uv[t.x];
    const float determinant = d1.x * d2.y - d1.y * d2.x;
    if (!(std::abs(determinant) > 0)) return {};
    const float sign = determinant > 0 ? 1.0f : -1.0f;
    // Gradients of u and v, scaled; across the surface's smooth normal.
    Vec3 alongU = (edge1 * d2.y - edge2 * d1.y) * sign, alongV = (edge2 * d1.x - edge1 * d2.x) * sign;
    alongU -= worldNormal * glm::dot(worldNormal, alongU);
    alongV -= worldNormal * glm::dot(worldNormal, alongV);
    return {alongU, -alongV};
}

/// A direction of the tangent plane in the plane of `local`; its x without a tangent frame.
Vec2 alongSurface(const Frame& local, const TangentFrame& frame, Vec2 direction) {
    const Vec3 world =
        quickUnitOr(frame.tangent, Vec3(0)) * direction.x + quickUnitOr(frame.bitangent, Vec3(0)) * direction.y;
    const Vec2 along(local.toLocal(world));
    return glm::length(along) > 1e-6f ? along : Vec2(1, 0);
}

uint32_t materialOf(const SceneTables& tables, const SurfacePoint& point) {
    const uint32_t material = tables.instances[point.instance].materialOf(point.primitive);
    return material < tables.materials.size() ? material : 0;
}

Surface bodySurface(const SceneTables& tables, const SurfacePoint& point, const Vec3& wo) {
    const InstanceRecord& r = tables.instances[point.instance];
    const LightShape shape = tables.bodies[static_cast<size_t>(r.body)].at(point.time);
    Surface s;
    s.point = point;
    s.body = r.body;
    s.material = r.material;
    s.position = shape.position(point.barycentrics);
    s.outwardNormal = shape.normalAt(point.barycentrics);
    s.frontFace = glm::dot(s.outwardNormal, wo) > 0;
    s.normal = s.geometricNormal = s.frontFace ? s.outwardNormal : -s.outwardNormal;
    s.offset = shape.type == LightType::Sphere ? shape.radius * 2e-4f : 0;
    s.emitted = s.frontFace ? shape.radianceAt(point.barycentrics) : Vec3(0);
    s.inputs.baseColor = Vec3(0);
    s.inputs.specular = 0;
    s.inputs.roughness = 1;
    return s;
}

}  // namespace

void prefetchSurfaces(const SceneTables& tables, std::span<const RawHit> hits) {
    const auto usable = [&](const RawHit& hit) { return hit.valid() && tables.instances[hit.instance].body < 0; };
    for (const RawHit& hit : hits)
        if (usable(hit)) __builtin_prefetch(&tables.instances[hit.instance].triangles[hit.primitive]);
    for (const RawHit& hit : hits) {
        if (!usable(hit)) continue;
        const InstanceRecord& r = tables.instances[hit.instance];
        const UVec3 t = r.triangles[hit.primitive];
        for (int c = 0; c < 3; ++c) {
            __builtin_prefetch(&r.positions[t[c]]);
            if (r.normals) __builtin_prefetch(&r.normals[t[c]]);
            if (r.uv[0]) __builtin_prefetch(&r.uv[0][t[c]]);
            if (r.tangents) __builtin_prefetch(&r.tangents[t[c]]);
        }
    }
}

SurfacePoint surfacePoint(const SceneTables& tables, const RawHit& hit, const Vec3& hitPosition, float time) {
    SurfacePoint point{hit.instance, hit.primitive, {hit.u, hit.v}, time};
    const int body = tables.instances[hit.instance].body;
    if (body >= 0) {
        point.primitive = 0;
        point.barycentrics = tables.bodies[static_cast<size_t>(body)].at(time).nameOf(hitPosition);
    }
    return point;
}

namespace {

/// The two below of a triangle of `r`, whose corners are its vertices `t`.
SurfaceGeometry geometryOf(const SceneTables& tables, const InstanceRecord& r, const UVec3& t,
                           const SurfacePoint& point, const Vec3& wo, float width) {
    const Vec2 b = point.barycentrics;

    // Position and geometric normal, in the space of the vertices, then in the world.
    const Vec3 p0 = r.positions[t.x];
    SurfaceGeometry g;
    g.edge1 = r.positions[t.y] - p0, g.edge2 = r.positions[t.z] - p0;
    g.position = p0 + g.edge1 * b.x + g.edge2 * b.y;
    Vec3 outward = glm::cross(g.edge1, g.edge2);
    g.twiceArea = glm::length(outward);
    if (r.inWorld ? r.mirrored : r.turned) outward = -outward;
    if (!r.inWorld) {
        g.position = transformPoint(r.worldFromObject, g.position);
        outward = r.normalFromObject * outward;
        g.edge1 = transformVector(r.worldFromObject, g.edge1);
        g.edge2 = transformVector(r.worldFromObject, g.edge2);
        g.twiceArea = glm::length(glm::cross(g.edge1, g.edge2));
        g.offset = r.objectScale * 0x1p-18f;
    }
    g.outwardNormal = quickUnitOr(outward, wo);
    const float cosine = glm::dot(g.outwardNormal, wo);
    g.frontFace = cosine >= 0;
    g.footprint = width / std::sqrt(std::max(std::abs(cosine), 0.04f));

    const MaterialRecord& material = tables.materials[materialOf(tables, point)];
    TextureLookups lookup(r, t, b, g.footprint, g.twiceArea, MipFilter::Nearest);
    prefetchMaterial(material, lookup);
    return g;
}

/// Share of the emission below that a clearcoat lets through towards wo [KHR_materials_clearcoat, "Emission"].
float coatTransmittance(const Surface& s, const Vec3& wo) {
    const LayerInputs& layers = s.inputs.layers;
    const float cosine = glm::dot(layers.clearcoatNormal, Frame(s.normal).toLocal(wo));
    return 1 - saturate(layers.clearcoat) * clearcoatReflectance(cosine);
}

Surface surfaceOf(const SceneTables& tables, const InstanceRecord& r, const UVec3& t, const SurfacePoint& point,
                  const SurfaceGeometry& geometry, const Vec3& wo, MipFilter mips) {
    const Vec2 b = point.barycentrics;
    const Vec3 &edge1 = geometry.edge1, &edge2 = geometry.edge2;
    Surface s;
    s.point = point;
    s.position = geometry.position;
    s.offset = geometry.offset;
    s.outwardNormal = geometry.outwardNormal;
    s.frontFace = geometry.frontFace;
    s.geometricNormal = s.frontFace ? s.outwardNormal : -s.outwardNormal;

    // Smooth normal of the front face.
    Vec3 objectNormal(0);
    Vec3 smooth = s.outwardNormal;
    if (r.normals) {
        objectNormal = interpolate(r.normals, t, b);
        smooth = quickUnitOr(r.normalFromObject * objectNormal, s.outwardNormal);
    }

    // Material, textures filtered over the footprint.
    s.material = materialOf(tables, point);
    const MaterialRecord& material = tables.materials[s.material];
    TextureLookups lookup(r, t, b, geometry.footprint, geometry.twiceArea, mips);
    evaluateMaterial(material, lookup, s);

    const Vec3 unmapped = smooth;
    const auto frameOf = [&](const Texture& texture) {
        return tangentFrame(r, point.primitive, t, b, objectNormal, edge1, edge2, unmapped, texture);
    };
    const auto mapped = [&](const Texture& texture, float scale) {
        const TangentFrame frame = frameOf(texture);
        return mappedNormal(texture, scale, lookup, frame.tangent, frame.bitangent, unmapped);
    };
    if (material.textures & MaterialRecord::kNormal)
        smooth = mapped(material.source->normalTexture, material.source->normalScale);
    const auto seen = [&](const Vec3& front) {
        const Vec3 shading = s.frontFace ? front : -front;
        // A normal that points away from the geometric one altogether is a modelling slip.
        return consistentNormal(glm::dot(shading, s.geometricNormal) < 0 ? -shading : shading, s.geometricNormal, wo);
    };
    s.normal = seen(smooth);
    if (material.layered) {
        const Frame local(s.normal);
        LayerInputs& layers = s.inputs.layers;
        if (layers.clearcoat > 0) {
            const Texture& own = material.source->clearcoatNormalTexture;
            layers.clearcoatNormal =
                local.toLocal(seen(own ? mapped(own, material.source->clearcoatNormalScale) : unmapped));
        }
        if (layers.anisotropy > 0) {
            const TangentFrame frame = frameOf(material.source->anisotropyTexture);
            layers.anisotropyDirection = alongSurface(local, frame, layers.anisotropyDirection);
        }
    }
    s.inputs.entering = s.frontFace;
    if (material.coatedEmission && !isBlack(s.emitted)) {
        // Unfiltered, as all emission.
        SurfaceGeometry sharp = geometry;
        sharp.footprint = 0;
        s.emitted *= geometry.footprint > 0 ? coatTransmittance(surfaceOf(tables, r, t, point, sharp, wo, mips), wo)
                                            : coatTransmittance(s, wo);
    }
    return s;
}

}  // namespace

SurfaceGeometry surfaceGeometry(const SceneTables& tables, const SurfacePoint& point, const Vec3& wo, float width) {
    const InstanceRecord& r = tables.instances[point.instance];
    if (!r.track) return geometryOf(tables, r, r.triangles[point.primitive], point, wo, width);
    const MovingTriangle moving(r, point.primitive, point.time);
    return geometryOf(tables, moving.instance(), MovingTriangle::kCorners, point, wo, width);
}

Surface evaluateSurface(const SceneTables& tables, const SurfacePoint& point, const SurfaceGeometry& geometry,
                        const Vec3& wo, MipFilter mips) {
    const InstanceRecord& r = tables.instances[point.instance];
    if (r.body >= 0) return bodySurface(tables, point, wo);
    if (!r.track) return surfaceOf(tables, r, r.triangles[point.primitive], point, geometry, wo, mips);
    const MovingTriangle moving(r, point.primitive, point.time);
    return surfaceOf(tables, moving.instance(), MovingTriangle::kCorners, point, geometry, wo, mips);
}

Surface evaluateSurface(const SceneTables& tables, const SurfacePoint& point, const Vec3& wo, float width) {
    const bool body = tables.instances[point.instance].body >= 0;
    const SurfaceGeometry geometry = body ? SurfaceGeometry() : surfaceGeometry(tables, point, wo, width);
    return evaluateSurface(tables, point, geometry, wo, MipFilter::Between);
}

Vec3 restNormal(const SceneTables& tables, const Surface& s) {
    return tables.instances[s.point.instance].body >= 0 ? s.normal : restNormal(tables, s.point, s.frontFace);
}

Vec3 restNormal(const SceneTables& tables, const SurfacePoint& point, bool frontFace) {
    const InstanceRecord& r = tables.instances[point.instance];
    const UVec3 t = r.triangles[point.primitive];
    Vec3 rest = r.restNormals ? interpolate(r.restNormals, t, point.barycentrics) : Vec3(0);
    if (!r.restNormals) {
        const Vec3* p = r.restPositions;
        rest = glm::cross(p[t.y] - p[t.x], p[t.z] - p[t.x]);
    }
    return quickUnitOr(frontFace ? rest : -rest, Vec3(0, 1, 0));
}

Vec3 triangleEmission(const SceneTables& tables, const SurfacePoint& point, const Vec3& wo) {
    const InstanceRecord& r = tables.instances[point.instance];
    const MaterialRecord& material = tables.materials[r.materialOf(point.primitive)];
    const UVec3& corners = r.triangles[point.primitive];
    const Vec2 b = point.barycentrics;
    const Vec3 emission =
        material.coatedEmission ? evaluateSurface(tables, point, wo, 0).emitted : emissionAt(material, r, corners, b);
    if (!material.source->hasAlpha()) return emission;
    return emission * coverage(*material.source, alphaAt(*material.source, corners, r.colours, r.uv, b));
}

Vec3 offsetOrigin(const Vec3& position, const Vec3& normal, float extra) {
    constexpr float kNearOrigin = 1.0f / 32, kFloatScale = 1.0f / 65536, kIntScale = 256;
    Vec3 result;
    for (int c = 0; c < 3; ++c) {
        const auto steps = static_cast<int32_t>(kIntScale * normal[c]);
        const float moved =
            std::bit_cast<float>(std::bit_cast<int32_t>(position[c]) + (position[c] < 0 ? -steps : steps));
        result[c] = std::abs(position[c]) < kNearOrigin ? position[c] + kFloatScale * normal[c] : moved;
    }
    return result + normal * extra;
}

}  // namespace lumi
