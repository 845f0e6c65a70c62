#include "trace/surface_material.h"

#include <algorithm>
#include <cmath>

namespace lumi {
namespace {

/// Into [0, 1]; NaN becomes 0.
float unitInterval(float x) { return x > 0 ? std::min(x, 1.0f) : 0.0f; }
Vec3 unitInterval(const Vec3& v) { return {unitInterval(v.x), unitInterval(v.y), unitInterval(v.z)}; }

/// Texture coordinates of a surface point, and how many of their units a metre of the surface spans.
class Lookups {
public:
    Lookups(const InstanceRecord& instance, const UVec3& triangle, Vec2 barycentrics, float footprint, float twiceArea)
        : instance_(instance), triangle_(triangle), b_(barycentrics), footprint_(footprint), twiceArea_(twiceArea) {}

    Vec4 operator()(const Texture& texture) {
        const int set = texture.uvSet == 1 ? 1 : 0;
        if (!known_[set]) find(set);
        return texture.sample(uv_[set], width_[set]);
    }

private:
    void find(int set) {
        known_[set] = true;
        const Vec2* uv = instance_.uv[set];
        if (!uv) return;
        const Vec2 a = uv[triangle_.x], d1 = uv[triangle_.y] - a, d2 = uv[triangle_.z] - a;
        uv_[set] = a + d1 * b_.x + d2 * b_.y;
        const float twiceUvArea = std::abs(d1.x * d2.y - d1.y * d2.x);
        if (footprint_ > 0 && twiceArea_ > 0) width_[set] = footprint_ * std::sqrt(twiceUvArea / twiceArea_);
    }

    const InstanceRecord& instance_;
    const UVec3 triangle_;
    const Vec2 b_;
    const float footprint_, twiceArea_;
    bool known_[2] = {false, false};
    Vec2 uv_[2] = {Vec2(0), Vec2(0)};
    float width_[2] = {0, 0};
};

}  // namespace

void evaluateMaterial(const MaterialRecord& m, const InstanceRecord& instance, const UVec3& t, Vec2 b, float footprint,
                      float twiceArea, Surface& surface) {
    Lookups lookup(instance, t, b, footprint, twiceArea);
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
    if (instance.colours) {
        const Vec4 colour = instance.colours[t.x] * (1 - b.x - b.y) + instance.colours[t.y] * b.x + instance.colours[t.z] * b.y;
        in.baseColor *= Vec3(colour);
    }
    in.baseColor = unitInterval(in.baseColor);
    in.metallic = unitInterval(in.metallic), in.roughness = unitInterval(in.roughness);
    in.specular = unitInterval(in.specular), in.transmission = unitInterval(in.transmission);
    in.specularColor = glm::max(in.specularColor, Vec3(0));
    if (!(in.ior >= 1) || !std::isfinite(in.ior)) in.ior = 1.5f;
    surface.absorption = m.absorption;

    surface.emitted = Vec3(0);
    if (m.emits && (surface.frontFace || m.doubleSided)) {
        // Unfiltered, whatever the footprint: light samples must find the same radiance.
        surface.emitted = emissionAt(m, instance, t, b);
    }
}

Vec3 emissionAt(const MaterialRecord& m, const InstanceRecord& instance, const UVec3& t, Vec2 b) {
    if (!(m.textures & MaterialRecord::kEmission)) return m.emission;
    const Texture& texture = m.source->emissionTexture;
    const Vec2* uv = instance.uv[texture.uvSet == 1 ? 1 : 0];
    const Vec2 at = uv ? uv[t.x] * (1 - b.x - b.y) + uv[t.y] * b.x + uv[t.z] * b.y : Vec2(0);
    return m.emission * Vec3(texture.sample(at));
}

Vec3 mappedNormal(const MaterialRecord& m, const InstanceRecord& instance, const UVec3& t, Vec2 b, float footprint,
                  float twiceArea, const Vec3& tangent, const Vec3& bitangent, const Vec3& normal) {
    const float lengthT = glm::length(tangent), lengthB = glm::length(bitangent);
    if (!(lengthT > 0) || !(lengthB > 0) || !std::isfinite(lengthT + lengthB)) return normal;
    Lookups lookup(instance, t, b, footprint, twiceArea);
    const Vec3 texel = Vec3(lookup(m.source->normalTexture)) * 2.0f - Vec3(1);
    const float scale = m.source->normalScale;
    const Vec3 mapped = tangent * (texel.x * scale / lengthT) + bitangent * (texel.y * scale / lengthB) + normal * texel.z;
    const float length = glm::length(mapped);
    return length > 1e-6f && std::isfinite(length) ? mapped / length : normal;
}

}  // namespace lumi
