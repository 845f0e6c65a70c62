#pragma once
#include <tiny_obj_loader.h>

#include <stop_token>
#include <string>

#include "scene/mesh.h"

namespace lumi {

/// One shape of an .obj as a mesh; materials by tinyobj's numbers, faces without one get `fallbackMaterial`.
/// Throws Error(BadInput) headed by `where` if an index lies outside its attribute, Error(Interrupted) once stopped.
Mesh meshFromShape(const tinyobj::attrib_t& attributes, const tinyobj::shape_t& shape, uint32_t fallbackMaterial,
                   const std::string& where, const std::stop_token& stop);

}  // namespace lumi
