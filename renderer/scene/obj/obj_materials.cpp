#include "scene/obj/obj_materials.h"

#include <algorithm>
#include <cmath>

namespace lumi {
namespace {

Vec3 colour(const float* c, float most = 1) {
    const Vec3 v(c[0], c[1], c[2]);
    return isFinite(v) ? glm::clamp(v, Vec3(0), Vec3(most)) : Vec3(0);
}

/// Phong exponent to roughness: alpha = sqrt(2 / (n + 2)), and roughness is the root of alpha.
float roughnessFromShininess(float exponent) { return std::pow(2 / (std::max(exponent, 0.0f) + 2), 0.25f); }

bool isGlass(const tinyobj::material_t& m) { return m.illum == 4 || m.illum == 6 || m.illum == 7 || m.illum == 9; }

bool hasPbr(const tinyobj::material_t& m) {
    return m.roughness > 0 || m.metallic > 0 || !m.roughness_texname.empty() || !m.metallic_texname.empty();
}

/// .mtl offsets and scales count v upwards, ours downwards.
Texture makeTexture(std::shared_ptr<TextureImage> image, const tinyobj::texture_option_t& options) {
    Texture texture;
    texture.image = std::move(image);
    if (!texture) return {};
    texture.scale = {options.scale[0], options.scale[1]};
    texture.offset = {options.origin_offset[0], 1 - options.scale[1] - options.origin_offset[1]};
    if (options.clamp) texture.wrapU = texture.wrapV = Wrap::ClampToEdge;
    return texture;
}

void convertReflection(const tinyobj::material_t& source, Material& material) {
    const Vec3 diffuse = colour(source.diffuse), reflection = colour(source.specular);
    const float strongest = maxComponent(reflection);
    material.roughness = roughnessFromShininess(source.shininess);
    if (isBlack(diffuse) && strongest > 0.1f && source.diffuse_texname.empty() && !isGlass(source)) {
        material.metallic = 1;
        material.baseColor = reflection;
    } else {
        material.specular = strongest;
        if (strongest > 0) material.specularColor = reflection / strongest;
    }
    if (isGlass(source)) {
        material.transmission = 1;
        material.thickness = 1;
        material.baseColor = Vec3(1);
        material.specular = 1;
        material.specularColor = Vec3(1);
        material.roughness = source.shininess >= 100 ? 0 : material.roughness;
    }
    if (source.ior > 1) material.ior = std::clamp(source.ior, 1.0f, 3.0f);
}

void convertTextures(const tinyobj::material_t& source, const ObjImages& images, Material& material) {
    if (!source.alpha_texname.empty()) {
        material.baseColorTexture =
            makeTexture(images.withAlpha(source.diffuse_texname, source.alpha_texname),
                        source.diffuse_texname.empty() ? source.alpha_texopt : source.diffuse_texopt);
        material.alphaMode = AlphaMode::Mask;
    } else {
        material.baseColorTexture = makeTexture(images.plain(source.diffuse_texname, true), source.diffuse_texopt);
    }
    if (material.baseColorTexture && isBlack(material.baseColor)) material.baseColor = Vec3(1);
    material.emissionTexture = makeTexture(images.plain(source.emissive_texname, true), source.emissive_texopt);
    if (material.emissionTexture && isBlack(material.emission)) material.emission = Vec3(1);
    material.normalTexture = makeTexture(images.plain(source.normal_texname, false), source.normal_texopt);
    if (!material.normalTexture)
        material.normalTexture = makeTexture(
            images.normalsFromBump(source.bump_texname, source.bump_texopt.bump_multiplier), source.bump_texopt);
    material.metallicRoughnessTexture =
        makeTexture(images.metallicRoughness(source.metallic_texname, source.roughness_texname),
                    source.roughness_texname.empty() ? source.metallic_texopt : source.roughness_texopt);
}

Material convert(const tinyobj::material_t& source, const ObjImages& images) {
    Material material;
    material.name = source.name;
    material.baseColor = colour(source.diffuse);
    material.emission = colour(source.emission, 1e9f);
    material.alpha = std::isfinite(source.dissolve) ? std::clamp(source.dissolve, 0.0f, 1.0f) : 1;
    if (material.alpha < 1) material.alphaMode = AlphaMode::Blend;
    convertReflection(source, material);
    if (isGlass(source)) {
        material.alpha = 1;
        material.alphaMode = AlphaMode::Opaque;
    }
    if (hasPbr(source)) {
        material.baseColor = colour(source.diffuse);
        material.specular = 1;
        material.specularColor = Vec3(1);
        material.metallic = source.metallic_texname.empty() ? std::clamp(source.metallic, 0.0f, 1.0f) : 1;
        material.roughness = source.roughness_texname.empty() ? std::clamp(source.roughness, 0.0f, 1.0f) : 1;
    }
    convertTextures(source, images, material);
    return material;
}

}  // namespace

std::vector<Material> convertMaterials(const std::vector<tinyobj::material_t>& sources, ObjImages& images,
                                       std::stop_token stop) {
    for (const tinyobj::material_t& m : sources)
        for (const std::string* name : {&m.diffuse_texname, &m.alpha_texname, &m.emissive_texname, &m.normal_texname,
                                        &m.bump_texname, &m.roughness_texname, &m.metallic_texname})
            images.request(*name);
    images.load(stop);
    std::vector<Material> materials;
    for (const tinyobj::material_t& source : sources) materials.push_back(convert(source, images));
    Material fallback;
    fallback.name = "default";
    fallback.baseColor = Vec3(0.7f);
    materials.push_back(fallback);
    return materials;
}

void warnOfOtherTextures(const std::vector<tinyobj::material_t>& sources, FileWarnings& warnings) {
    using Name = std::string tinyobj::material_t::*;
    constexpr std::pair<Name, const char*> kLeftOut[] = {{&tinyobj::material_t::specular_texname, "map_Ks"},
                                                         {&tinyobj::material_t::specular_highlight_texname, "map_Ns"},
                                                         {&tinyobj::material_t::sheen_texname, "map_Ps"},
                                                         {&tinyobj::material_t::reflection_texname, "refl"},
                                                         {&tinyobj::material_t::displacement_texname, "disp"}};
    for (const auto& [name, keyword] : kLeftOut) {
        const auto isNamed = [&, member = name](const tinyobj::material_t& m) { return !(m.*member).empty(); };
        const auto first = std::find_if(sources.begin(), sources.end(), isNamed);
        if (first != sources.end())
            warnings.warn(std::string("textures of ") + keyword + " are left out, as that of \"" + first->name + '"');
    }
}

}  // namespace lumi
