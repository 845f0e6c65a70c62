#include "scene/gltf/materials.h"

#include <algorithm>
#include <iterator>
#include <set>

#include "scene/gltf/values.h"
#include "scene/material_textures.h"

namespace lumi::gltf {
namespace {

Vec3 clampedColour(const Vec3& colour, float most = 1) { return glm::clamp(colour, Vec3(0), Vec3(most)); }
float unit(double value, float otherwise) {
    return std::isfinite(value) ? std::clamp(static_cast<float>(value), 0.0f, 1.0f) : otherwise;
}

/// Reads one material: the core, then each extension over it.
class MaterialReader {
public:
    MaterialReader(const Document& document, TextureLibrary& library, const tinygltf::Material& source, size_t index)
        : document_(document), library_(library), source_(source), path_("/materials/" + std::to_string(index)) {
        material_.name = source.name.empty() ? "material " + std::to_string(index) : source.name;
    }

    Material read() {
        readCore();
        if (const auto* extension = find("KHR_materials_pbrSpecularGlossiness")) readSpecularGlossiness(*extension);
        if (const auto* extension = find("KHR_materials_ior")) readIor(*extension);
        if (const auto* extension = find("KHR_materials_specular")) readSpecular(*extension);
        if (const auto* extension = find("KHR_materials_transmission")) readTransmission(*extension);
        if (const auto* extension = find("KHR_materials_volume")) readVolume(*extension);
        if (const auto* extension = find("KHR_materials_clearcoat")) readClearcoat(*extension);
        if (const auto* extension = find("KHR_materials_sheen")) readSheen(*extension);
        if (const auto* extension = find("KHR_materials_anisotropy")) readAnisotropy(*extension);
        if (const auto* extension = find("KHR_materials_iridescence")) readIridescence(*extension);
        if (const auto* extension = find("KHR_materials_emissive_strength"))
            material_.emission *= std::max(0.0f, numberOf(*extension, "emissiveStrength", 1));
        limitEmission();
        if (find("KHR_materials_unlit")) makeUnlit();
        return std::move(material_);
    }

private:
    const tinygltf::Value* find(const char* name) const { return extensionOf(source_.extensions, name); }

    template <class Info>
    Texture core(const Info& info, const char* key, TextureUse use) {
        return library_.texture(info.index, info.texCoord, info.extensions, use, path_ + "/" + key);
    }
    /// A textureInfo inside an extension.
    Texture inner(const tinygltf::Value& extension, const std::string& key, TextureUse use) {
        if (!extension.Has(key) || !extension.Get(key).IsObject()) return {};
        const tinygltf::Value& info = extension.Get(key);
        tinygltf::ExtensionMap extensions;
        if (info.Has("extensions") && info.Get("extensions").IsObject())
            for (const std::string& name : info.Get("extensions").Keys())
                extensions[name] = info.Get("extensions").Get(name);
        return library_.texture(integerOf(info, "index", -1), integerOf(info, "texCoord", 0), extensions, use,
                                path_ + "/extensions/.../" + key);
    }

    void readCore() {
        const tinygltf::PbrMetallicRoughness& pbr = source_.pbrMetallicRoughness;
        const std::vector<double>& base = pbr.baseColorFactor;
        material_.baseColor = clampedColour(vec3From({base[0], base[1], base[2]}, Vec3(1)));
        material_.alpha = unit(base[3], 1);
        material_.baseColorTexture =
            core(pbr.baseColorTexture, "pbrMetallicRoughness/baseColorTexture", TextureUse::Colour);
        material_.metallic = unit(pbr.metallicFactor, 1);
        material_.roughness = unit(pbr.roughnessFactor, 1);
        material_.metallicRoughnessTexture =
            core(pbr.metallicRoughnessTexture, "pbrMetallicRoughness/metallicRoughnessTexture", TextureUse::Data);
        material_.normalTexture = core(source_.normalTexture, "normalTexture", TextureUse::Normal);
        material_.normalScale = std::clamp(static_cast<float>(source_.normalTexture.scale), -16.0f, 16.0f);
        material_.emission = glm::max(vec3From(source_.emissiveFactor, Vec3(0)), Vec3(0));
        material_.emissionTexture = core(source_.emissiveTexture, "emissiveTexture", TextureUse::Colour);
        material_.doubleSided = source_.doubleSided;
        material_.alphaMode = alphaMode();
        material_.alphaCutoff = std::max(0.0f, static_cast<float>(source_.alphaCutoff));
    }

