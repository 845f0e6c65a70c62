#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "math/vector.h"

namespace lumi {

/// Displacements of one morph target; each either empty or as long as the mesh's positions.
struct MorphTarget {
    std::vector<Vec3> positions, normals, tangents;
};

/// Up to any number of joints a vertex, in compressed rows: the influences of vertex v are
/// [first[v], first[v + 1]). Weights of a vertex sum to 1. Empty: not skinned.
struct SkinWeights {
    std::vector<uint32_t> first;
    std::vector<uint32_t> joint;
    std::vector<float> weight;
    bool empty() const { return joint.empty(); }
};

/// Triangles with per-vertex attributes, object space, counter-clockwise front faces. An attribute is empty or as long
/// as `positions`. Immutable once it is in a Scene. Limits (checked by checkMesh): fewer than 2^31 triangles, indices
/// in range, finite positions.
struct Mesh {
    std::string name;
    std::vector<Vec3> positions;
    std::vector<Vec3> normals;  ///< unit; empty: flat shading
    std::vector<Vec4>
        tangents;  ///< xyz unit, w = +-1 handedness (glTF); empty: derived from uv when a normal map needs it
    std::vector<Vec2> uv[2];
    std::vector<Vec4> colours;  ///< linear RGBA, multiplies base colour
    std::vector<UVec3> triangles;
    std::vector<uint32_t>
        triangleMaterial;  ///< index into Scene::materials for each triangle; empty: `material` for all
    uint32_t material = 0;

    std::vector<MorphTarget> morphTargets;
    SkinWeights skin;

    bool deforms() const { return !morphTargets.empty() || !skin.empty(); }
    uint32_t materialOf(uint32_t triangle) const {
        return triangleMaterial.empty() ? material : triangleMaterial[triangle];
    }
    size_t byteCount() const;
};

/// Throws Error(BadInput) headed by `where` if the mesh breaks its limits; drops nothing.
void checkMesh(const Mesh& mesh, const std::string& where);

/// Unit vertex normals, weighted by angle; degenerate triangles do not count. Overwrites mesh.normals.
void computeNormals(Mesh& mesh);

/// Tangents for uv set `uvSet` [Mikkelsen 2008], splitting vertices whose corners disagree. Overwrites mesh.tangents.
void computeTangents(Mesh& mesh, int uvSet = 0);

}  // namespace lumi
