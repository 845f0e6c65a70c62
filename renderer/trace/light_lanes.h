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
    enum Kind : uint32_t { kMade, kTriangle, kPoint, kSun, kSky };
    PlainLanes::Words kind;
    bool has[kSky + 1] = {};  ///< kinds that some lane is of
    Column chance;            ///< of the chosen light

    // Triangles: corner and edges; points: place, axis and (range, spotScale, spotOffset); suns: direction and
    // (oneMinusCos, -, -); cells of the sky: (column, row, -) and the bounds of the random numbers that choose it,
    // (low, high, -) for columns, then for rows.
    Column3 first, second, third;
    Column3 value;        ///< radiance of triangles and suns, intensity of points, irradiance of suns without extent
    Column offset, side;  ///< of triangles: Lights::Triangle's; 1: shines to the front, -1: to the back, 0: to both

    Column3 position;   ///< out: the light's point; for the sky the direction
    Column skyU, skyV;  ///< out: place in the sky's image
};

/// The sky's image as the kernel reads it.
struct SkyGrid {
    float columns = 0, rows = 0;
    float cosine = 1, sine = 0;  ///< of its rotation
};

/// A directional light as the kernel reads it.
struct SunCone {
    float x = 0, y = 1, z = 0;       ///< unit, towards it
    float cosHalf = 1, sinHalf = 0;  ///< of half its angle
    float irradiance = 0;            ///< luminance, W/m^2
};

/// The sky's irradiance on planes, as EnvironmentLight::irradiance().
struct SkyCube {
    float side[6] = {};          ///< luminance along +X, -X, +Y, -Y, +Z, -Z of the image, W/m^2
    float cosine = 1, sine = 0;  ///< of the image's rotation
    float least = 0;             ///< it counts at least as that
};

struct LightLaneKernels {
    // What lights at infinity weigh in the choice for each lane, as Lights::infiniteImportance() for Facing::Front.
    void (*weighSun)(const SunCone& sun, const PlainLanes& lanes, float* weights);
    void (*weighSky)(const SkyCube& sky, const PlainLanes& lanes, float* weights);

    // Samples of one kind of light: directions, targets, radiances, distances and densities; pdf 0 where nothing
    // arrives. What Lights::samplePoint() does one by one. Other lanes stay as they are.
    void (*triangles)(LightLanes& lights, PlainLanes& lanes);
    void (*points)(LightLanes& lights, PlainLanes& lanes);
    void (*suns)(LightLanes& lights, PlainLanes& lanes);
    void (*sky)(const SkyGrid& grid, LightLanes& lights, PlainLanes& lanes);
};

LUMI_KERNELS(LightLaneKernels, lightLane)

}  // namespace lumi
