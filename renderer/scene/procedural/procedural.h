#pragma once
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "params/parameter.h"
#include "scene/scene.h"

namespace lumi {

/// A material that a generated asset asks for by name: "surface", "columns", "drapes". The scene file fills slots by
/// `"material": "chrome"` (all of them) or `"materials": {"columns": "stone"}`; an unfilled slot has its fallback.
struct MaterialSlot {
    std::string name;
    Material fallback;
};

/// A mesh placed in the asset. Several parts may share one mesh: they become Embree instances of it.
/// `mesh->material` and `mesh->triangleMaterial` index ProceduralResult::slots.
struct ProceduralPart {
    std::string name;  ///< the instance is named "<instance>/<name>", or just "<instance>" when empty
    std::shared_ptr<const Mesh> mesh;
    int node = -1;  ///< index into ProceduralResult::nodes; -1 is the asset's own origin
    int skin = -1;  ///< index into ProceduralResult::skins
    int slot = -1;  ///< replaces the mesh's own slots when >= 0, so that parts sharing a mesh may differ
};

/// What a generator makes, in the asset's own space (+Y up, metres). Nodes stand parents first, parent -1 is the
/// asset's origin. Joints and animation channels name nodes of this list.
struct ProceduralResult {
    std::vector<MaterialSlot> slots;  ///< at least one
    std::vector<ProceduralPart> parts;
    std::vector<Node> nodes;
    std::vector<Skin> skins;
    std::vector<Animation> animations;
};

/// A generated asset: `"ball": {"sphere": {"radius": 0.5}}`. Its parameters are declared once, in describe(), and the
/// scene file, its schema and its messages follow. A generator that declares `width` and `height` (and `depth`) also
/// takes `"size": [width, height, depth]`.
class Procedural {
public:
    virtual ~Procedural() = default;
    virtual void describe(ParameterVisitor&) = 0;
    /// The same parameters give the same bytes, whatever the thread count. Meshes are well formed: normals unit and
    /// outward, counter-clockwise fronts, uv set 0 present. Throws Error(Usage) for parameters that do not go together.
    virtual ProceduralResult build() const = 0;
};

/// A generated texture: `"base-color-texture": {"checker": {"squares": 8}}`.
class ProceduralTexture {
public:
    virtual ~ProceduralTexture() = default;
    virtual void describe(ParameterVisitor&) = 0;
    /// Level 0 only, tileable in both directions. `srgb` of the image says how its bytes are encoded.
    virtual TextureImage build() const = 0;
};

struct ProceduralEntry {
    const char* name;  ///< kebab-case, the key in the scene file
    const char* help;  ///< one sentence
    std::unique_ptr<Procedural> (*make)();
};
struct ProceduralTextureEntry {
    const char* name;
    const char* help;
    std::unique_ptr<ProceduralTexture> (*make)();
};

/// Every generator: the one place where they are listed.
std::span<const ProceduralEntry> proceduralCatalog();
std::span<const ProceduralTextureEntry> proceduralTextureCatalog();

/// A fresh generator with default parameters, or null for an unknown name.
std::unique_ptr<Procedural> makeProcedural(const std::string& name);
std::unique_ptr<ProceduralTexture> makeProceduralTexture(const std::string& name);

/// A result of one part with one slot, "surface".
ProceduralResult singleMesh(Mesh mesh);

}  // namespace lumi