    AlphaMode alphaMode() const {
        if (source_.alphaMode == "MASK") return AlphaMode::Mask;
        if (source_.alphaMode == "BLEND") return AlphaMode::Blend;
        if (source_.alphaMode != "OPAQUE")
            document_.fail(path_ + "/alphaMode", "no such mode", "OPAQUE, MASK or BLEND",
                           '"' + source_.alphaMode.substr(0, 40) + '"');
        return AlphaMode::Opaque;
    }

    void readIor(const tinygltf::Value& extension) {
        // 0 is the extension's spelling of "reflects everything": an index beyond all real ones.
        const float ior = numberOf(extension, "ior", 1.5f);
        material_.ior = ior == 0 ? 1e4f : std::max(ior, 1.0f);
    }

    void readSpecular(const tinygltf::Value& extension) {
        material_.specular = unit(numberOf(extension, "specularFactor", 1), 1);
        material_.specularTexture = inner(extension, "specularTexture", TextureUse::Data);
        material_.specularColor = clampedColour(vec3Of(extension, "specularColorFactor", Vec3(1)), 1e4f);
        material_.specularColorTexture = inner(extension, "specularColorTexture", TextureUse::Colour);
    }

    void readTransmission(const tinygltf::Value& extension) {
        material_.transmission = unit(numberOf(extension, "transmissionFactor", 0), 0);
        material_.transmissionTexture = inner(extension, "transmissionTexture", TextureUse::Data);
    }

    void readVolume(const tinygltf::Value& extension) {
        material_.thickness = std::max(0.0f, numberOf(extension, "thicknessFactor", 0));
        material_.attenuationColor = clampedColour(vec3Of(extension, "attenuationColor", Vec3(1)));
        const float distance = numberOf(extension, "attenuationDistance", kInfinity);
        material_.attenuationDistance = distance > 0 ? distance : kInfinity;
    }

    void readClearcoat(const tinygltf::Value& extension) {
        material_.clearcoat = unit(numberOf(extension, "clearcoatFactor", 0), 0);
        material_.clearcoatTexture = inner(extension, "clearcoatTexture", TextureUse::Data);
        material_.clearcoatRoughness = unit(numberOf(extension, "clearcoatRoughnessFactor", 0), 0);
        material_.clearcoatRoughnessTexture = inner(extension, "clearcoatRoughnessTexture", TextureUse::Data);
        material_.clearcoatNormalTexture = inner(extension, "clearcoatNormalTexture", TextureUse::Normal);
        if (material_.clearcoatNormalTexture)
            material_.clearcoatNormalScale =
                std::clamp(numberOf(extension.Get("clearcoatNormalTexture"), "scale", 1), -16.0f, 16.0f);
    }

    void readSheen(const tinygltf::Value& extension) {
        material_.sheenColor = clampedColour(vec3Of(extension, "sheenColorFactor", Vec3(0)));
        material_.sheenColorTexture = inner(extension, "sheenColorTexture", TextureUse::Colour);
        material_.sheenRoughness = unit(numberOf(extension, "sheenRoughnessFactor", 0), 0);
        material_.sheenRoughnessTexture = inner(extension, "sheenRoughnessTexture", TextureUse::Data);
    }

    void readAnisotropy(const tinygltf::Value& extension) {
        material_.anisotropy = unit(numberOf(extension, "anisotropyStrength", 0), 0);
        const float rotation = numberOf(extension, "anisotropyRotation", 0);
        material_.anisotropyRotation = std::isfinite(rotation) ? std::remainder(rotation, 2 * kPi) : 0;
        material_.anisotropyTexture = inner(extension, "anisotropyTexture", TextureUse::Data);
    }

