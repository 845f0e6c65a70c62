#pragma once
#include <span>
#include <vector>

#include "math/transform.h"
#include "scene/light.h"

namespace lumi {

/// A rectangle, disk or sphere light in world space: one description for its Embree body, its sampling and its hits.
/// The body is exact: the mesh that an instance with `light >= 0` carries only describes it to others.
///
/// Bodies absorb what meets them and scatter nothing; the flat ones emit from the side that `normal` points to and are
/// black from behind. Points on a body are named by primitive 0 and two numbers:
///   rectangle, disk: position = centre + (2u - 1) halfX + (2v - 1) halfY;
///   sphere: (u, v) is the octahedral map of the direction from the centre in the light's frame.
struct LightShape {
    LightType type = LightType::Rectangle;
    Vec3 centre{0};
    Vec3 halfX{1, 0, 0}, halfY{0, 1, 0};  ///< to the middle of an edge, or conjugate radii: a disk may be an ellipse
    Vec3 normal{0, 0, -1};                ///< unit; where the flat ones emit
    Vec3 back{0, 0, 1};                   ///< of the flat ones: the frame's Z, on the side where they are black
    float radius = 1;                     ///< sphere, disk that isCircle(): world space
    float area = 1;                       ///< m^2, of the emitting side
    bool rightAngled = true;              ///< halfX and halfY are orthogonal
    Vec3 radiance{1};
    const Texture* texture = nullptr;  ///< of the flat ones: times radiance, level 0; it belongs to the scene

    /// Of a disk: is it round?
    bool isCircle() const;
    /// Radiance of the point named (u, v). Seen from the front, u grows to the left and v upwards.
    Vec3 radianceAt(Vec2 uv) const { return texture ? radiance * texel(uv) : radiance; }
    /// Mean luminance over the body; not 0 while some of it shines.
    float meanLuminance() const;
    /// World position of the point named (u, v), and its outward unit normal.
    Vec3 position(Vec2 uv) const;
    Vec3 normalAt(Vec2 uv) const;
    /// The name of the body's point nearest to `positionWorld`.
    Vec2 nameOf(const Vec3& positionWorld) const;
    bool operator==(const LightShape&) const = default;

private:
    Vec3 texel(Vec2 uv) const;
};

/// The shape of `light`, which has a body, under its transform: a sphere stays one by sphereScale().
LightShape lightShape(const Light& light, const Mat4& worldFromLight);

/// Its shapes under several.
std::vector<LightShape> lightShapes(const Light& light, std::span<const Mat4> worldFromLight);

/// The shape between equally spaced moments of the open shutter, `time` from 0 to 1: corners and rims go straight.
LightShape shapeAt(std::span<const LightShape> shapes, float time);

}  // namespace lumi
