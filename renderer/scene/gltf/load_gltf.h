#pragma once
#include "scene/load.h"

namespace lumi {

/// Loads a .gltf or .glb file: nodes, meshes, materials, textures, lights, cameras, animations and skins of one scene.
/// Lights and cameras of the file only: loadScene() adds the defaults. Every index and range of the file is checked
/// before use; images that cannot be read become stand-ins with a warning. Throws Error(BadInput) headed by the
/// file's name and the JSON path, Error(Usage) for an unknown scene or variant, Error(Resources), Error(Interrupted).
Scene loadGltf(const std::filesystem::path& path, MessageLog& log, const LoadOptions& options = {});

}  // namespace lumi
