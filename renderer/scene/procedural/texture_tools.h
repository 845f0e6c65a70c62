#pragma once
#include <functional>
#include <memory>

#include "math/hash.h"
#include "scene/procedural/procedural.h"

namespace lumi {

/// A generated surface at one point of its tile: all maps of a material come from the same description, so that colour,
/// relief and gloss agree.
struct SurfaceTexel {
    Vec3 colour{0.5f};  ///< linear
    float height = 0;   ///< in units of the tile's width
    float roughness = 0.5f;
    float metallic = 0;
};

/// Which image of the surface is wanted.
enum class TextureMap { Colour, Normal, MetallicRoughness };

/// u runs right and v down, both in [0, 1]; the description must repeat with period 1.
using SurfacePattern = std::function<SurfaceTexel(float u, float v)>;

/// Renders `pattern` into `size` x `size` texels (sRGB colour, tangent-space normals with +Y up, or glTF's
/// metallic-roughness layout).
TextureImage renderPattern(const char* name, int size, TextureMap map, const SurfacePattern& pattern);

/// The parameters all patterns share: which map, the number of texels, the seed.
struct PatternSettings {
    TextureMap map = TextureMap::Colour;
    int size = 1024;
    int seed = 1;
    void describe(ParameterVisitor& v);
};

/// Value noise in [-1, 1] that repeats after `periodX` by `periodY` lattice cells.
float tiledNoise(float x, float y, int periodX, int periodY, uint32_t seed);

/// Sum of `octaves` of tiledNoise, each of half the size and half the weight, about [-1, 1].
float tiledFractal(float x, float y, int periodX, int periodY, int octaves, uint32_t seed);

/// A random number in [0, 1) for an integer place.
inline float randomAt(int x, int y, uint32_t seed) {
    const uint32_t place =
        static_cast<uint32_t>(x) * 0x9e3779b1u ^ pcgHash(static_cast<uint32_t>(y) + seed * 0x85ebca77u);
    return unitFloat(pcgHash(place));
}

inline float fract(float x) { return x - std::floor(x); }

/// A colour parameter of a pattern.
void describeColour(ParameterVisitor& v, const char* id, Vec3& value, const char* label, const char* help);

/// A pure number of a pattern.
void describeAmount(ParameterVisitor& v, const char* id, float& value, const char* label, double min, double max,
                    const char* help);

std::unique_ptr<ProceduralTexture> makeWood();      ///< texture_wood.cpp
std::unique_ptr<ProceduralTexture> makeTiles();     ///< texture_stone.cpp: floor tiles with veins
std::unique_ptr<ProceduralTexture> makeMasonry();   ///< texture_stone.cpp: courses of dressed stone or brick
std::unique_ptr<ProceduralTexture> makePlaster();   ///< texture_stone.cpp
std::unique_ptr<ProceduralTexture> makeWeave();     ///< texture_cloth.cpp
std::unique_ptr<ProceduralTexture> makeCarpet();    ///< texture_cloth.cpp: a knotted rug, drawn once over 0 to 1
std::unique_ptr<ProceduralTexture> makePainting();  ///< texture_painting.cpp
std::unique_ptr<ProceduralTexture> makePrint();  ///< texture_print.cpp: fine print and line art, drawn once over 0 to 1

}  // namespace lumi
