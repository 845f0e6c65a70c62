#include "scene/deform.h"

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

void skinRange(const Mesh& mesh, std::span<const Mat4> joints, size_t begin, size_t end, DeformedVertices& out) {
    for (size_t i = begin; i < end; ++i) {
        Mat4 blended(0);
        for (uint32_t k = mesh.skin.first[i]; k < mesh.skin.first[i + 1]; ++k)
            blended += mesh.skin.weight[k] * joints[mesh.skin.joint[k]];
        out.positions[i] = Vec3(blended * Vec4(out.positions[i], 1));
        if (!out.normals.empty()) out.normals[i] = unitOr(normalMatrix(blended) * out.normals[i], out.normals[i]);
        if (!out.tangents.empty()) out.tangents[i] = unitOr(Mat3(blended) * out.tangents[i], out.tangents[i]);
    }
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
    for (size_t i = begin; i < end; ++i) {
        const UVec3& t = mesh.triangles[i];
        if (!isFaceNormal(mesh.morphTargets[0].normals[t.x])) continue;
        const Edges rest(mesh.positions, t), now(out.positions, t);
        const Vec3 normal = unitOr(glm::cross(now.first, now.second), mesh.normals[t.x]);
        for (int c = 0; c < 3; ++c) {
            out.normals[t[c]] = normal;
            if (out.tangents.empty()) continue;
            const Vec3 tangent(mesh.tangents[t[c]]);
            out.tangents[t[c]] = unitOr(carried(tangent, rest, now), tangent);
        }
    }
}

}  // namespace

DeformedVertices deform(const Mesh& mesh, std::span<const float> weights, std::span<const Mat4> joints) {
    DeformedVertices out{mesh.positions, mesh.normals, std::vector<Vec3>(mesh.tangents.begin(), mesh.tangents.end())};
    parallelRanges(static_cast<int64_t>(mesh.positions.size()), kGrain, [&](int64_t begin, int64_t end) {
        if (!mesh.morphTargets.empty())
            morphRange(mesh, weights, static_cast<size_t>(begin), static_cast<size_t>(end), out);
        if (!joints.empty()) skinRange(mesh, joints, static_cast<size_t>(begin), static_cast<size_t>(end), out);
    });
    if (!mesh.morphTargets.empty() && !mesh.morphTargets[0].normals.empty() && !out.normals.empty())
        parallelRanges(static_cast<int64_t>(mesh.triangles.size()), kGrain, [&](int64_t begin, int64_t end) {
            flattenRange(mesh, static_cast<size_t>(begin), static_cast<size_t>(end), out);
        });
    return out;
}

}  // namespace lumi
