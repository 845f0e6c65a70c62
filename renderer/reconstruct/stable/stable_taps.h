#pragma once
#include "reconstruct/module.h"
#include "reconstruct/stable/sample_frame.h"

namespace lumi {

/// The taps of stable ray tracing.
std::vector<Tap> stableTaps();

/// Draws the 4 x 4 sub-pixels of the pixels around the middle [DalCorso17, fig. 6], each as a pixel of `out`, whose
/// extent is that of the samples: visible samples blue, occluded ones red, empty sub-pixels in two greys, a pixel each.
void drawSubpixels(const SampleSet& samples, Image& out);

}  // namespace lumi
