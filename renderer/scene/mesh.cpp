#include "scene/mesh.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "scene/reach.h"

namespace lumi {
namespace {

template <class T>
size_t bytesOf(const std::vector<T>& values) {
    return values.size() * sizeof(T);
}

/// Interior angle between two edges that leave one corner; 0 for edges without length.
float angleBetween(const Vec3& a, const Vec3& b) {
    const float lengths = glm::length(a) * glm::length(b);
    return lengths > 0 ? std::acos(std::clamp(glm::dot(a, b) / lengths, -1.0f, 1.0f)) : 0;
}

void requireLength(size_t length, size_t vertices, const char* attribute, const std::string& where) {
    if (length != 0 && length != vertices)
        throwBadInput({.what = std::string("the attribute ") + attribute + " has another length than the positions",
                       .where = where,
                       .expected = std::to_string(vertices),
                       .found = std::to_string(length)});
}

void checkSkin(const SkinWeights& skin, size_t vertices, const std::string& where) {
    if (skin.empty()) return;
    const bool rowsFit = skin.first.size() == vertices + 1 && skin.first.front() == 0 &&
                         skin.first.back() == skin.joint.size() && skin.joint.size() == skin.weight.size() &&
                         std::is_sorted(skin.first.begin(), skin.first.end());
    if (!rowsFit) throwBadInput({.what = "the skin weights do not fit the vertices", .where = where});
}

}  // namespace

size_t Mesh::byteCount() const {
    size_t bytes = bytesOf(positions) + bytesOf(normals) + bytesOf(tangents) + bytesOf(uv[0]) + bytesOf(uv[1]) +
                   bytesOf(colours) + bytesOf(triangles) + bytesOf(triangleMaterial) + bytesOf(skin.first) +
                   bytesOf(skin.joint) + bytesOf(skin.weight);
    for (const MorphTarget& target : morphTargets)
        bytes += bytesOf(target.positions) + bytesOf(target.normals) + bytesOf(target.tangents);
    return bytes;
}

void checkMesh(const Mesh& mesh, const std::string& where) {
    const size_t vertices = mesh.positions.size();
    if (mesh.triangles.size() >= (size_t(1) << 31) || vertices >= (size_t(1) << 32))
        throwBadInput({.what = "the mesh is too large",
                       .where = where,
                       .expected = "fewer than 2^31 triangles",
                       .found = std::to_string(mesh.triangles.size())});
    requireLength(mesh.normals.size(), vertices, "normals", where);
    requireLength(mesh.tangents.size(), vertices, "tangents", where);
    requireLength(mesh.uv[0].size(), vertices, "uv 0", where);
    requireLength(mesh.uv[1].size(), vertices, "uv 1", where);
    requireLength(mesh.colours.size(), vertices, "colours", where);
    for (const MorphTarget& target : mesh.morphTargets) {
        requireLength(target.positions.size(), vertices, "morph positions", where);
        requireLength(target.normals.size(), vertices, "morph normals", where);
        requireLength(target.tangents.size(), vertices, "morph tangents", where);
    }
    checkSkin(mesh.skin, vertices, where);
    if (!mesh.triangleMaterial.empty() && mesh.triangleMaterial.size() != mesh.triangles.size())
        throwBadInput({.what = "the materials of the triangles have another length than the triangles",
                       .where = where,
                       .expected = std::to_string(mesh.triangles.size()),
                       .found = std::to_string(mesh.triangleMaterial.size())});
    for (size_t i = 0; i < mesh.triangles.size(); ++i) {
        const UVec3& t = mesh.triangles[i];
        const uint32_t largest = std::max({t.x, t.y, t.z});
        if (largest >= vertices)
            throwBadInput({.what = "triangle " + std::to_string(i) + " refers to a vertex that does not exist",
                           .where = where,
                           .expected = "an index below " + std::to_string(vertices),
                           .found = std::to_string(largest)});
    }
    if (const size_t i = firstOutOfReach(mesh.positions); i < vertices)
        throwBadInput({.what = "the position of vertex " + std::to_string(i) + " is out of range",
                       .where = where,
                       .expected = reachText(),
                       .found = outOfReachText(mesh.positions[i])});
}

void computeNormals(Mesh& mesh) {
    mesh.normals.assign(mesh.positions.size(), Vec3(0));
    for (const UVec3& t : mesh.triangles) {
        const Vec3 p[3] = {mesh.positions[t.x], mesh.positions[t.y], mesh.positions[t.z]};
        const Vec3 normal = glm::cross(p[1] - p[0], p[2] - p[0]);
        const float length = glm::length(normal);
        if (!(length > 0)) continue;
        for (int c = 0; c < 3; ++c)
            mesh.normals[t[c]] += normal / length * angleBetween(p[(c + 1) % 3] - p[c], p[(c + 2) % 3] - p[c]);
    }
    for (Vec3& normal : mesh.normals) {
        const float length = glm::length(normal);
        normal = length > 0 ? normal / length : Vec3(0, 1, 0);
    }
}

}  // namespace lumi
