#pragma once
#include "trace/packets.h"
#include "trace/plain_lanes.h"
#include "trace/scene_tables.h"
#include "trace/texture_view.h"

namespace lumi {

/// Can the kernels shade this hit on a triangle?
inline bool isPlain(const InstanceRecord& instance, const MaterialRecord& material) {
    return material.plain && instance.still();
}

/// The lookups of one lane.
struct PlainTaps {
    const MaterialRecord* material = nullptr;
    TexelTaps taps[MaterialRecord::kViews];
    float fraction[MaterialRecord::kViews];  ///< towards the next coarser level
};

/// Triangle and material of a hit that isPlain(), for PlainKernels::place.
void collectTriangle(const InstanceRecord& instance, const MaterialRecord& material, const RawHit& hit,
                     PlainLanes& lanes, int lane);

/// Where the textures of a lane are read, after PlainKernels::place; asks the caches for the texels. `between`: two mip
/// levels are blended, else the nearest one is read.
void findTexels(const SceneTables& tables, const PlainLanes& lanes, int lane, bool between, PlainTaps& taps);

/// Reads them, for PlainKernels::bend and ::prepare.
void readTexels(const SceneTables& tables, const PlainTaps& taps, PlainLanes& lanes, int lane);

}  // namespace lumi
