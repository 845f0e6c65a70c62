#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "scene/gltf/document.h"

namespace lumi::gltf {

/// The bytes of a buffer view under EXT_meshopt_compression: attributes, triangles or indices, filters undone. Sizes
/// are checked against what the compressed bytes can hold at most before memory is taken. `path` is the view's JSON
/// path. Throws Error(BadInput).
std::vector<uint8_t> decodeMeshopt(const Document& document, const tinygltf::BufferView& view, const std::string& path);

/// True if the buffer view is compressed so.
bool isMeshopt(const tinygltf::BufferView& view);

}  // namespace lumi::gltf
