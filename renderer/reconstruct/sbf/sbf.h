#pragma once
#include "filter/cross_bilateral.h"
#include "reconstruct/screen_filter.h"

namespace lumi {

/// SURE-based filtering [Li12]: a bank of cross-bilateral filters, of which each pixel takes the one with the least
/// error by Stein's unbiased risk estimate; on direct and indirect illumination together, demodulated, with temporal
/// accumulation before it or without: the baseline of [Schied17, sec. 5.1].
///
/// Differs from the paper:
/// - No adaptive sampling, and the variance of a pixel is estimated from a window, there being one sample in each
///   ([Schied17, sec. 5.1]).
/// - Features are free of noise, so that their distances are not normalised by their variance (as its authors advise).
/// - sigma_r is a number of standard deviations of the pixel, where the paper has it infinite or scaled by hand.
/// - Depth is compared as a part of itself, so that no scene's unit matters.
class SbfModule : public ScreenFilter {
public:
    SbfModule();
    SignalSet reads() const override { return commonSignals() | input_.reads() | sureSignals(); }
    void describe(ParameterVisitor&) override;
    size_t byteCount() const override;

private:
    bool accumulates() const override { return input_.enabled(); }
    bool filter(const FrameContext&, const Step&, Image& out) override;

    AccumulatedInput input_;
    SureSettings settings_;
    SureBank bank_;
    Image filtered_;
};

}  // namespace lumi
