#pragma once
#include <cstdint>
#include <vector>

#include "measure/measure.h"

namespace lumi {

/// Two consecutive frames of one sequence, linear RGB of one extent, and what is known of how their points moved.
struct TemporalPair {
    const Image& image;     ///< the later frame
    const Image& previous;
    const Image* motion = nullptr;         ///< XY or XYZ of the later frame (Signal::Motion, best the reference's); null: nothing moves
    const Image* depth = nullptr;          ///< linear view depth of the later frame; null: no point is ever uncovered
    const Image* previousDepth = nullptr;  ///< of the earlier frame
    const Image* mask = nullptr;           ///< above 0.5 counts; null: everything
    float exposureEv = 0;                  ///< 2^EV, clamp, sRGB
};

/// A metric that needs more than one frame, for lists and help.
struct SequenceMetric {
    const char* id;
    const char* title;
    const char* definition;
};
/// temporal, temporal_reprojected, lag.
const std::vector<SequenceMetric>& sequenceMetricCatalog();

/// Mean absolute difference of the luminances of the two tone-mapped frames, pixel by pixel: flicker on a static view.
/// Detail `nonfinite_pixels`; those count for nothing.
Measurement measureTemporal(const TemporalPair& pair, bool wantMap);

/// The same after each pixel of the later frame has followed its motion to where its point was, bilinearly: the movement of
/// the camera and of objects is no flicker then. Points that were off the image do not count; nor, with both depths, do
/// those that something hid (a depth that differs by more than 5% from where the point was, at any of the four pixels).
/// Details: `nonfinite_pixels`, and `covered`, the share of pixels that count.
Measurement measureReprojectedTemporal(const TemporalPair& pair, bool wantMap);

/// How an output follows a step in the light, from the frame of the step on.
///
/// Response of a frame: the projection of its difference from `before` on that of `after`, over the luminances of all
/// pixels that count: 0 is as before the step, 1 has arrived. Noise averages out in it. For an exponential mean with
/// weight a the response n frames after the step is 1 - (1 - a)^(n + 1).
class LagMeter {
public:
    /// References of before and after the step, linear RGB. `mask` may be null.
    LagMeter(const Image& before, const Image& after, const Image* mask = nullptr);

    /// The output's next frame; the first is that of the step.
    void add(const Image& frame);
    const std::vector<double>& curve() const { return curve_; }
    /// Frames after that of the step until the response is at least kReached; -1: not within the frames there were.
    int64_t lag() const;
    /// The same for each pixel on its own (noise and all); the number of frames where it was not reached, 0 where the step
    /// changes less than a hundredth of the largest change.
    Image map() const;
    /// Does the step change anything? Without that the response is NaN.
    bool changes() const { return squares_ > 0; }

    static constexpr double kReached = 0.9;

private:
    Image before_, step_, first_;  ///< luminances; step_ is 0 where nothing counts; frame of arrival, -1: none
    double squares_ = 0;
    float largest_ = 0;
    std::vector<double> curve_;
};

}  // namespace lumi
