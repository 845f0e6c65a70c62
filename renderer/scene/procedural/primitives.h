#pragma once
#include <memory>

#include "scene/procedural/procedural.h"

namespace lumi {

/// Basic shapes, centred on the origin unless said otherwise; see each describe() for their parameters.
std::unique_ptr<Procedural> makeSphere();
std::unique_ptr<Procedural> makeRectangle();
std::unique_ptr<Procedural> makeBox();
std::unique_ptr<Procedural> makeCylinder();
std::unique_ptr<Procedural> makeCone();
std::unique_ptr<Procedural> makeDisk();
std::unique_ptr<Procedural> makeTorus();
std::unique_ptr<Procedural> makePlaneGrid();
std::unique_ptr<Procedural> makeHairball();

std::unique_ptr<ProceduralTexture> makeChecker();

/// Direct access to shapes that other generators and light bodies are built from. All in metres.
Mesh sphereMesh(float radius, int segments, int rings);
/// The surface swept between two radii from y = -height/2 to +height/2; caps close it where the radius is not zero.
Mesh frustumMesh(float bottomRadius, float topRadius, float height, int segments, bool caps);
/// A box with rounded edges; `bevelSegments` strips an edge, `bevel` at most half the smallest side, 0 is sharp.
Mesh boxMesh(const Vec3& size, float bevel = 0, int bevelSegments = 3, bool uvInMetres = false);
Mesh torusMesh(float radius, float tubeRadius, int segments, int tubeSegments);

/// The way a flat shape faces: the basis that carries its own right, up and normal into the asset's space.
enum class Facing { X, MinusX, Y, MinusY, Z, MinusZ };
Mat3 facingBasis(Facing facing);
Mesh rectangleMesh(float width, float height, Facing facing, int columns = 1, int rows = 1, bool uvInMetres = false);
Mesh diskMesh(float radius, float innerRadius, Facing facing, int segments);

}  // namespace lumi
