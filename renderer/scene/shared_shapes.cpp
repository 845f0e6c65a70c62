#include "scene/shared_shapes.h"

#include <algorithm>

#include "base/memory.h"
#include "scene/deform.h"

namespace lumi {

ShapeKey shapeKey(const Instance& instance, std::span<const float> weights, std::span<const Mat4> joints) {
    weights = weights.first(std::min(weights.size(), instance.mesh->morphTargets.size()));
    return {instance.mesh.get(), joints.empty() ? -1 : instance.skin,
            std::string(reinterpret_cast<const char*>(weights.data()), weights.size_bytes())};
}

std::shared_ptr<const DeformedVertices> SharedShapes::of(const Instance& instance, std::span<const float> weights,
                                                         std::span<const Mat4> joints) {
    const Mesh& mesh = *instance.mesh;
    const ShapeKey key = shapeKey(instance, weights, joints);
    {
        const std::lock_guard lock(mutex_);
        if (const auto known = shapes_.find(key); known != shapes_.end()) return known->second;
    }
    // Two threads may make the same one. Neither waits for the other: a worker that waits inside a loop of its own may
    // have taken up the very work that it waits for.
    checkMemory("posing \"" + instance.name + '"', sizeof(Vec3) * (mesh.positions.size() + mesh.normals.size() +
                                                                   mesh.tangents.size() * (joints.empty() ? 1 : 2)));
    auto shape = std::make_shared<const DeformedVertices>(deform(mesh, weights, joints));
    const std::lock_guard lock(mutex_);
    return shapes_.try_emplace(key, std::move(shape)).first->second;
}

}  // namespace lumi
