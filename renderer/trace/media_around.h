#pragma once
#include <span>

#include "math/vector.h"
#include "trace/medium_stack.h"

namespace lumi {

struct TraceScene;

/// The solids that all of `places` are in at `time`, for paths that begin there: a camera under water, or in a glass.
/// They are the boundaries that rays in sixteen directions leave without having entered, up to the first opaque
/// surface: what most of them left, if those are a quarter and no ray comes out of the scene without leaving anything.
/// Open surfaces count by what is behind them, as they do for paths. None where the places differ: an orthographic
/// camera's plane may cut what it sees.
MediumStack mediaAround(const TraceScene& scene, std::span<const Vec3> places, float time);

}  // namespace lumi
