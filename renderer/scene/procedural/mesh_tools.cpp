#include "scene/procedural/mesh_tools.h"

#include <algorithm>
#include <cstring>
#include <unordered_map>

namespace lumi {
namespace {

struct PositionHash {
    size_t operator()(const Vec3& p) const {
        uint32_t bits[3];
        const Vec3 q = p + Vec3(0.0f);  // -0 and +0 are one place
        std::memcpy(bits, &q, sizeof bits);
        return hashCombine(bits[0], bits[1], bits[2]);
    }
};

/// For each vertex the lowest index of a vertex at the same position.
std::vector<uint32_t> weld(const std::vector<Vec3>& positions) {
    std::unordered_map<Vec3, uint32_t, PositionHash> first;
    first.reserve(positions.size());
    std::vector<uint32_t> group(positions.size());
    for (uint32_t i = 0; i < positions.size(); ++i) group[i] = first.emplace(positions[i], i).first->second;
    return group;
}

/// Angle at corner a of triangle abc.
float cornerAngle(const Vec3& a, const Vec3& b, const Vec3& c) {
    const Vec3 u = b - a, v = c - a;
    return std::atan2(glm::length(glm::cross(u, v)), glm::dot(u, v));
}

/// Sum over each vertex' own faces, weighted by angle.
std::vector<Vec3> faceNormalSums(const Mesh& mesh) {
    std::vector<Vec3> sums(mesh.positions.size(), Vec3(0));
    for (const UVec3& t : mesh.triangles) {
        const Vec3 p[3] = {mesh.positions[t.x], mesh.positions[t.y], mesh.positions[t.z]};
        const Vec3 n = unitOr(glm::cross(p[1] - p[0], p[2] - p[0]), Vec3(0));
        for (int k = 0; k < 3; ++k) sums[t[k]] += n * cornerAngle(p[k], p[(k + 1) % 3], p[(k + 2) % 3]);
    }
    return sums;
}

}  // namespace

float valueNoise(const Vec3& p, uint32_t seed) {
    const Vec3 cell = glm::floor(p);
    const Vec3 f = p - cell, s = f * f * (Vec3(3) - 2.0f * f);
    const auto corner = [&](int dx, int dy, int dz) {
        const auto x = static_cast<uint32_t>(static_cast<int>(cell.x) + dx);
        const auto y = static_cast<uint32_t>(static_cast<int>(cell.y) + dy);
        const auto z = static_cast<uint32_t>(static_cast<int>(cell.z) + dz);
        return unitFloat(hashCombine(hashCombine(x, y, z), seed)) * 2 - 1;
    };
    const auto alongX = [&](int dy, int dz) { return glm::mix(corner(0, dy, dz), corner(1, dy, dz), s.x); };
    return glm::mix(glm::mix(alongX(0, 0), alongX(1, 0), s.y), glm::mix(alongX(0, 1), alongX(1, 1), s.y), s.z);
}

Mat4 placed(const Vec3& translate, const Vec3& rotateDeg, const Vec3& scale) {
    const Quat x = glm::angleAxis(radians(rotateDeg.x), Vec3(1, 0, 0));
    const Quat y = glm::angleAxis(radians(rotateDeg.y), Vec3(0, 1, 0));
    const Quat z = glm::angleAxis(radians(rotateDeg.z), Vec3(0, 0, 1));
    return Transform{translate, z * y * x, scale}.matrix();
}

void append(Mesh& mesh, const Mesh& part, uint32_t slot, const Mat4& place) {
    const auto base = static_cast<uint32_t>(mesh.positions.size());
    const size_t count = part.positions.size();
    const Mat3 normalFromPart = normalMatrix(place);
    const bool mirrored = isMirroring(place);
    const std::vector<Vec3> normals = part.normals.empty() ? faceNormalSums(part) : part.normals;
    const bool coloured = !part.colours.empty() || !mesh.colours.empty();
    for (size_t i = 0; i < count; ++i) {
        mesh.positions.push_back(transformPoint(place, part.positions[i]));
        mesh.normals.push_back(unitOr(normalFromPart * normals[i], Vec3(0, 1, 0)));
        mesh.uv[0].push_back(part.uv[0].empty() ? Vec2(0) : part.uv[0][i]);
    }
    if (coloured) {
        mesh.colours.resize(base, Vec4(1));
        if (part.colours.empty()) mesh.colours.resize(base + count, Vec4(1));
        else mesh.colours.insert(mesh.colours.end(), part.colours.begin(), part.colours.end());
    }
    // A mesh of one material names it once; from here on each triangle names its own.
    mesh.triangleMaterial.resize(mesh.triangles.size(), mesh.material);
    for (size_t t = 0; t < part.triangles.size(); ++t) {
        const UVec3 v = part.triangles[t] + base;
        mesh.triangles.push_back(mirrored ? UVec3(v.x, v.z, v.y) : v);
        mesh.triangleMaterial.push_back(slot + part.materialOf(static_cast<uint32_t>(t)));
    }
}

void paint(Mesh& mesh, const Vec3& colour) { mesh.colours.assign(mesh.positions.size(), Vec4(colour, 1)); }

void turnInsideOut(Mesh& mesh) {
    for (UVec3& t : mesh.triangles) std::swap(t.y, t.z);
    for (Vec3& n : mesh.normals) n = -n;
}

void deform(Mesh& mesh, const std::function<Vec3(const Vec3&)>& f, float creaseDeg) {
    for (Vec3& p : mesh.positions) p = f(p);
    smoothNormals(mesh, creaseDeg);
}

void smoothNormals(Mesh& mesh, float creaseDeg) {
    const std::vector<Vec3> own = faceNormalSums(mesh);
    const std::vector<uint32_t> group = weld(mesh.positions);
    std::vector<std::vector<uint32_t>> members(mesh.positions.size());
    for (uint32_t i = 0; i < group.size(); ++i) members[group[i]].push_back(i);
    const float cosCrease = std::cos(radians(creaseDeg));
    mesh.normals.resize(mesh.positions.size());
    for (uint32_t i = 0; i < group.size(); ++i) {
        const Vec3 mine = unitOr(own[i], Vec3(0, 1, 0));
        Vec3 sum(0);
        for (const uint32_t other : members[group[i]])
            if (glm::dot(mine, unitOr(own[other], mine)) >= cosCrease) sum += own[other];
        mesh.normals[i] = unitOr(sum, mine);
    }
}

void tidy(Mesh& mesh) {
    std::vector<uint32_t> newIndex(mesh.positions.size(), UINT32_MAX);
    size_t kept = 0;
    for (size_t t = 0; t < mesh.triangles.size(); ++t) {
        const UVec3 v = mesh.triangles[t];
        const Vec3 a = mesh.positions[v.x], b = mesh.positions[v.y], c = mesh.positions[v.z];
        const float longest = std::max({glm::length(b - a), glm::length(c - b), glm::length(a - c)});
        if (glm::length(glm::cross(b - a, c - a)) <= 1e-7f * longest * longest) continue;
        if (!mesh.triangleMaterial.empty()) mesh.triangleMaterial[kept] = mesh.triangleMaterial[t];
        mesh.triangles[kept++] = v;
    }
    mesh.triangles.resize(kept);
    if (!mesh.triangleMaterial.empty()) mesh.triangleMaterial.resize(kept);
    for (const UVec3& v : mesh.triangles)
        for (int k = 0; k < 3; ++k) newIndex[v[k]] = 0;
    uint32_t next = 0;
    for (uint32_t& index : newIndex)
        if (index == 0) index = next++;
    const auto compact = [&](auto& values) {
        if (values.empty()) return;
        for (size_t i = 0; i < newIndex.size(); ++i)
            if (newIndex[i] != UINT32_MAX) values[newIndex[i]] = values[i];
        values.resize(next);
    };
    compact(mesh.positions), compact(mesh.normals), compact(mesh.uv[0]), compact(mesh.colours);
    for (UVec3& v : mesh.triangles) v = UVec3(newIndex[v.x], newIndex[v.y], newIndex[v.z]);
}

void addInfluences(SkinWeights& skin, std::span<const float> influences) {
    if (skin.first.empty()) skin.first.push_back(0);
    float sum = 0;
    for (const float value : influences) sum += value;
    for (size_t j = 0; j < influences.size(); ++j) {
        if (!(influences[j] > 0)) continue;
        skin.joint.push_back(static_cast<uint32_t>(j));
        skin.weight.push_back(influences[j] / sum);
    }
    skin.first.push_back(static_cast<uint32_t>(skin.joint.size()));
}

}  // namespace lumi