    void readIridescence(const tinygltf::Value& extension) {
        material_.iridescence = unit(numberOf(extension, "iridescenceFactor", 0), 0);
        material_.iridescenceTexture = inner(extension, "iridescenceTexture", TextureUse::Data);
        material_.iridescenceIor = std::clamp(numberOf(extension, "iridescenceIor", 1.3f), 1.0f, 10.0f);
        constexpr float kMost = 1e5f;
        material_.iridescenceThicknessMin =
            std::clamp(numberOf(extension, "iridescenceThicknessMinimum", 100), 0.0f, kMost);
        material_.iridescenceThicknessMax =
            std::clamp(numberOf(extension, "iridescenceThicknessMaximum", 400), 0.0f, kMost);
        material_.iridescenceThicknessTexture = inner(extension, "iridescenceThicknessTexture", TextureUse::Data);
    }

    /// The older specular-glossiness model as a dielectric with a coloured reflection at normal incidence.
    void readSpecularGlossiness(const tinygltf::Value& extension) {
        constexpr float kDielectricF0 = 0.04f;
        const Vec4 diffuse = vec4Of(extension, "diffuseFactor", Vec4(1));
        const float gloss = unit(numberOf(extension, "glossinessFactor", 1), 1);
        material_.baseColor = clampedColour(Vec3(diffuse));
        material_.alpha = unit(diffuse.w, 1);
        material_.baseColorTexture = inner(extension, "diffuseTexture", TextureUse::Colour);
        material_.metallic = 0;
        material_.specularColor = clampedColour(vec3Of(extension, "specularFactor", Vec3(1))) / kDielectricF0;
        material_.specularColorTexture = inner(extension, "specularGlossinessTexture", TextureUse::Colour);
        material_.roughness = 1 - gloss;
        material_.metallicRoughnessTexture = {};
        if (material_.specularColorTexture) {
            material_.roughness = 1;
            material_.metallicRoughnessTexture = library_.roughnessFromGloss(material_.specularColorTexture, gloss);
        }
    }

    /// Beyond, sums over paths overflow.
    void limitEmission() {
        constexpr float kMost = 1e9f;
        if (maxComponent(material_.emission) <= kMost) return;
        document_.warn(path_ + " emits beyond any light; it is taken down to 1e9 W/(m^2 sr)");
        material_.emission = clampedColour(material_.emission, kMost);
    }

    /// Unlit surfaces show their colour whatever the light: they emit it and scatter nothing.
    void makeUnlit() {
        material_.unlit = true;
        material_.emission = material_.baseColor;
        material_.emissionTexture = material_.baseColorTexture;
        material_.baseColor = Vec3(0);
        material_.metallic = 0;
        material_.specular = 0;
        material_.transmission = 0;
        material_.clearcoat = material_.anisotropy = material_.iridescence = 0;
        material_.sheenColor = Vec3(0);
    }

    const Document& document_;
    TextureLibrary& library_;
    const tinygltf::Material& source_;
    std::string path_;
    Material material_;
};

/// The two of the file's texture coordinate sets that a material's meshes carry; its textures then count among those.
UvSets chooseUvSets(const Document& document, Material& material) {
    std::set<int> used;
    for (const auto texture : kMaterialTextures)
        if (material.*texture) used.insert((material.*texture).uvSet);
    UvSets chosen{0, 1};
    if (used.empty() || *used.rbegin() <= 1) return chosen;
    chosen[0] = *used.begin();
    chosen[1] = used.size() > 1 ? *std::next(used.begin()) : chosen[0];
    if (used.size() > 2)
        document.warn("the material \"" + material.name + "\" uses more than two sets of texture coordinates; " +
                      "TEXCOORD_" + std::to_string(chosen[0]) + " stands in for the others");
    for (const auto texture : kMaterialTextures)
        if (int& set = (material.*texture).uvSet; material.*texture) set = set == chosen[1] && chosen[1] != chosen[0];
    return chosen;
}

}  // namespace

MaterialSet loadMaterials(const Document& document, TextureLibrary& library) {
    const std::vector<tinygltf::Material>& sources = document.model().materials;
    MaterialSet set;
    set.materials.reserve(sources.size() + 1);
    for (size_t i = 0; i < sources.size(); ++i)
        set.materials.push_back(MaterialReader(document, library, sources[i], i).read());
    Material fallback;
    fallback.name = "default";
    fallback.metallic = 1;
    fallback.roughness = 1;
    set.materials.push_back(fallback);
    for (Material& material : set.materials) set.uvSets.push_back(chooseUvSets(document, material));
    return set;
}

}  // namespace lumi::gltf
