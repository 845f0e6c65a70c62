#pragma once
#include <stop_token>

#include "base/messages.h"
#include "scene/scene.h"

namespace lumi {

/// The camera of a scene that has none, named "default", with a vertical angle of 45 degrees. If three of four rays
/// from the centre of the bounds hit something that faces the centre, as a room's walls do and a solid's inside does
/// not, it stands there and looks along the longer horizontal axis, or, if the room is open at one end of it, stands at
/// that end. Otherwise, and if something is right before it there, it frames the bounds from the front, a little from
/// the right and above. The bounds are those of boundsOverTime(): things stay in the picture while animation plays.
/// Throws Error(Interrupted) once stopped.
Camera defaultCamera(const Scene& scene, std::stop_token stop = {});

/// Share of directions from `origin` in which the first thing met shows its front, of a few dozen spread evenly over
/// the sphere.
float enclosure(const Scene& scene, const Vec3& origin);

/// True if anything in the scene lights it: a light, an environment, or an emissive material that is in use. Emission
/// painted by a texture at strength 1 or below only glows and does not count.
bool hasLight(const Scene& scene);

/// Gives the scene a camera if it has none and, if `allowSky` and nothing shines, the built-in sky and a warning.
/// Throws Error(Interrupted) once stopped.
void addDefaults(Scene& scene, MessageLog& log, bool allowSky, std::stop_token stop = {});

}  // namespace lumi
