#include "scene/procedural/procedural.h"

#include <array>
#include <utility>

#include "scene/procedural/primitives.h"

namespace lumi {
namespace {

constexpr std::array kProcedurals{
    ProceduralEntry{"sphere", "A sphere of longitude and latitude facets with smooth normals.", makeSphere},
    ProceduralEntry{"rectangle", "A flat rectangle; by default a floor.", makeRectangle},
    ProceduralEntry{"box", "A box, its edges sharp or rounded.", makeBox},
    ProceduralEntry{"cylinder", "A cylinder along Y.", makeCylinder},
    ProceduralEntry{"cone", "A cone or frustum along Y.", makeCone},
    ProceduralEntry{"disk", "A flat disk or ring; by default a floor.", makeDisk},
    ProceduralEntry{"torus", "A ring about Y.", makeTorus},
    ProceduralEntry{"plane-grid", "A flat rectangle of many quads.", makePlaneGrid},
    ProceduralEntry{"hairball", "Thin curled strands that grow from a centre.", makeHairball},
};

constexpr std::array kTextures{
    ProceduralTextureEntry{"checker", "Squares of two colours.", makeChecker},
};

}  // namespace

std::span<const ProceduralEntry> proceduralCatalog() { return kProcedurals; }
std::span<const ProceduralTextureEntry> proceduralTextureCatalog() { return kTextures; }

std::unique_ptr<Procedural> makeProcedural(const std::string& name) {
    for (const ProceduralEntry& entry : kProcedurals)
        if (name == entry.name) return entry.make();
    return nullptr;
}

std::unique_ptr<ProceduralTexture> makeProceduralTexture(const std::string& name) {
    for (const ProceduralTextureEntry& entry : kTextures)
        if (name == entry.name) return entry.make();
    return nullptr;
}

ProceduralResult singleMesh(Mesh mesh) {
    Material surface;
    surface.name = "surface";
    surface.baseColor = Vec3(0.8f);
    ProceduralResult result;
    result.slots.push_back({"surface", surface});
    result.parts.push_back({"", std::make_shared<const Mesh>(std::move(mesh)), -1, -1, -1});
    return result;
}

}  // namespace lumi
