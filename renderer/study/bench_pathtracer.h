#pragma once
#include <optional>

#include "scene/scene.h"
#include "study/bench_timing.h"

namespace lumi {

/// Our path tracer beside Embree's own `pathtracer`: Mray/s of both, every ray counted, measured in turn on the same
/// file with the same camera, one point light, one sample a pixel and paths of the same length without roulette.
struct PathtracerComparison {
    double ownMrays = 0, theirMrays = 0;
    double ownRaysAPath = 0, theirRaysAPath = 0;
    RunTimes times;  ///< of our frames
};

/// Is the program installed, with its models?
bool hasPathtracer();

/// On its Cornell box at 512x512; nothing if it gave no result.
std::optional<PathtracerComparison> comparePathtracerOnCornell(std::stop_token stop);

/// On the triangles of `scene`, written as an OBJ with colours but no textures, from the scene's first camera at
/// 640x360 under a light in the middle of its bounds.
std::optional<PathtracerComparison> comparePathtracer(const Scene& scene, std::stop_token stop);

}  // namespace lumi
