#include "scene/gltf/meshes.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <tuple>

#include "base/error.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "scene/deform.h"
#include "scene/gltf/choices.h"
#include "scene/gltf/counts.h"
#include "scene/gltf/primitive.h"
#include "scene/gltf/values.h"
#include "scene/material_textures.h"
#include "scene/mesh_edit.h"

namespace lumi::gltf {
namespace {

/// Position of the variant that is asked for among the file's variants, or -1 for none.
int variantIndex(const Document& document) {
    const std::string& wanted = document.options().choice.variant;
    if (wanted.empty()) return -1;
    std::vector<std::string> names;
    if (const auto* root = extensionOf(document.model().extensions, "KHR_materials_variants"))
        if (root->Has("variants") && root->Get("variants").IsArray())
            for (size_t i = 0; i < root->Get("variants").ArrayLen(); ++i)
                names.push_back(textOf(root->Get("variants").Get(static_cast<int>(i)), "name"));
    for (size_t i = 0; i < names.size(); ++i)
        if (names[i] == wanted) return static_cast<int>(i);
    throwUsage({.what = "no such material variant",
                .where = document.path().filename().string(),
                .expected = names.empty() ? "none: the file has no variants" : listedNames(names),
                .found = wanted});
}

/// Material of a primitive under the chosen variant.
int materialIndex(const tinygltf::Primitive& primitive, int variant) {
    const auto* extension = extensionOf(primitive.extensions, "KHR_materials_variants");
    if (variant < 0 || !extension || !extension->Has("mappings") || !extension->Get("mappings").IsArray())
        return primitive.material;
    const tinygltf::Value& mappings = extension->Get("mappings");
    for (int m = 0; m < static_cast<int>(mappings.ArrayLen()); ++m) {
        const tinygltf::Value& mapping = mappings.Get(m);
        if (!mapping.IsObject() || !mapping.Has("variants") || !mapping.Get("variants").IsArray()) continue;
        const tinygltf::Value& variants = mapping.Get("variants");
        for (int v = 0; v < static_cast<int>(variants.ArrayLen()); ++v)
            if (variants.Get(v).IsInt() && variants.Get(v).GetNumberAsInt() == variant)
                return integerOf(mapping, "material", primitive.material);
    }
    return primitive.material;
}

/// The set of texture coordinates whose directions a material's surfaces need: of its normal map, else its clearcoat's,
/// else of its anisotropy. -1: none.
int tangentSet(const Material& material) {
    if (material.normalTexture) return material.normalTexture.uvSet;
    if (material.clearcoatNormalTexture) return material.clearcoatNormalTexture.uvSet;
    return material.anisotropy > 0 ? material.anisotropyTexture.uvSet : -1;
}

class MeshReader {
public:
    MeshReader(const Document& document, const MaterialSet& set, int variant, size_t index)
        : document_(document),
          materials_(set.materials),
          uvSets_(set.uvSets),
          variant_(variant),
          source_(document.model().meshes[index]),
          path_("/meshes/" + std::to_string(index)) {
        if (source_.name.empty()) source_.name = "mesh " + std::to_string(index);
    }

    std::shared_ptr<const Mesh> read() {
        for (size_t p = 0; p < source_.primitives.size(); ++p) addPrimitive(p);
        std::erase_if(parts_, [](const Mesh& part) { return part.triangles.empty(); });
        if (parts_.empty()) return nullptr;
        finish();
        uint64_t merged = 0;
        for (size_t p = 1; p < parts_.size(); ++p) merged += parts_[p].byteCount();
        if (merged > 0) checkMemory("joining the primitives of " + path_, merged);
        auto mesh = std::make_shared<Mesh>(mergeMeshes(std::move(parts_)));
        mesh->name = source_.name;
        checkMesh(*mesh, document_.path().filename().string() + ": " + path_);
        return mesh;
    }

private:
    /// Whose vertices a part holds: equal where primitives have the same attributes and targets.
    struct Source {
        const tinygltf::Primitive* primitive;
        UvSets uvSets;
        bool operator<(const Source& other) const {
            return std::tie(primitive->attributes, primitive->targets, uvSets) <
                   std::tie(other.primitive->attributes, other.primitive->targets, other.uvSets);
        }
    };
    struct Shared {
        size_t index;  ///< into parts_
        int tangents;  ///< the set that generated tangents follow; -1: none needed
    };

