#pragma once
#include <cmath>
#include <span>
#include <string>

#include "scene/camera.h"

namespace lumi {

class MessageLog;
class PosedScene;
struct Scene;

/// How far from the origin anything may be along each axis, metres; matrices hold no larger numbers either. Distances
/// between such things, their squares and the squares of areas all fit a float, and rays stay far below the 1.8e18 that
/// Embree allows.
constexpr float kReach = 1e9f;

/// Not for NaN, nor for infinities.
inline bool isInReach(float x) { return std::abs(x) <= kReach; }
inline bool isInReach(const Vec3& p) { return isInReach(p.x) && isInReach(p.y) && isInReach(p.z); }
bool isInReach(const Mat4& m);

/// Can rays be carried into the space of `m`? Not if it flattens, nearly so, or makes things so small that a ray's
/// numbers there pass what Embree allows.
bool carriesRays(const Mat4& m);

/// The first point that is not in reach; points.size() if all are.
size_t firstOutOfReach(std::span<const Vec3> points);

/// For messages: what is expected of coordinates, and what one that is not in reach is.
std::string reachText();
std::string outOfReachText(const Vec3& p);

/// Throws Error(BadInput) that names the scene's file and the first instance or light some part of which is not in
/// reach at any moment of the frame: animation, skins, morphing and scales can carry there what lay in reach when it
/// was loaded. `bounds` holds the world-space box of each instance at shutter open.
void requireReach(const PosedScene& posed, std::span<const Bounds3> bounds);

/// The same for a camera, which may be ten times as far: its place, and the part of the world that an orthographic one
/// sees. `where` is the scene's file.
void requireReach(const CameraPose& camera, const std::string& where);

/// Warns of a scene at rest that lies where floats are coarse beside its size, or is small: rays start up to 256 units
/// in the last place off surfaces, and 15 um near the origin [Waechter & Binder 2019].
void warnOfDistance(const Scene& scene, MessageLog& log);

}  // namespace lumi
