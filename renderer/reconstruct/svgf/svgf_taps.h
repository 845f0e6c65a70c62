#pragma once
#include "filter/atrous.h"
#include "filter/demodulation.h"
#include "filter/temporal.h"
#include "reconstruct/captured_taps.h"

namespace lumi {

/// The intermediate buffers of SVGF, from the demodulated input to each level of the wavelet transform.
std::vector<Tap> svgfTaps(int maxLevels);

void keepInput(CapturedTaps& taps, const DemodulatedFrame& frame);
void keepIntegrated(CapturedTaps& taps, const TemporalHistory& integrated);
/// Colour and variance after `level` (0: before the first). `indirect` false: the direct component.
void keepLevel(CapturedTaps& taps, int level, bool indirect, const Illumination& planes);
/// Eqs. 3 to 5 of the first level, each as the mean weight of the eight neighbours.
void keepEdgeWeights(CapturedTaps& taps, const SurfaceGuide& guide, const AtrousSettings& settings,
                     const Illumination& direct, const Illumination& indirect);

}  // namespace lumi
