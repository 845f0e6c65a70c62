#pragma once
#include <cmath>
#include <cstdint>

#include "params/parameter.h"

namespace lumi {

enum class SamplerKind { Sobol, Halton, Independent, BlueNoise };
enum class DirectStrategy { Mis, Light, Bsdf };
enum class LightSampling : uint8_t { Power, Tree };
enum class RegularizeAfter { Diffuse, Any };
enum class Jitter { Auto, PerFrame, PerPixel, None };

/// Settings of light transport: `path.*` and `sampler.*` in parameter ids.
struct PathSettings {
    int maxDepth = 6;          ///< surfaces a path may scatter at; 1 is direct light only
    int maxDiffuseDepth = 6;   ///< of these, diffuse scatterings
    int maxSpecularDepth = 6;  ///< of these, specular reflections and transmissions
    int rouletteDepth = 3;     ///< scatterings before Russian roulette may end a path
    bool roulette = true;
    bool clamp = false;        ///< limit each path contribution after the first surface
    float clampRadiance = 10;  ///< W/(m^2 sr)
    DirectStrategy strategy = DirectStrategy::Mis;
    LightSampling lightSampling = LightSampling::Tree;  ///< how a light is chosen
    bool multipleScattering = true;  ///< between the facets of rough reflecting surfaces [Kulla & Conty 2017]
    bool regularize = false;         ///< path-space regularization [Kaplanyan 2013]: widen lobes after a scattering
    RegularizeAfter regularizeAfter = RegularizeAfter::Diffuse;
    float regularizeRoughness = 0.3f;  ///< least roughness of the first sample
    float regularizeDecay =
        1.0f /
        6;  ///< of sample n: regularizeRoughness (n + 1)^-regularizeDecay; 0 stays, as a stream of frames wants it
    SamplerKind sampler = SamplerKind::Sobol;
    int haltonLoop = 16;  ///< Halton: the sequence repeats after this many samples

    /// Roughness that lobes have at least after a scattering, for this sample of a pixel. With a decay it falls
    /// below that of mirrors in the end, so that the mean converges to the image without it.
    float leastRoughness(uint32_t sample) const {
        return regularizeRoughness * std::pow(static_cast<float>(sample) + 1, -regularizeDecay);
    }

    /// Are lobes widened at the surface that a path meets as its `depth`-th, from 0?
    bool regularizes(bool diffuseBefore, int depth) const {
        return regularize && (regularizeAfter == RegularizeAfter::Any ? depth > 0 : diffuseBefore);
    }

    void describe(ParameterVisitor&);
    bool operator==(const PathSettings&) const = default;
};

}  // namespace lumi
