#include "scene/deform.h"

#include <atomic>
#include <cmath>

#include "base/parallel.h"

namespace lumi {
namespace {

constexpr int64_t kGrain = 4096;  ///< vertices a task

void addScaled(std::vector<Vec3>& to, const std::vector<Vec3>& delta, float weight, size_t begin, size_t end) {
    if (delta.empty() || to.empty()) return;
    for (size_t i = begin; i < end; ++i) to[i] += weight * delta[i];
}

void morphRange(const Mesh& mesh, std::span<const float> weights, size_t begin, size_t end, DeformedVertices& out) {
    for (size_t t = 0; t < mesh.morphTargets.size() && t < weights.size(); ++t) {
        if (weights[t] == 0) continue;
        const MorphTarget& target = mesh.morphTargets[t];
        addScaled(out.positions, target.positions, weights[t], begin, end);
        addScaled(out.normals, target.normals, weights[t], begin, end);
        addScaled(out.tangents, target.tangents, weights[t], begin, end);
    }
    for (size_t i = begin; i < end && !out.normals.empty(); ++i)
        out.normals[i] = unitOr(out.normals[i], mesh.normals[i]);
    for (size_t i = begin; i < end && !out.tangents.empty(); ++i)
        out.tangents[i] = unitOr(out.tangents[i], Vec3(mesh.tangents[i]));
}

Mat4 blendedAt(const SkinWeights& skin, std::span<const Mat4> joints, size_t vertex) {
    Mat4 blended(0);
    for (uint32_t k = skin.first[vertex]; k < skin.first[vertex + 1]; ++k)
        blended += skin.weight[k] * joints[skin.joint[k]];
    return blended;
}

/// Returns how many of the vertices are mirrored.
size_t skinRange(const Mesh& mesh, std::span<const Mat4> joints, size_t begin, size_t end, DeformedVertices& out) {
    size_t mirrored = 0;
    for (size_t i = begin; i < end; ++i) {
        const Mat4 blended = blendedAt(mesh.skin, joints, i);
        mirrored += isMirroring(blended);
        out.positions[i] = Vec3(blended * Vec4(out.positions[i], 1));
        const Vec3 across = out.bitangents.empty() ? Vec3(0) : glm::cross(out.normals[i], out.tangents[i]);
        if (!out.normals.empty()) out.normals[i] = unitOr(normalMatrix(blended) * out.normals[i], out.normals[i]);
        if (!out.tangents.empty()) out.tangents[i] = unitOr(Mat3(blended) * out.tangents[i], out.tangents[i]);
        if (!out.bitangents.empty())
            out.bitangents[i] = unitOr(Mat3(blended) * across, glm::cross(out.normals[i], out.tangents[i]));
    }
    return mirrored;
}

/// At the first vertex of the majority: of those that are mirrored, or of those that are not.
Mat4 typicalBlend(const Mesh& mesh, std::span<const Mat4> joints, size_t mirrored) {
    const bool mostAre = 2 * mirrored > mesh.positions.size();
    for (size_t i = 0; i < mesh.positions.size(); ++i) {
        const Mat4 blended = blendedAt(mesh.skin, joints, i);
        if (isMirroring(blended) == mostAre) return blended;
    }
    return Mat4(1);
}

/// Two edges of a triangle, from its first corner.
struct Edges {
    Vec3 first, second;
    Edges(const std::vector<Vec3>& p, const UVec3& t) : first(p[t.y] - p[t.x]), second(p[t.z] - p[t.x]) {}
};

/// A direction in the plane of the triangle at `rest` as the same mixture of its edges `now`; not unit.
Vec3 carried(const Vec3& direction, const Edges& rest, const Edges& now) {
    const float length = glm::length(rest.first) + glm::length(rest.second);
    const Vec3 e = rest.first / length, f = rest.second / length;
    const float ee = glm::dot(e, e), ef = glm::dot(e, f), ff = glm::dot(f, f);
    const float a = glm::dot(e, direction), b = glm::dot(f, direction);
    return (a * ff - b * ef) * now.first + (b * ee - a * ef) * now.second;
}

void flattenRange(const Mesh& mesh, size_t begin, size_t end, DeformedVertices& out) {
    const float side = out.isMirrored() ? -1.0f : 1.0f;
    for (size_t i = begin; i < end; ++i) {
        const UVec3& t = mesh.triangles[i];
        if (!isFaceNormal(mesh.morphTargets[0].normals[t.x])) continue;
        const Edges rest(mesh.positions, t), now(out.positions, t);
        const Vec3 normal = unitOr(side * glm::cross(now.first, now.second), mesh.normals[t.x]);
        for (int c = 0; c < 3; ++c) {
            out.normals[t[c]] = normal;
            if (out.tangents.empty()) continue;
            const Vec3 tangent(mesh.tangents[t[c]]);
            out.tangents[t[c]] = unitOr(carried(tangent, rest, now), tangent);
            if (out.bitangents.empty()) continue;
            const Vec3 across = glm::cross(mesh.normals[t[c]], tangent);
            out.bitangents[t[c]] = unitOr(carried(across, rest, now), across);
        }
    }
}

}  // namespace

DeformedVertices deform(const Mesh& mesh, std::span<const float> weights, std::span<const Mat4> joints) {
    DeformedVertices out;
    out.positions = mesh.positions, out.normals = mesh.normals;
    out.tangents.assign(mesh.tangents.begin(), mesh.tangents.end());
    if (!joints.empty() && !out.normals.empty()) out.bitangents.resize(out.tangents.size());
    std::atomic<size_t> mirrored{0};
    parallelRanges(static_cast<int64_t>(mesh.positions.size()), kGrain, [&](int64_t begin, int64_t end) {
        if (!mesh.morphTargets.empty())
            morphRange(mesh, weights, static_cast<size_t>(begin), static_cast<size_t>(end), out);
        if (!joints.empty())
            mirrored += skinRange(mesh, joints, static_cast<size_t>(begin), static_cast<size_t>(end), out);
    });
    if (!joints.empty()) out.blend = typicalBlend(mesh, joints, mirrored);
    if (!mesh.morphTargets.empty() && !mesh.morphTargets[0].normals.empty() && !out.normals.empty())
        parallelRanges(static_cast<int64_t>(mesh.triangles.size()), kGrain, [&](int64_t begin, int64_t end) {
            flattenRange(mesh, static_cast<size_t>(begin), static_cast<size_t>(end), out);
        });
    return out;
}

}  // namespace lumi
