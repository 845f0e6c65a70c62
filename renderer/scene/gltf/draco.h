#pragma once
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "math/vector.h"
#include "scene/gltf/accessor.h"

namespace lumi::gltf {

/// A primitive's vertices and triangles out of KHR_draco_mesh_compression. Its accessors still say what numbers mean.
struct DracoMesh {
    std::vector<UVec3> triangles;
    std::map<std::string, DecodedElements> attributes;  ///< by glTF's attribute name

    /// The attribute, or null if it is not among the compressed ones.
    const DecodedElements* find(const std::string& name) const {
        const auto found = attributes.find(name);
        return found == attributes.end() ? nullptr : &found->second;
    }
};

/// Decodes a primitive's Draco data; null if it has none. Counts in the compressed header are checked against the
/// primitive's accessors before anything is decoded. `path` is the primitive's JSON path. Throws Error(BadInput).
std::unique_ptr<const DracoMesh> decodeDraco(const Document& document, const tinygltf::Primitive& primitive,
                                             const std::string& path);

}  // namespace lumi::gltf
