#include <algorithm>
#include <cmath>

#include "scene/procedural/mesh_tools.h"

namespace lumi {
namespace {

/// A quad grid's triangles: (countU + 1) x (countV + 1) vertices, u fastest.
void addGridTriangles(Mesh& mesh, uint32_t base, int countU, int countV) {
    const auto row = static_cast<uint32_t>(countU + 1);
    for (uint32_t v = 0; v < static_cast<uint32_t>(countV); ++v)
        for (uint32_t u = 0; u < static_cast<uint32_t>(countU); ++u) {
            const uint32_t i = base + v * row + u;
            mesh.triangles.push_back({i, i + 1, i + row + 1});
            mesh.triangles.push_back({i, i + row + 1, i + row});
        }
}

/// Lines of a rounded box' face along one axis: tangent-spaced in the corners, `divisions` even pieces between.
std::vector<float> faceLines(float half, float radius, int segments, int divisions) {
    std::vector<float> upper;
    for (int k = 1; k <= segments; ++k)
        upper.push_back(
            k == segments ? half
                          : half - radius +
                                radius * std::tan(0.25f * kPi * static_cast<float>(k) / static_cast<float>(segments)));
    std::vector<float> lines;
    for (size_t k = upper.size(); k-- > 0;) lines.push_back(-upper[k]);
    for (int k = 0; k <= divisions; ++k)
        lines.push_back((half - radius) * (2 * static_cast<float>(k) / static_cast<float>(divisions) - 1));
    lines.insert(lines.end(), upper.begin(), upper.end());
    return lines;
}

Mesh roundedBoxDivided(const Vec3& size, float radius, int segments, int divisions) {
    const Vec3 half = size * 0.5f;
    radius = std::clamp(radius, 1e-4f, minComponent(half) * 0.999f);
    Mesh mesh;
    for (int face = 0; face < 6; ++face) {
        const int axis = face / 2, a = (axis + 1) % 3, b = (axis + 2) % 3;
        const float side = face % 2 == 0 ? 1.0f : -1.0f;
        const std::vector<float> linesA = faceLines(half[a], radius, segments, divisions);
        const std::vector<float> linesB = faceLines(half[b], radius, segments, divisions);
        const auto base = static_cast<uint32_t>(mesh.positions.size());
        for (const float vb : linesB)
            for (const float va : linesA) {
                Vec3 p(0);
                p[axis] = side * half[axis], p[a] = va * side, p[b] = vb;
                const Vec3 inner = glm::clamp(p, -half + radius, half - radius);
                const Vec3 normal = glm::normalize(p - inner);
                mesh.positions.push_back(inner + radius * normal);
                mesh.normals.push_back(normal);
                mesh.uv[0].push_back(axis == 0 ? Vec2(p.z, p.y) : axis == 1 ? Vec2(p.x, p.z) : Vec2(p.x, p.y));
            }
        addGridTriangles(mesh, base, static_cast<int>(linesA.size()) - 1, static_cast<int>(linesB.size()) - 1);
    }
    return mesh;
}

}  // namespace

Mesh sharpBox(const Vec3& size) {
    const Vec3 half = size * 0.5f;
    Mesh mesh;
    for (int face = 0; face < 6; ++face) {
        const int axis = face / 2, a = (axis + 1) % 3, b = (axis + 2) % 3;
        const float side = face % 2 == 0 ? 1.0f : -1.0f;
        const auto base = static_cast<uint32_t>(mesh.positions.size());
        Vec3 normal(0);
        normal[axis] = side;
        for (int corner = 0; corner < 4; ++corner) {
            Vec3 p(0);
            p[axis] = side * half[axis];
            p[a] = (corner % 2 == 0 ? -half[a] : half[a]) * side;
            p[b] = corner / 2 == 0 ? -half[b] : half[b];
            mesh.positions.push_back(p);
            mesh.normals.push_back(normal);
            mesh.uv[0].push_back(axis == 0 ? Vec2(p.z, p.y) : axis == 1 ? Vec2(p.x, p.z) : Vec2(p.x, p.y));
        }
        addGridTriangles(mesh, base, 1, 1);
    }
    return mesh;
}

Mesh roundedBox(const Vec3& size, float radius, int segments) { return roundedBoxDivided(size, radius, segments, 1); }

Mesh cushionBox(const Vec3& size, float radius, float swell, int segments, int divisions) {
    Mesh mesh = roundedBoxDivided(size, radius, segments, divisions);
    const Vec3 half = size * 0.5f;
    deform(
        mesh,
        [&](const Vec3& p) {
            const float x = p.x / half.x, z = p.z / half.z;
            const float bulge = std::max(0.0f, 1 - x * x) * std::max(0.0f, 1 - z * z);
            Vec3 q = p;
            q.y += (p.y / half.y) * swell * std::pow(bulge, 0.7f);
            // The seams of a filled cover pull its sides in between the corners.
            q.x *= 1 - 0.35f * swell / half.x * (1 - z * z);
            q.z *= 1 - 0.35f * swell / half.z * (1 - x * x);
            return q;
        },
        60);
    return mesh;
}

Mesh gridSurface(int countU, int countV, const std::function<Vec3(float, float)>& f, Vec2 uvScale, bool closedU,
                 bool closedV) {
    Mesh mesh;
    for (int j = 0; j <= countV; ++j)
        for (int i = 0; i <= countU; ++i) {
            const float u = static_cast<float>(i) / static_cast<float>(countU);
            const float v = static_cast<float>(j) / static_cast<float>(countV);
            mesh.positions.push_back(f(closedU && i == countU ? 0 : u, closedV && j == countV ? 0 : v));
            mesh.uv[0].push_back(Vec2(u, v) * uvScale);
        }
    addGridTriangles(mesh, 0, countU, countV);
    smoothNormals(mesh, 80);
    tidy(mesh);
    return mesh;
}

Mesh extrude(const std::vector<Vec2>& outline, Vec2 centre, float depth, float bevel) {
    const size_t count = outline.size();
    Mesh mesh;
    const auto pulled = [&](size_t i, float by) {
        const Vec2 p = outline[i % count], d = p - centre;
        return by == 0 ? p : p - d * (by / glm::length(d));
    };
    // Each strip and each cap has vertices of its own, so that its edges stay crisp.
    const auto strip = [&](float zA, float byA, float zB, float byB) {
        float along = 0;
        for (size_t i = 0; i < count; ++i) {
            const Vec2 a0 = pulled(i, byA), a1 = pulled(i + 1, byA), b0 = pulled(i, byB), b1 = pulled(i + 1, byB);
            const auto base = static_cast<uint32_t>(mesh.positions.size());
            const float step = glm::length(outline[(i + 1) % count] - outline[i]);
            for (const Vec3& p : {Vec3(a0, zA), Vec3(a1, zA), Vec3(b1, zB), Vec3(b0, zB)}) mesh.positions.push_back(p);
            for (const Vec2& uv : {Vec2(along, zA), Vec2(along + step, zA), Vec2(along + step, zB), Vec2(along, zB)})
                mesh.uv[0].push_back(uv);
            mesh.triangles.push_back({base, base + 1, base + 2});
            mesh.triangles.push_back({base, base + 2, base + 3});
            along += step;
        }
    };
    const auto cap = [&](float z, bool front) {
        const auto base = static_cast<uint32_t>(mesh.positions.size());
        mesh.positions.push_back(Vec3(centre, z));
        mesh.uv[0].push_back(centre);
        for (size_t i = 0; i < count; ++i) {
            mesh.positions.push_back(Vec3(pulled(i, bevel), z));
            mesh.uv[0].push_back(pulled(i, bevel));
            const auto a = base + 1 + static_cast<uint32_t>(i), b = base + 1 + static_cast<uint32_t>((i + 1) % count);
            mesh.triangles.push_back(front ? UVec3(base, a, b) : UVec3(base, b, a));
        }
    };
    const float h = depth * 0.5f;
    strip(-h + bevel, 0, h - bevel, 0);
    if (bevel > 0) strip(h - bevel, 0, h, bevel), strip(-h, bevel, -h + bevel, 0);
    cap(h, true), cap(-h, false);
    smoothNormals(mesh, 30);
    return mesh;
}

}  // namespace lumi
