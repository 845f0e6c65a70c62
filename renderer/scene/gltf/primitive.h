#pragma once
#include "scene/gltf/document.h"
#include "scene/gltf/draco.h"
#include "scene/gltf/materials.h"
#include "scene/mesh.h"

namespace lumi::gltf {

/// The vertices of a primitive: attributes, morph targets and joint weights, without triangles. Normals and tangents
/// come out unit; without normals there are no tangents either. Attributes that are not finite are replaced by harmless
/// ones; positions must be finite. `path` is the primitive's JSON path; `draco` its decoded Draco data, or null;
/// `uvSets` says which texture coordinates to take. Throws Error(BadInput).
Mesh readVertices(const Document& document, const tinygltf::Primitive& primitive, const DracoMesh* draco,
                  const UvSets& uvSets, const std::string& path);

/// The triangles of a primitive, strips and fans taken apart, every index below `vertexCount`. Points and lines give
/// none, and a warning.
std::vector<UVec3> readTriangles(const Document& document, const tinygltf::Primitive& primitive, const DracoMesh* draco,
                                 size_t vertexCount, const std::string& path);

}  // namespace lumi::gltf
