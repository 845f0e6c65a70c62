#pragma once
#include <filesystem>

#include "scene/scene.h"

namespace lumi {

/// Writes the scene's triangles at rest, in world space with their normals, as `path` and a .mtl beside it: a group an
/// instance, base colours as Kd. Textures, lights, cameras, transparency and animation are left out. Throws
/// Error(Resources) if the disk is full.
void exportObj(const Scene& scene, const std::filesystem::path& path);

}  // namespace lumi
