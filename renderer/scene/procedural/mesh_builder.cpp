#include "scene/procedural/mesh_builder.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace lumi {

uint32_t MeshBuilder::addVertex(const SurfaceVertex& vertex) {
    mesh_.positions.push_back(vertex.position);
    mesh_.normals.push_back(vertex.normal);
    mesh_.uv[0].push_back(vertex.uv);
    return static_cast<uint32_t>(mesh_.positions.size() - 1);
}

void MeshBuilder::addTriangle(uint32_t a, uint32_t b, uint32_t c) {
    const auto& p = mesh_.positions;
    if (p[a] == p[b] || p[b] == p[c] || p[c] == p[a]) return;
    mesh_.triangles.push_back({a, b, c});
    slots_.push_back(slot_);
}

void MeshBuilder::addQuad(uint32_t a, uint32_t b, uint32_t c, uint32_t d) {
    const auto& p = mesh_.positions;
    if (glm::distance(p[b], p[d]) < glm::distance(p[a], p[c])) {
        addTriangle(a, b, d);
        addTriangle(b, c, d);
    } else {
        addTriangle(a, b, c);
        addTriangle(a, c, d);
    }
}

void MeshBuilder::addPatch(const std::array<Vec3, 4>& corners, Vec2 uvScale) {
    const Vec3 normal = glm::normalize(glm::cross(corners[2] - corners[0], corners[3] - corners[1]));
    const Vec2 uv[4] = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
    uint32_t index[4];
    for (size_t i = 0; i < 4; ++i) index[i] = addVertex({corners[i], normal, uv[i] * uvScale});
    addQuad(index[0], index[1], index[2], index[3]);
}

void MeshBuilder::addGrid(int columns, int rows, const GridSurface& surface) {
    const auto first = static_cast<uint32_t>(mesh_.positions.size());
    for (int row = 0; row <= rows; ++row)
        for (int column = 0; column <= columns; ++column) addVertex(surface(column, row));
    const auto at = [&](int column, int row) {
        return first + static_cast<uint32_t>(row) * static_cast<uint32_t>(columns + 1) + static_cast<uint32_t>(column);
    };
    for (int row = 0; row < rows; ++row)
        for (int column = 0; column < columns; ++column)
            addQuad(at(column, row), at(column + 1, row), at(column + 1, row + 1), at(column, row + 1));
}

void MeshBuilder::append(const Mesh& mesh, const Mat4& transform) {
    const auto first = static_cast<uint32_t>(mesh_.positions.size());
    const Mat3 normals = normalMatrix(transform);
    for (size_t i = 0; i < mesh.positions.size(); ++i) {
        const Vec3 normal = mesh.normals.empty() ? Vec3(0, 1, 0) : mesh.normals[i];
        addVertex({transformPoint(transform, mesh.positions[i]), glm::normalize(normals * normal),
                   mesh.uv[0].empty() ? Vec2(0) : mesh.uv[0][i]});
    }
    const bool mirrored = isMirroring(transform);
    for (const UVec3& t : mesh.triangles)
        addTriangle(first + t.x, first + (mirrored ? t.z : t.y), first + (mirrored ? t.y : t.z));
}

Mesh MeshBuilder::take(std::string name) {
    Mesh mesh = std::exchange(mesh_, {});
    std::vector<uint32_t> slots = std::exchange(slots_, {});
    mesh.name = std::move(name);
    const bool oneSlot = std::adjacent_find(slots.begin(), slots.end(), std::not_equal_to<>()) == slots.end();
    if (oneSlot) mesh.material = slots.empty() ? 0 : slots.front();
    else mesh.triangleMaterial = std::move(slots);
    return mesh;
}

Vec2 circlePoint(int index, int count) {
    // In double, and exact zeros where the axes are crossed.
    const int i = ((index % count) + count) % count;
    const double angle = 2 * 3.14159265358979323846 * i / count;
    const auto snap = [](double x) { return std::abs(x) < 1e-15 ? 0.0f : static_cast<float>(x); };
    return {snap(std::cos(angle)), snap(std::sin(angle))};
}

}  // namespace lumi
