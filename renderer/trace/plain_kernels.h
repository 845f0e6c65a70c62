#pragma once
#include "base/isa.h"
#include "trace/albedo_view.h"
#include "trace/plain_lanes.h"

namespace lumi {

struct PlainSettings {
    bool multipleScattering = true;
    bool mis = true;        ///< else light samples count whole
    bool roulette = false;  ///< at this vertex
};

struct PlainKernels {
    /// The point, its normals, its place in the textures and how wide the footprint is there.
    void (*place)(PlainLanes& lanes);
    /// And their shading normals: by the normal map, and so that mirror directions stay above the surface.
    void (*bend)(PlainLanes& lanes);
};

struct PlainLobeKernels {
    /// Scattering functions of all lanes: what Bsdf's constructor and keep() do.
    void (*prepare)(PlainLanes& lanes, const AlbedoView& albedos, const PlainSettings& settings);
    /// What the light samples are worth, and their shadow rays.
    void (*light)(PlainLanes& lanes, const AlbedoView& albedos, const PlainSettings& settings);
    /// Where the paths go on, Russian roulette included.
    void (*scatter)(PlainLanes& lanes, const AlbedoView& albedos, const PlainSettings& settings);
};

LUMI_KERNELS(PlainKernels, plain)
LUMI_KERNELS(PlainLobeKernels, plainLobe)
/// For lanes none of which reflects like a mirror or a gloss (PlainLanes::glossy): what plainLobeKernels() would give,
/// bit for bit, of what is read after them.
LUMI_KERNELS(PlainLobeKernels, plainDiffuse)

}  // namespace lumi
