#include "scene/bounds.h"

namespace lumi {

Bounds3 boundsOf(std::span<const Vec3> points) {
    Bounds3 bounds;
    for (const Vec3& p : points) bounds.extend(p);
    return bounds;
}

Bounds3 transformedBounds(const Bounds3& bounds, const Mat4& m) {
    Bounds3 result;
    for (int corner = 0; corner < 8 && !bounds.empty(); ++corner) {
        const Vec3 p(corner & 1 ? bounds.upper.x : bounds.lower.x, corner & 2 ? bounds.upper.y : bounds.lower.y,
                     corner & 4 ? bounds.upper.z : bounds.lower.z);
        result.extend(transformPoint(m, p));
    }
    return result;
}

const Bounds3& MeshBounds::of(const Mesh& mesh) {
    const auto [entry, isNew] = known_.try_emplace(&mesh);
    if (isNew) entry->second = boundsOf(mesh.positions);
    return entry->second;
}

}  // namespace lumi
