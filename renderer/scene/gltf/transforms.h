#pragma once
#include "scene/gltf/document.h"
#include "scene/scene.h"

namespace lumi::gltf {

bool isFiniteMatrix(const Mat4& m);

/// (x, y, z, w) made unit; no rotation if it has no length or is not finite.
Quat unitRotation(const Vec4& xyzw);

/// Fills node.local, or node.matrix where a glTF matrix is more than translation, rotation and scale. `path` is the
/// node's JSON path. Throws Error(BadInput) for values that are not finite.
void readTransform(const Document& document, const tinygltf::Node& source, const std::string& path, Node& node);

}  // namespace lumi::gltf
