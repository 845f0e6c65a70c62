#pragma once
#include "base/isa.h"
#include "trace/plain_lanes.h"

namespace lumi {

/// What kernels read to make the light samples of PlainLanes, a lane each, and what they tell beside PlainLanes'
/// columns.
struct alignas(64) LightLanes {
    using Column = PlainLanes::Column;
    using Column3 = PlainLanes::Column3;

    /// kMade: the sample is complete, or there is none.
    enum Kind : uint32_t { kMade, kTriangle, kPoint, kSky };
    PlainLanes::Words kind;
    bool has[kSky + 1] = {};  ///< kinds that some lane is of
    Column chance;            ///< of the chosen light

    // Triangles: corner and edges; points: place, axis and (range, spotScale, spotOffset); cells of the sky: (column,
    // row, -) and the bounds of the random numbers that choose it, (low, high, -) for columns, then for rows.
    Column3 first, second, third;
    Column3 value;        ///< radiance of triangles, intensity of points
    Column offset, side;  ///< of triangles: Lights::Triangle's; 1: shines to the front, -1: to the back, 0: to both

    Column3 position;   ///< out: the light's point; for the sky the direction
    Column skyU, skyV;  ///< out: place in the sky's image
};

/// The sky's image as the kernel reads it.
struct SkyGrid {
    float columns = 0, rows = 0;
    float cosine = 1, sine = 0;  ///< of its rotation
};

struct LightLaneKernels {
    // Samples of one kind of light: directions, targets, radiances, distances and densities; pdf 0 where nothing
    // arrives. What Lights::samplePoint() does one by one. Other lanes stay as they are.
    void (*triangles)(LightLanes& lights, PlainLanes& lanes);
    void (*points)(LightLanes& lights, PlainLanes& lanes);
    void (*sky)(const SkyGrid& grid, LightLanes& lights, PlainLanes& lanes);
};

LUMI_KERNELS(LightLaneKernels, lightLane)

}  // namespace lumi
