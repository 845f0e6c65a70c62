#pragma once
#include <functional>
#include <span>
#include <vector>

#include "math/vector.h"
#include "trace/medium_stack.h"

namespace lumi {

struct FrameSampling;
struct PathStart;
struct TraceScene;

/// The solids that a camera is in while the shutter is open: it may dive, or be overtaken by what moves.
class EyeMedia {
public:
    EyeMedia() : EyeMedia(MediumStack()) {}
    explicit EyeMedia(const MediumStack& always) : spans_{{1, always}} {}
    /// From `first` to `last` of the open shutter, both in [0, 1]. `at(time)` is asked at a few times and, where it
    /// changes between two of them, until it is known when to 1/4096 of the open shutter. What begins and ends between
    /// two that agree, 1/16 of the time apart, is missed.
    EyeMedia(float first, float last, const std::function<MediumStack(float time)>& at);

    const MediumStack& at(float time) const {
        size_t i = 0;
        while (i + 1 < spans_.size() && time >= spans_[i].until) ++i;
        return spans_[i].media;
    }
    /// Does any of it absorb?
    bool isAnywhere() const;

private:
    struct Span {
        float until = 1;
        MediumStack media;
    };
    std::vector<Span> spans_;  ///< one after the other; the last goes on
};

/// Of a frame's camera; of a scene in which nothing absorbs no solids matter.
EyeMedia mediaAroundEye(const TraceScene& scene, const FrameSampling& sampling);

/// Of starts that a camera may have made. With `areBehind` the eye is tmax behind their origins. Lenses are small
/// beside the solids that they are in: at each time one start speaks for all.
EyeMedia mediaAroundEyes(const TraceScene& scene, std::span<const PathStart> starts, bool areBehind);

}  // namespace lumi
