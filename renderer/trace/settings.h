#pragma once
#include "params/parameter.h"

namespace lumi {

enum class SamplerKind { Sobol, Halton, Independent };
enum class DirectStrategy { Mis, Light, Bsdf };
enum class LightSampling : uint8_t { Power, Tree };
enum class Jitter { Auto, PerFrame, PerPixel, None };

/// Settings of light transport: `path.*` and `sampler.*` in parameter ids.
struct PathSettings {
    int maxDepth = 6;             ///< surfaces a path may scatter at; 1 is direct light only
    int maxDiffuseDepth = 6;      ///< of these, diffuse scatterings
    int maxSpecularDepth = 6;     ///< of these, specular reflections and transmissions
    int rouletteDepth = 3;        ///< scatterings before Russian roulette may end a path
    bool roulette = true;
    bool clamp = false;           ///< limit each path contribution after the first surface
    float clampRadiance = 10;     ///< W/(m^2 sr)
    DirectStrategy strategy = DirectStrategy::Mis;
    LightSampling lightSampling = LightSampling::Tree;  ///< how a light is chosen
    bool multipleScattering = true;  ///< between the facets of rough reflecting surfaces [Kulla & Conty 2017]
    bool regularize = false;      ///< path-space regularization [Kaplanyan 2013]: widen lobes after a diffuse vertex
    float regularizeRoughness = 0.3f;
    SamplerKind sampler = SamplerKind::Sobol;
    int haltonLoop = 16;          ///< Halton: the sequence repeats after this many samples

    void describe(ParameterVisitor&);
    bool operator==(const PathSettings&) const = default;
};

}  // namespace lumi