    /// Primitives over the same vertices share them.
    void addPrimitive(size_t p) {
        document_.pollStop();
        const tinygltf::Primitive& primitive = source_.primitives[p];
        const std::string path = path_ + "/primitives/" + std::to_string(p);
        checkVariants(primitive, path);
        int material = materialIndex(primitive, variant_);
        if (material < 0) material = static_cast<int>(materials_.size()) - 1;
        else document_.checkIndex(material, materials_.size() - 1, path + "/material", "materials");
        const UvSets& uvSets = uvSets_[static_cast<size_t>(material)];

        const std::unique_ptr<const DracoMesh> draco = decodeDraco(document_, primitive, path);
        const bool hasTangents = primitive.attributes.contains("NORMAL") && primitive.attributes.contains("TANGENT");
        const int tangents = hasTangents ? -1 : tangentSet(materials_[static_cast<size_t>(material)]);
        size_t part = draco ? parts_.size() : partOver({&primitive, uvSets}, tangents);
        if (part == parts_.size()) parts_.push_back(readVertices(document_, primitive, draco.get(), uvSets, path));
        if (parts_[part].positions.empty()) return;
        const std::vector<UVec3> triangles =
            readTriangles(document_, primitive, draco.get(), parts_[part].positions.size(), path);
        Mesh& mesh = parts_[part];
        const size_t needed = mesh.triangles.size() + triangles.size();
        if (needed > mesh.triangles.capacity())
            checkMemory("the geometry of " + path, std::max(needed, 2 * mesh.triangles.size()) * kTriangleBytes);
        mesh.triangles.insert(mesh.triangles.end(), triangles.begin(), triangles.end());
        mesh.triangleMaterial.resize(mesh.triangles.size(), static_cast<uint32_t>(material));
        warnOfMissingUv(mesh, materials_[static_cast<size_t>(material)], uvSets, path);
    }

    void warnOfMissingUv(const Mesh& mesh, const Material& material, const UvSets& uvSets,
                         const std::string& path) const {
        for (const int set : {0, 1}) {
            const auto liesOverIt = [&](const auto texture) {
                return (material.*texture) && (material.*texture).uvSet == set;
            };
            if (mesh.uv[set].empty() &&
                std::any_of(std::begin(kMaterialTextures), std::end(kMaterialTextures), liesOverIt))
                document_.warn(path + ": textures of the material \"" + material.name + "\" lie over TEXCOORD_" +
                               std::to_string(uvSets[static_cast<size_t>(set)]) +
                               ", which is missing; they show one texel each");
        }
    }

    /// The part that holds these vertices, if its tangents may follow the set `tangents` too (-1: it needs none); else
    /// the next new one.
    size_t partOver(const Source& source, int tangents) {
        std::vector<Shared>& known = sharedParts_[source];
        for (Shared& part : known)
            if (part.tangents == tangents || part.tangents < 0 || tangents < 0) {
                part.tangents = std::max(part.tangents, tangents);
                return part.index;
            }
        known.push_back({parts_.size(), tangents});
        return parts_.size();
    }

    /// Also of the variants that are not chosen: a file is wrong or right whatever is asked of it.
    void checkVariants(const tinygltf::Primitive& primitive, const std::string& path) const {
        const auto* extension = extensionOf(primitive.extensions, "KHR_materials_variants");
        if (!extension || !extension->Has("mappings") || !extension->Get("mappings").IsArray()) return;
        const tinygltf::Value& mappings = extension->Get("mappings");
        for (int m = 0; m < static_cast<int>(mappings.ArrayLen()); ++m)
            document_.checkIndex(
                integerOf(mappings.Get(m), "material", -1), materials_.size() - 1,
                path + "/extensions/KHR_materials_variants/mappings/" + std::to_string(m) + "/material", "materials");
    }

    /// Normals and tangents: what one part has, all have, since they become one mesh.
    void finish() {
        bool anyNormals = false, anyTangents = false;
        for (Mesh& part : parts_) {
            compactVertices(part);
            const int set = tangentSetOf(part);
            anyTangents |= !part.tangents.empty() || (set >= 0 && !part.uv[set].empty());
            anyNormals |= !part.normals.empty();
        }
        for (Mesh& part : parts_) {
            // glTF: without normals, faces are flat, and stay so when they bend.
            if (part.normals.empty() && (anyNormals || anyTangents)) {
                makeFlat(part);
                if (!part.morphTargets.empty()) part.morphTargets[0].normals.assign(part.positions.size(), kFaceNormal);
            }
            if (anyTangents && part.tangents.empty()) computeTangents(part, std::max(tangentSetOf(part), 0));
        }
    }

    /// Of the part's materials, which agree.
    int tangentSetOf(const Mesh& part) const {
        int set = -1;
        for (size_t i = 0; i < part.triangleMaterial.size() && set < 0; ++i)
            if (i == 0 || part.triangleMaterial[i] != part.triangleMaterial[i - 1])
                set = tangentSet(materials_[part.triangleMaterial[i]]);
        return set;
    }

    const Document& document_;
    const std::vector<Material>& materials_;
    const std::vector<UvSets>& uvSets_;
    int variant_;
    tinygltf::Mesh source_;
    std::string path_;
    std::map<Source, std::vector<Shared>> sharedParts_;
    std::vector<Mesh> parts_;
};

}  // namespace

std::vector<std::shared_ptr<const Mesh>> loadMeshes(const Document& document, const std::vector<bool>& used,
                                                    const MaterialSet& materials) {
    const int variant = variantIndex(document);
    std::vector<std::shared_ptr<const Mesh>> meshes(document.model().meshes.size());
    parallelFor(static_cast<int64_t>(meshes.size()), [&](int64_t i) {
        const size_t index = static_cast<size_t>(i);
        document.pollStop();
        if (used[index]) meshes[index] = MeshReader(document, materials, variant, index).read();
    });
    return meshes;
}

}  // namespace lumi::gltf
