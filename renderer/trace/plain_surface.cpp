#include "trace/plain_surface.h"

#include <cmath>

#include "trace/bsdf_inputs.h"

namespace lumi {
namespace {

template <class T>
T interpolate(const T* values, const UVec3& t, float b1, float b2) {
    return values[t.x] * (1 - b1 - b2) + values[t.y] * b1 + values[t.z] * b2;
}

/// Tangents of the mesh in the world, for the normal map.
void collectTangents(const InstanceRecord& r, const UVec3& t, const Vec3& objectNormal, const RawHit& hit,
                     PlainLanes& lanes, int i) {
    const Mat3 directions(r.worldFromObject);
    const Vec3 tangent = r.deformedTangents ? interpolate(r.deformedTangents, t, hit.u, hit.v)
                                            : Vec3(interpolate(r.tangents, t, hit.u, hit.v));
    const float hand = r.tangents[t.x].w < 0 ? -1.0f : 1.0f;
    lanes.tangent.set(i, directions * tangent);
    const Vec3 across =
        r.deformedBitangents ? interpolate(r.deformedBitangents, t, hit.u, hit.v) : glm::cross(objectNormal, tangent);
    lanes.bitangent.set(i, directions * (across * hand));
}

void collectTextureCoordinates(const Vec2* uv, const UVec3& t, PlainLanes& lanes, int i) {
    const Vec2 a = uv ? uv[t.x] : Vec2(0), d1 = uv ? uv[t.y] - a : Vec2(0), d2 = uv ? uv[t.z] - a : Vec2(0);
    lanes.cornerU[i] = a.x, lanes.cornerV[i] = a.y;
    lanes.edge1U[i] = d1.x, lanes.edge1V[i] = d1.y, lanes.edge2U[i] = d2.x, lanes.edge2V[i] = d2.y;
}

}  // namespace

void collectTriangle(const InstanceRecord& r, const MaterialRecord& material, const RawHit& hit, PlainLanes& lanes,
                     int i) {
    const UVec3 t = r.triangles[hit.primitive];
    Vec3 corners[3] = {r.positions[t.x], r.positions[t.y], r.positions[t.z]};
    if (!r.inWorld)
        for (Vec3& corner : corners) corner = transformPoint(r.worldFromObject, corner);
    lanes.corner.set(i, corners[0]);
    lanes.edge1.set(i, corners[1] - corners[0]), lanes.edge2.set(i, corners[2] - corners[0]);
    lanes.flip[i] = r.mirrored ? -1.0f : 1.0f;
    lanes.across[i] = hit.u, lanes.along[i] = hit.v;
    lanes.offset[i] = r.inWorld ? 0 : r.objectScale * 0x1p-18f;
    Vec3 normal(0);
    if (r.normals) normal = interpolate(r.normals, t, hit.u, hit.v);
    lanes.vertexNormal.set(i, r.normals ? r.normalFromObject * normal : Vec3(0));
    const bool mapped = material.views[MaterialRecord::kNormalView] >= 0;
    lanes.tangents[i] = !mapped ? PlainLanes::kNone : r.tangents ? PlainLanes::kGiven : PlainLanes::kDerived;
    if (mapped && r.tangents) collectTangents(r, t, normal, hit, lanes, i);
    lanes.mapped |= mapped;
    if (material.textures != 0) collectTextureCoordinates(r.uv[material.uvSet], t, lanes, i), lanes.textured = true;

    Vec3 baseColor = material.baseColor;
    if (r.colours) baseColor *= Vec3(interpolate(r.colours, t, hit.u, hit.v));
    lanes.baseColor.set(i, baseColor);
    lanes.metallic[i] = material.metallic, lanes.roughness[i] = material.roughness;
    lanes.specularColor.set(i, saturate(material.specularColor * 1e-4f) * 1e4f);
    lanes.specular[i] = saturate(material.specular);
    lanes.glossy |= material.metallic > 0 || material.specular > 0;
    lanes.ior[i] = material.ior >= 1 && std::isfinite(material.ior) ? material.ior : 1.5f;
}

void findTexels(const SceneTables& tables, const PlainLanes& lanes, int i, bool between, PlainTaps& taps) {
    const MaterialRecord& material = *taps.material;
    int shared = -1;
    for (int k = 0; k < MaterialRecord::kViews; ++k) {
        taps.fraction[k] = 0;
        if (material.views[k] < 0) continue;
        const TextureView& view = tables.textures[static_cast<size_t>(material.views[k])];
        if (shared >= 0) {
            taps.taps[k] = taps.taps[shared], taps.fraction[k] = taps.fraction[shared];
        } else {
            taps.taps[k] = findTaps(view, lanes.textureU[i], lanes.textureV[i], lanes.textureWidth[i],
                                    between ? &taps.fraction[k] : nullptr);
            if (material.sharedTaps) shared = k;
        }
        prefetch(view, taps.taps[k]);
    }
}

void readTexels(const SceneTables& tables, const PlainTaps& taps, PlainLanes& lanes, int i) {
    const MaterialRecord& material = *taps.material;
    const auto read = [&](int k) {
        const TextureView& view = tables.textures[static_cast<size_t>(material.views[k])];
        const Vec4 fine = blend(view, taps.taps[k]);
        if (!(taps.fraction[k] > 0)) return fine;
        const Vec4 coarse = blend(view, coarser(view, lanes.textureU[i], lanes.textureV[i], taps.taps[k].level));
        return fine + (coarse - fine) * taps.fraction[k];
    };
    if (material.views[MaterialRecord::kBaseColorView] >= 0) {
        const Vec4 texel = read(MaterialRecord::kBaseColorView);
        lanes.baseColor.x[i] *= texel.x, lanes.baseColor.y[i] *= texel.y, lanes.baseColor.z[i] *= texel.z;
    }
    if (material.views[MaterialRecord::kMetallicRoughnessView] >= 0) {
        const Vec4 texel = read(MaterialRecord::kMetallicRoughnessView);
        lanes.roughness[i] *= texel.y;
        lanes.metallic[i] *= texel.z;
    }
    if (material.views[MaterialRecord::kNormalView] >= 0) {
        const Vec4 texel = read(MaterialRecord::kNormalView);
        const float scale = material.source->normalScale;
        lanes.mapTexel.set(i, Vec3((texel.x * 2 - 1) * scale, (texel.y * 2 - 1) * scale, texel.z * 2 - 1));
    }
}

}  // namespace lumi
