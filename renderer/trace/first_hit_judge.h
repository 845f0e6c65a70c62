#pragma once
#include <span>

#include "trace/observer.h"
#include "trace/tracer.h"

namespace lumi {

/// Decides what the first rays of paths have found, between finding and shading it: caches of surface points verify
/// theirs that way without another pass. It is the first of the observers of Tracer::tracePaths(), and may have others
/// after it. Its functions are called for a batch of at most PathBatch::kMost starts, on several threads at a time.
class FirstHitJudge : public PathObserver {
public:
    ObserverNeeds needs() const override { return {0, 0, 0, 0, false}; }

    /// ids[i] draws which blended surfaces the first ray of starts[i] stops at: the same id always draws the same.
    virtual void nameRays(std::span<const PathStart> starts, std::span<uint32_t> ids) const = 0;

    /// hits[i] is what the ray of starts[i] met, an invalid one left the scene; rays with tmin > tmax meet nothing and
    /// are not counted. Where the judge puts another point in its place, the path goes on from there as if its ray had
    /// met it. goesOn[i] is 1 and may be set to 0: that path ends without a vertex, its radiance is 0.
    virtual void judge(std::span<const PathStart> starts, std::span<Hit> hits, std::span<uint8_t> goesOn) = 0;
};

}  // namespace lumi
