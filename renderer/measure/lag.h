#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "image/image.h"

namespace lumi {

/// Lag: the number of frames that an output needs to follow a step in the light.
///
/// Response of a frame: the projection of its difference from `before` on that of `after`, over the linear luminances
/// of all pixels that count (in the mask, finite): 0 is as before the step, 1 has arrived. It knows no exposure and no
/// clamping, and noise averages out in it. The lag is the number of frames after that of the step until the response is
/// at least kReached; for an exponential mean with weight a the response n frames after the step is 1 - (1 - a)^(n +
/// 1).

/// What became of a step.
struct Lag {
    double value = 0;             ///< frames; NaN where there is none, see reason
    int64_t stepFrame = -1;       ///< number of the first frame in the new light; -1: no step
    std::vector<double> curve;    ///< response of the frame of the step and of those after it
    int64_t nonFinitePixels = 0;  ///< of all frames after the step together; they count for nothing
    std::string reason;           ///< why `value` is NaN; empty where it is a number
};

/// For a step whose references are known: a study's, or a test's.
class LagMeter {
public:
    /// References of before and after the step, linear RGB; `mask` (may be null): above 0.5 counts. All later frames
    /// have their extent.
    LagMeter(const Image& before, const Image& after, const Image* mask = nullptr);

    /// The output's next frame, linear RGB; the first is that of the step.
    void add(const Image& frame);
    const std::vector<double>& curve() const { return curve_; }
    /// The curve and the lag; `stepFrame` is handed through.
    Lag lag(int64_t stepFrame) const;
    /// The same for each pixel on its own (noise and all); the number of frames where it was not reached, 0 where the
    /// step changes less than a hundredth of the largest change.
    Image map() const;
    /// Does the step change anything? Without that the response is NaN.
    bool changes() const { return squares_ > 0; }

    static constexpr double kReached = 0.9;

private:
    Image before_, step_, first_;  ///< luminances; step_ is 0 where nothing counts; frame of arrival, -1: none
    double squares_ = 0;
    float largest_ = 0;
    int64_t nonFinite_ = 0;
    std::vector<double> curve_;
};

/// For a sequence with a reference a frame: finds the step as well, where the reference changes most from one frame to
/// the next (relative change of linear luminance in the mask, |b - a| over |a| + |b|), provided that this is at least
/// kLeastChange and kAboveUsual times the median change of the others.
class LagSequence {
public:
    /// Frames in order. `image`, `reference`: linear RGB; `mask` may be null. A number that does not follow the one
    /// before leaves a gap, and a sequence with gaps has no lag.
    void add(int64_t number, const Image& image, const Image& reference, const Image* mask);
    Lag result() const;
    /// LagMeter::map() of the step; empty if there is none.
    Image map() const;

    static constexpr double kLeastChange = 0.01, kAboveUsual = 4;

private:
    bool hasStep() const;

    std::optional<LagMeter> meter_;
    Image previous_;
    std::vector<double> changes_;
    double stepChange_ = 0;
    int64_t previousNumber_ = -1, stepFrame_ = -1, firstMissing_ = -1;
};

}  // namespace lumi
