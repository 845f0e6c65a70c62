#pragma once
#include <functional>
#include <vector>

#include "math/vector.h"
#include "scene/mesh.h"

namespace lumi {

/// Soft bodies as one field, negative inside and about the distance in metres near the surface: balls, cones and
/// ellipsoids that flow into each other, or are pressed into what is there.
class SoftBody {
public:
    /// A cone between two balls; equal ends are one ball. `blend` is how wide the seam to what is there becomes,
    /// metres.
    void addCone(const Vec3& a, const Vec3& b, float radiusA, float radiusB, float blend);
    void addEllipsoid(const Vec3& centre, const Vec3& radii, float blend);
    /// The same, taken away.
    void carveCone(const Vec3& a, const Vec3& b, float radiusA, float radiusB, float blend);

    float distance(const Vec3& p) const;

private:
    struct Piece {
        Vec3 a, b;  ///< ends; centre and radii of an ellipsoid
        float radiusA = 0, radiusB = 0, blend = 0;
        bool ellipsoid = false, carved = false;
        float distance(const Vec3& p) const;
    };
    std::vector<Piece> pieces_;
};

/// Where `field` is 0 within `box`, as triangles of about `cell` metres whose vertices lie on the surface and have its
/// normals (surface nets [Gibson 1998], then Newton steps along the gradient). Closed if the surface does not reach the
/// box's sides. `field` is negative inside, about a distance, and may be asked on any thread.
Mesh surfaceOf(const std::function<float(const Vec3&)>& field, const Bounds3& box, float cell);

}  // namespace lumi
