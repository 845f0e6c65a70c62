#pragma once
#include <vector>

#include "reconstruct/module.h"
#include "trace/tracer.h"

namespace lumi {

/// Strata of 3x3 pixels, each with at most one gradient sample [Schied18, sec. 4].
constexpr int kStratum = 3;
inline Extent2 strataOf(Extent2 extent) {
    return {(extent.width + kStratum - 1) / kStratum, (extent.height + kStratum - 1) / kStratum};
}

/// Demodulated luminance of direct and indirect light.
struct ComponentLuminance {
    float direct = 0, indirect = 0;
};

/// A sample of a frame that the next one shades again: its surface point, its random numbers, and what it brought.
struct GradientSample {
    SurfacePoint point;  ///< invalid: the stratum has none
    RandomKey key;
    ComponentLuminance luminance;
};

/// A gradient sample as the present frame sees it.
struct ReshadedSample {
    size_t stratum = 0;  ///< of the present frame
    ComponentLuminance before, now;
};

/// One pixel of each stratum, drawn by a hash of stratum and frame, whose first sample the next frame will shade again.
/// `direct` and `indirect` are the frame's demodulated light. At one sample a pixel that is what the sample brought;
/// with more, the drawn samples are shaded once by themselves. Empty if stopped.
std::vector<GradientSample> drawGradientSamples(const FrameContext& context, const Image& direct,
                                                const Image& indirect);

/// Projects the samples of the frame before to where their surface points are now, keeps those that the camera still
/// sees, at most one a stratum of the present frame, and shades them with their old random numbers. `stopped` is set if
/// so.
std::vector<ReshadedSample> reshade(const FrameContext& context, const std::vector<GradientSample>& samples,
                                    bool& stopped);

/// What these read.
inline SignalSet gradientSignals() {
    return {Signal::Surface, Signal::ObjectId, Signal::InverseDepth, Signal::DepthGradient};
}

}  // namespace lumi
