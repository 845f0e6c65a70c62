#pragma once
#include <cstdint>

#include "math/vector.h"

namespace lumi {

constexpr uint32_t kNoInstance = ~0u;

struct Ray {
    Vec3 origin{0};
    float tmin = 0;
    Vec3 direction{0, 0, -1};  ///< unit
    float tmax = kInfinity;
    float time = 0;  ///< 0 at shutter open, 1 at close
    /// A camera's: it does not see the back faces of single-sided opaque materials, as glTF asks. For all other rays
    /// every face is solid, so that what such a surface casts and blocks does not depend on the side.
    bool fromCamera = false;
};

/// A point of a surface that keeps its meaning while things move: what modules store, re-shade and reproject.
struct SurfacePoint {
    uint32_t instance = kNoInstance;
    uint32_t primitive = 0;
    Vec2 barycentrics{0};  ///< weights of the triangle's second and third vertex
    float time = 0;
    bool valid() const { return instance != kNoInstance; }
};

struct Hit {
    SurfacePoint point;
    float distance = kInfinity;
    bool valid() const { return point.valid(); }
};

/// Isotropic footprint of a path [Akenine-Moller 2021, ray cones]: width in metres at the ray's origin, and the growth
/// of the width in metres a metre.
struct RayCone {
    float width = 0, spread = 0;
};

/// Names a stream of random numbers: the caller's choice of pixel, texel, cell or vertex, and the sample within it.
struct RandomKey {
    uint32_t x = 0, y = 0;  ///< pixel (x, y), or any two words
    uint32_t sample = 0;    ///< index in the sequence of that pixel
};

}  // namespace lumi
