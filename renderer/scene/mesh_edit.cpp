#include "scene/mesh_edit.h"

#include <algorithm>
#include <cassert>
#include <utility>

#include "math/transform.h"

namespace lumi {
namespace {

/// Calls `visit` with every per-vertex attribute but the skin.
template <class M, class Visit>
void forEachAttribute(M& mesh, const Visit& visit) {
    visit(mesh.positions);
    visit(mesh.normals);
    visit(mesh.tangents);
    visit(mesh.uv[0]);
    visit(mesh.uv[1]);
    visit(mesh.colours);
    for (auto& target : mesh.morphTargets) {
        visit(target.positions);
        visit(target.normals);
        visit(target.tangents);
    }
}

/// Where an appended mesh's vertices go: after `before` others, `count` of them, `total` in the end.
struct Place {
    size_t before, count, total;
};

/// Appends `from` to `to`, filling whichever is absent with `fill` if the merged mesh has the attribute at all.
template <class T>
void append(std::vector<T>& to, const Place& place, const std::vector<T>& from, const T& fill) {
    if (to.empty() && from.empty()) return;
    const auto [before, count, total] = place;
    to.reserve(total);
    to.resize(before, fill);
    if (from.empty()) to.resize(before + count, fill);
    else to.insert(to.end(), from.begin(), from.end());
}

void appendSkin(SkinWeights& to, size_t before, const SkinWeights& from, size_t count) {
    if (to.empty() && from.empty()) return;
    const auto followJointZero = [&](size_t vertices) {
        if (to.first.empty()) to.first.push_back(0);
        for (size_t i = 0; i < vertices; ++i) {
            to.joint.push_back(0);
            to.weight.push_back(1);
            to.first.push_back(static_cast<uint32_t>(to.joint.size()));
        }
    };
    if (to.empty()) followJointZero(before);
    if (from.empty()) return followJointZero(count);
    const uint32_t offset = static_cast<uint32_t>(to.joint.size());
    for (size_t i = 1; i < from.first.size(); ++i) to.first.push_back(from.first[i] + offset);
    to.joint.insert(to.joint.end(), from.joint.begin(), from.joint.end());
    to.weight.insert(to.weight.end(), from.weight.begin(), from.weight.end());
}

void appendMesh(Mesh& to, const Mesh& from, size_t total) {
    const size_t before = to.positions.size(), count = from.positions.size();
    const Place place{before, count, total};
    append(to.normals, place, from.normals, Vec3(0, 1, 0));
    append(to.tangents, place, from.tangents, Vec4(1, 0, 0, 1));
    append(to.uv[0], place, from.uv[0], Vec2(0));
    append(to.uv[1], place, from.uv[1], Vec2(0));
    append(to.colours, place, from.colours, Vec4(1));
    to.morphTargets.resize(std::max(to.morphTargets.size(), from.morphTargets.size()));
    for (size_t t = 0; t < to.morphTargets.size(); ++t) {
        static const MorphTarget kNone;
        const MorphTarget& target = t < from.morphTargets.size() ? from.morphTargets[t] : kNone;
        append(to.morphTargets[t].positions, place, target.positions, Vec3(0));
        append(to.morphTargets[t].normals, place, target.normals, Vec3(0));
        append(to.morphTargets[t].tangents, place, target.tangents, Vec3(0));
    }
    appendSkin(to.skin, before, from.skin, count);
    append(to.positions, place, from.positions, Vec3(0));
    for (size_t i = 0; i < from.triangles.size(); ++i) {
        to.triangles.push_back(from.triangles[i] + UVec3(static_cast<uint32_t>(before)));
        to.triangleMaterial.push_back(from.materialOf(static_cast<uint32_t>(i)));
    }
}

}  // namespace

void gatherVertices(Mesh& mesh, const std::vector<uint32_t>& source) {
    forEachAttribute(mesh, [&](auto& values) {
        if (values.empty()) return;
        std::remove_reference_t<decltype(values)> gathered;
        gathered.reserve(source.size());
        for (const uint32_t i : source) gathered.push_back(values[i]);
        values = std::move(gathered);
    });
    if (mesh.skin.empty()) return;
    SkinWeights gathered;
    gathered.first.push_back(0);
    for (const uint32_t i : source) {
        for (uint32_t k = mesh.skin.first[i]; k < mesh.skin.first[i + 1]; ++k) {
            gathered.joint.push_back(mesh.skin.joint[k]);
            gathered.weight.push_back(mesh.skin.weight[k]);
        }
        gathered.first.push_back(static_cast<uint32_t>(gathered.joint.size()));
    }
    mesh.skin = std::move(gathered);
}

void compactVertices(Mesh& mesh) {
    constexpr uint32_t kUnused = ~0u;
    std::vector<uint32_t> place(mesh.positions.size(), kUnused);
    for (const UVec3& t : mesh.triangles) place[t.x] = place[t.y] = place[t.z] = 0;
    std::vector<uint32_t> source;
    for (uint32_t i = 0; i < place.size(); ++i)
        if (place[i] != kUnused) {
            place[i] = static_cast<uint32_t>(source.size());
            source.push_back(i);
        }
    if (source.size() == place.size()) return;
    gatherVertices(mesh, source);
    for (UVec3& t : mesh.triangles) t = {place[t.x], place[t.y], place[t.z]};
}

void makeFlat(Mesh& mesh) {
    std::vector<uint32_t> source;
    source.reserve(3 * mesh.triangles.size());
    for (const UVec3& t : mesh.triangles) source.insert(source.end(), {t.x, t.y, t.z});
    mesh.normals.clear();
    gatherVertices(mesh, source);
    mesh.normals.resize(mesh.positions.size());
    for (size_t i = 0; i < mesh.triangles.size(); ++i) {
        const size_t v = 3 * i;
        mesh.triangles[i] = UVec3(static_cast<uint32_t>(v)) + UVec3(0, 1, 2);
        const Vec3 n = glm::cross(mesh.positions[v + 1] - mesh.positions[v], mesh.positions[v + 2] - mesh.positions[v]);
        const float length = glm::length(n);
        for (size_t c = 0; c < 3; ++c) mesh.normals[v + c] = length > 0 ? n / length : Vec3(0, 1, 0);
    }
}

Mesh mergeMeshes(std::vector<Mesh> parts) {
    assert(!parts.empty());
    Mesh merged = std::move(parts.front());
    if (merged.triangleMaterial.empty()) merged.triangleMaterial.resize(merged.triangles.size(), merged.material);
    size_t vertices = merged.positions.size(), triangles = merged.triangles.size();
    for (size_t i = 1; i < parts.size(); ++i) {
        vertices += parts[i].positions.size();
        triangles += parts[i].triangles.size();
    }
    merged.triangles.reserve(triangles);
    merged.triangleMaterial.reserve(triangles);
    for (size_t i = 1; i < parts.size(); ++i) {
        appendMesh(merged, parts[i], vertices);
        parts[i] = Mesh();  // both never stand in memory whole
    }
    // One material for all triangles needs no table.
    const std::vector<uint32_t>& table = merged.triangleMaterial;
    if (std::all_of(table.begin(), table.end(), [&](uint32_t m) { return m == table.front(); })) {
        merged.material = table.empty() ? merged.material : table.front();
        merged.triangleMaterial.clear();
        merged.triangleMaterial.shrink_to_fit();
    }
    return merged;
}

}  // namespace lumi
