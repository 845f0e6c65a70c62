#pragma once
#include <span>
#include <unordered_map>

#include "math/transform.h"
#include "scene/mesh.h"

namespace lumi {

/// The box around `points`; empty for none.
Bounds3 boundsOf(std::span<const Vec3> points);

/// The box around the transformed corners of `bounds`: contains every transformed point of it. Empty stays empty.
Bounds3 transformedBounds(const Bounds3& bounds, const Mat4& m);

/// Object-space boxes of meshes at rest, each worked out once however many instances ask. Not for several threads.
class MeshBounds {
public:
    const Bounds3& of(const Mesh& mesh);

private:
    std::unordered_map<const Mesh*, Bounds3> known_;
};

}  // namespace lumi
