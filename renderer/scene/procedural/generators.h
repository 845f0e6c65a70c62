#pragma once
#include <memory>
#include <utility>

#include "scene/procedural/mesh_tools.h"
#include "scene/procedural/procedural.h"

namespace lumi {

/// The furnished generators, one .cpp each, listed in procedural.cpp. Each stands on y = 0 about the origin and faces
/// +Z unless its help says otherwise.

std::unique_ptr<Procedural> makeRoomShell();     ///< room_shell.cpp: floor, walls with a window opening, mouldings
std::unique_ptr<Procedural> makeWindow();        ///< window.cpp: frame, mullions, sill
std::unique_ptr<Procedural> makeSofa();          ///< sofa.cpp
std::unique_ptr<Procedural> makePillow();        ///< sofa.cpp
std::unique_ptr<Procedural> makeTable();         ///< table.cpp
std::unique_ptr<Procedural> makeChair();         ///< chair.cpp
std::unique_ptr<Procedural> makeBookshelf();     ///< bookshelf.cpp
std::unique_ptr<Procedural> makeBookStack();     ///< bookshelf.cpp
std::unique_ptr<Procedural> makeRug();           ///< rug.cpp
std::unique_ptr<Procedural> makePictureFrame();  ///< picture_frame.cpp
std::unique_ptr<Procedural> makeFloorLamp();     ///< lamp.cpp
std::unique_ptr<Procedural> makePlant();         ///< plant.cpp
std::unique_ptr<Procedural> makeTree();          ///< tree.cpp
std::unique_ptr<Procedural> makeVessel();        ///< vessel.cpp: vases, bowls, urns, candlesticks
std::unique_ptr<Procedural> makeDrape();         ///< drape.cpp: hanging cloth
std::unique_ptr<Procedural> makeTablecloth();    ///< tablecloth.cpp: cloth over a table's edge

std::unique_ptr<Procedural> makeHall();           ///< hall.cpp and its pieces
std::unique_ptr<Procedural> makeDrinkingGlass();  ///< glassware.cpp
std::unique_ptr<Procedural> makeBottle();         ///< glassware.cpp
std::unique_ptr<Procedural> makeFruit();          ///< fruit.cpp
std::unique_ptr<Procedural> makeGrapes();         ///< fruit.cpp

std::unique_ptr<Procedural> makeCreature();     ///< creature.cpp: a skinned walker
std::unique_ptr<Procedural> makeOgre();         ///< ogre.cpp: a skinned, breathing, round figure
std::unique_ptr<Procedural> makeBlob();         ///< blob.cpp: a morphing body
std::unique_ptr<Procedural> makeGear();         ///< toys.cpp
std::unique_ptr<Procedural> makeSpinningTop();  ///< toys.cpp

/// A slot whose fallback is a plain opaque material.
MaterialSlot opaqueSlot(const char* name, const Vec3& baseColor, float roughness, float metallic = 0);

/// A slot of clear solid glass.
MaterialSlot glassSlot(const char* name, const Vec3& attenuationColor = Vec3(1), float attenuationDistance = 1,
                       float ior = 1.5f);

/// A result whose only part is `mesh`, its slots already set.
ProceduralResult onePart(Mesh mesh, std::vector<MaterialSlot> slots);

/// Another mesh of a result.
void addPart(ProceduralResult& result, const char* name, Mesh mesh);

/// The seed parameter that most generators share.
void describeSeed(ParameterVisitor& v, int& seed);

/// A length in metres as a generator's parameter.
void describeLength(ParameterVisitor& v, const char* id, float& value, const char* label, double min, double max,
                    const char* help);

/// A whole number as a generator's parameter.
void describeCount(ParameterVisitor& v, const char* id, int& value, const char* label, int min, int max,
                   const char* help);

}  // namespace lumi
