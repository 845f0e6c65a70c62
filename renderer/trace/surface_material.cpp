#include "trace/surface_material.h"

#include <algorithm>
#include <cmath>

#include "trace/texture_lookups.h"

namespace lumi {
namespace {

/// Into [0, 1]; NaN becomes 0.
float unitInterval(float x) { return x > 0 ? std::min(x, 1.0f) : 0.0f; }
Vec3 unitInterval(const Vec3& v) { return {unitInterval(v.x), unitInterval(v.y), unitInterval(v.z)}; }

/// The mesh's colour, of an instance that has one.
Vec3 colourAt(const InstanceRecord& instance, const UVec3& t, Vec2 b) {
    return Vec3(instance.colours[t.x] * (1 - b.x - b.y) + instance.colours[t.y] * b.x + instance.colours[t.z] * b.y);
}

}  // namespace

void prefetchMaterial(const MaterialRecord& m, TextureLookups& lookup) {
    if (!m.textures) return;
    const Material& source = *m.source;
    const auto ask = [&](uint32_t flag, const Texture& texture) {
        if (m.textures & flag) lookup.prefetch(texture);
    };
    ask(MaterialRecord::kBaseColor, source.baseColorTexture);
    ask(MaterialRecord::kMetallicRoughness, source.metallicRoughnessTexture);
    ask(MaterialRecord::kNormal, source.normalTexture);
    ask(MaterialRecord::kSpecular, source.specularTexture);
    ask(MaterialRecord::kSpecularColor, source.specularColorTexture);
    ask(MaterialRecord::kTransmission, source.transmissionTexture);
}

void evaluateMaterial(const MaterialRecord& m, TextureLookups& lookup, Surface& surface) {
    const InstanceRecord& instance = lookup.instance();
    const UVec3& t = lookup.triangle();
    const Vec2 b = lookup.barycentrics();
    BsdfInputs& in = surface.inputs;
    in.baseColor = m.baseColor;
    in.metallic = m.metallic, in.roughness = m.roughness;
    in.specular = m.specular, in.specularColor = m.specularColor;
    in.transmission = m.transmission;
    in.ior = m.ior;
    in.solid = m.solid;
    if (m.textures) {
        const Material& source = *m.source;
        const auto has = [&](uint32_t flag) { return (m.textures & flag) != 0; };
        if (has(MaterialRecord::kBaseColor)) in.baseColor *= Vec3(lookup(source.baseColorTexture));
        if (has(MaterialRecord::kMetallicRoughness)) {
            const Vec4 texel = lookup(source.metallicRoughnessTexture);
            in.roughness *= texel.y;
            in.metallic *= texel.z;
        }
        if (has(MaterialRecord::kSpecular)) in.specular *= lookup(source.specularTexture).w;
        if (has(MaterialRecord::kSpecularColor)) in.specularColor *= Vec3(lookup(source.specularColorTexture));
        if (has(MaterialRecord::kTransmission)) in.transmission *= lookup(source.transmissionTexture).x;
    }
    if (instance.colours) in.baseColor *= colourAt(instance, t, b);
    in.baseColor = unitInterval(in.baseColor);
    in.metallic = unitInterval(in.metallic), in.roughness = unitInterval(in.roughness);
    in.specular = unitInterval(in.specular), in.transmission = unitInterval(in.transmission);
    in.specularColor = glm::max(in.specularColor, Vec3(0));
    if (!(in.ior >= 1) || !std::isfinite(in.ior)) in.ior = 1.5f;
    if (m.layered) evaluateLayers(*m.source, lookup, in);

    surface.emitted = Vec3(0);
    if (m.emits && (surface.frontFace || m.doubleSided)) {
        // Unfiltered, whatever the footprint: light samples must find the same radiance.
        surface.emitted = emissionAt(m, instance, t, b);
    }
}

Vec3 emissionAt(const MaterialRecord& m, const InstanceRecord& instance, const UVec3& t, Vec2 b) {
    const Vec3 factor = m.unlit && instance.colours ? m.emission * colourAt(instance, t, b) : m.emission;
    if (!(m.textures & MaterialRecord::kEmission)) return factor;
    const Texture& texture = m.source->emissionTexture;
    const Vec2* uv = instance.uv[texture.uvSet == 1 ? 1 : 0];
    const Vec2 at = uv ? uv[t.x] * (1 - b.x - b.y) + uv[t.y] * b.x + uv[t.z] * b.y : Vec2(0);
    return factor * Vec3(texture.sample(at));
}

Vec3 mappedNormal(const Texture& texture, float scale, TextureLookups& lookup, const Vec3& tangent,
                  const Vec3& bitangent, const Vec3& normal) {
    const float lengthT = glm::length(tangent), lengthB = glm::length(bitangent);
    if (!(lengthT > 0) || !(lengthB > 0) || !std::isfinite(lengthT + lengthB)) return normal;
    const Vec3 texel = Vec3(lookup(texture)) * 2.0f - Vec3(1);
    const Vec3 mapped =
        tangent * (texel.x * scale / lengthT) + bitangent * (texel.y * scale / lengthB) + normal * texel.z;
    const float length = glm::length(mapped);
    return length > 1e-6f && std::isfinite(length) ? mapped / length : normal;
}

}  // namespace lumi
