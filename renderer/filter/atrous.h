#pragma once
#include <stop_token>
#include <vector>

#include "filter/edge_stopping.h"
#include "filter/surface_guide.h"

namespace lumi {

/// One illumination component at one level: planar RGB, and luminance and its sample variance a pixel.
struct Illumination {
    Image rgb;             ///< 3 channels
    Image luminance;       ///< 1 channel
    Image sampleVariance;  ///< 1 channel, of luminance: that of one sample, not of the integrated colour

    void reset(Extent2 extent);
    size_t bytes() const { return rgb.bytes() + luminance.bytes() + sampleVariance.bytes(); }
};

struct AtrousSettings {
    EdgeStopping edges;
    bool variancePrefilter = true;  ///< the 3x3 Gaussian of eq. 5
};

/// One level of the edge-avoiding à-trous wavelet transform [Schied17, sec. 4.3; Dammertz10]: eq. 1 over a 5x5 B3
/// spline with `step` pixels between its taps, and the variance of its result. All components share the geometric
/// weights. `in` and `out` must not overlap. Returns false if stopped; `out` is then undefined.
bool atrousLevel(const SurfaceGuide& guide, const AtrousSettings& settings, int step,
                 const std::vector<const Illumination*>& in, const std::vector<Illumination*>& out,
                 std::stop_token stop);

/// One component's luminance moments, planes of one channel.
struct MomentPlanes {
    const float* mean;      ///< first moment
    const float* centred;   ///< second moment about it
    float* sampleVariance;  ///< what is estimated
};

/// Variance where the history is shorter than `minLength` frames, from a 7x7 window weighted by depth and world-space
/// normals [Schied17, sec. 4.2]; where the history is long enough `sampleVariance` becomes `centred`. All components
/// (at most two) share their weights. Returns false if stopped.
bool estimateVarianceSpatially(const SurfaceGuide& guide, const EdgeStopping& edges, const float* historyLength,
                               float minLength, const std::vector<MomentPlanes>& components, std::stop_token stop);

}  // namespace lumi
