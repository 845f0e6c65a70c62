#include "scene/procedural/procedural.h"

#include <array>
#include <utility>

#include "scene/procedural/generators.h"
#include "scene/procedural/primitives.h"
#include "scene/procedural/texture_tools.h"

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
    ProceduralEntry{"room-shell", "A room with a window opening, skirting boards and a cornice.", makeRoomShell},
    ProceduralEntry{"window", "A window frame with mullions and a sill.", makeWindow},
    ProceduralEntry{"sofa", "An upholstered seat with loose cushions.", makeSofa},
    ProceduralEntry{"pillow", "A loose square pillow on its edge.", makePillow},
    ProceduralEntry{"table", "A table of boards on slanted legs.", makeTable},
    ProceduralEntry{"chair", "A school chair of bent boards on tubes.", makeChair},
    ProceduralEntry{"bookshelf", "A case of shelves full of books.", makeBookshelf},
    ProceduralEntry{"book-stack", "Books lying on each other.", makeBookStack},
    ProceduralEntry{"rug", "A rug with a fringe; uv from 0 to 1.", makeRug},
    ProceduralEntry{"picture-frame", "A framed picture against z = 0; its uv from 0 to 1.", makePictureFrame},
    ProceduralEntry{"lamp", "A standing lamp with a cloth shade.", makeFloorLamp},
    ProceduralEntry{"plant", "A potted plant with arching leaves.", makePlant},
    ProceduralEntry{"tree", "A broad-leaved tree with thin leaves on its twigs.", makeTree},
    ProceduralEntry{"vessel", "Turned ware: vases, bowls, urns, plates, candlesticks.", makeVessel},
    ProceduralEntry{"drape", "Cloth that hangs in folds from a rod along X.", makeDrape},
    ProceduralEntry{"tablecloth", "A cloth on a table top that falls over its front edge.", makeTablecloth},
    ProceduralEntry{"hall", "A court with vaulted galleries on floors of arches.", makeHall},
    ProceduralEntry{"drinking-glass", "A glass with a filling, closed solids.", makeDrinkingGlass},
    ProceduralEntry{"wine-bottle", "A bottle with wine, cork and label.", makeBottle},
    ProceduralEntry{"fruit", "An apple, a pear, a lemon or an orange.", makeFruit},
    ProceduralEntry{"grapes", "A bunch of grapes, its berries instanced.", makeGrapes},
    ProceduralEntry{"creature", "A long-necked walker: skinned, with a looping gait.", makeCreature},
    ProceduralEntry{"ogre", "A stout round figure with tusks and horns: skinned, breathing, looking about.", makeOgre},
    ProceduralEntry{"blob", "A ball that morphs between lobed forms.", makeBlob},
    ProceduralEntry{"gear", "A toothed wheel about Z.", makeGear},
    ProceduralEntry{"spinning-top", "A turned top in painted bands, on its tip.", makeSpinningTop},
};

constexpr std::array kTextures{
    ProceduralTextureEntry{"checker", "Squares of two colours.", makeChecker},
    ProceduralTextureEntry{"wood", "Boards with grain and joints.", makeWood},
    ProceduralTextureEntry{"tiles", "Stone floor tiles with veins and grout.", makeTiles},
    ProceduralTextureEntry{"masonry", "Courses of dressed stone or brick.", makeMasonry},
    ProceduralTextureEntry{"plaster", "Plaster with soft clouds of tone.", makePlaster},
    ProceduralTextureEntry{"weave", "Woven cloth.", makeWeave},
    ProceduralTextureEntry{"carpet", "A knotted rug, drawn once over 0 to 1.", makeCarpet},
    ProceduralTextureEntry{"painting", "A picture for a frame or a label, drawn once over 0 to 1.", makePainting},
    ProceduralTextureEntry{"print", "A sheet of fine print and line art, drawn once over 0 to 1.", makePrint},
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
