#pragma once
#include <cstdint>

#include "math/vector.h"
#include "trace/settings.h"

namespace lumi {

/// What light is sampled for: a point, and which way it faces.
struct LightReceiver {
    enum class Facing : uint8_t { Any, Front, Both };  ///< scatters light from anywhere, from normal's side, from both

    Vec3 position{0};
    Vec3 normal{0, 0, 1};  ///< unit, of the geometry
    float time = 0;        ///< 0 at shutter open, 1 at close
    Facing facing = Facing::Any;
    LightSampling sampling = LightSampling::Tree;  ///< how a light is chosen
};

}  // namespace lumi
