#pragma once
#include "math/vector.h"
#include "trace/medium_stack.h"

namespace lumi {

struct TraceScene;

/// The solids that `place` is in at `time`, for paths that begin there: a camera under water, or in a glass. Their
/// surfaces are closed: rays leave them without having entered, through whatever else is there, in fourteen of sixteen
/// directions. A sheet, of which a ray knows no other side, is no solid here. Of solids that overlap the one counts as
/// innermost that most directions leave first.
MediumStack mediaAround(const TraceScene& scene, const Vec3& place, float time);

}  // namespace lumi
