#pragma once
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "math/hash.h"
#include "math/transform.h"
#include "scene/mesh.h"

namespace lumi {

/// What the furnished generators are built from: small closed shapes, sweeps and grids that are appended to one Mesh.
/// Lengths in metres, +Y up, outward faces counter-clockwise. uv is in metres along the surface unless said otherwise,
/// so that one wood or cloth texture fits every piece. Material slots are small numbers in Mesh::triangleMaterial.
/// Surfaces called closed share every edge between exactly two triangles once equal positions are welded.

/// Seeded random numbers for scattering books, leaves and folds: the same seed gives the same sequence everywhere.
class Dice {
public:
    explicit Dice(int seed) : state_(mixBits(static_cast<uint64_t>(seed) + 0x51ed27u)) {}
    /// Uniform in [0, 1).
    float unit() { return unitFloat(static_cast<uint32_t>(mixBits(state_++) >> 32)); }
    float range(float low, float high) { return low + (high - low) * unit(); }
    int below(int count) { return static_cast<int>(unit() * static_cast<float>(count)); }

private:
    uint64_t state_;
};

/// Smooth value noise in [-1, 1] on the unit lattice, C1.
float valueNoise(const Vec3& p, uint32_t seed = 0);

/// Scale, then rotate about X, Y, Z (degrees, in this order), then translate.
Mat4 placed(const Vec3& translate, const Vec3& rotateDeg = Vec3(0), const Vec3& scale = Vec3(1));

/// Adds `part` to `mesh`: its slots move up by `slot`. Mirroring matrices turn the faces around. Parts without normals
/// or uv get face normals and zeros.
void append(Mesh& mesh, const Mesh& part, uint32_t slot = 0, const Mat4& place = Mat4(1));

/// Gives every vertex of `mesh` the linear colour `colour`.
void paint(Mesh& mesh, const Vec3& colour);

/// Turns every face around, normals included.
void turnInsideOut(Mesh& mesh);

/// Moves every vertex by `f`, then recomputes smooth normals.
void deform(Mesh& mesh, const std::function<Vec3(const Vec3&)>& f, float creaseDeg = 50);

/// Angle-weighted normals across vertices at equal positions whose faces differ by less than `creaseDeg`.
void smoothNormals(Mesh& mesh, float creaseDeg = 50);

/// Drops triangles of zero area and vertices that nothing uses.
void tidy(Mesh& mesh);

/// A box centred at the origin, flat faces.
Mesh sharpBox(const Vec3& size);

/// A box with rounded edges and corners, closed. `radius` is limited to half the shortest side.
Mesh roundedBox(const Vec3& size, float radius, int segments = 3);

/// A rounded box whose large faces swell by `swell` metres at their middle: cushions, mattresses. The thin axis is Y.
Mesh cushionBox(const Vec3& size, float radius, float swell, int segments = 3, int divisions = 12);

/// Surface f(u, v), u and v in [0, 1]; the front is where df/du x df/dv points. `closedU` joins u = 1 to u = 0.
/// uv = (u, v) * uvScale.
Mesh gridSurface(int countU, int countV, const std::function<Vec3(float, float)>& f, Vec2 uvScale = Vec2(1),
                 bool closedU = false, bool closedV = false);

/// A point of a profile that is turned about the Y axis: radius and height; `sharp` keeps a crease there.
struct ProfilePoint {
    float radius = 0, height = 0;
    bool sharp = false;
};
using Profile = std::vector<ProfilePoint>;

/// Catmull-Rom curve through the points, `steps` pieces for each span; sharp points end a curve and start the next.
Profile smoothProfile(const Profile& points, int steps);

/// Turns a profile about Y. A profile that rises on the right gives outward normals. Closed if it starts and ends on
/// the axis, or if its last point equals its first.
Mesh lathe(const Profile& profile, int segments);

/// A tube along `path` with the radius given at each point, on frames that do not twist; round caps if `capped`
/// (closed then).
Mesh tube(const std::vector<Vec3>& path, const std::vector<float>& radii, int segments, bool capped = true);

/// Adds a vertex that joint j moves in proportion to influences[j]; those that are 0 take no room.
void addInfluences(SkinWeights& skin, std::span<const float> influences);

/// `count` points of a Catmull-Rom curve through `points`.
std::vector<Vec3> curveThrough(const std::vector<Vec3>& points, int count);

/// A prism between z = -depth/2 and +depth/2 over an outline (counter-clockwise seen from +Z) that is star-shaped about
/// `centre`; edges bevelled by `bevel`. Closed.
Mesh extrude(const std::vector<Vec2>& outline, Vec2 centre, float depth, float bevel = 0);

/// A moulding: the open section (x along `outward`, y along `up`, metres) swept along `path`. `outward` holds for each
/// path point the section's x axis, longer than 1 where a corner is mitred. The front is on the right of the section's
/// direction when looking along the path with `outward` to the right.
Mesh moulding(const std::vector<Vec2>& section, const std::vector<Vec3>& path, const std::vector<Vec3>& outward,
              const Vec3& up);

}  // namespace lumi
