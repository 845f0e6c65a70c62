#pragma once
#include "reconstruct/asvgf/gradient_samples.h"
#include "reconstruct/svgf/svgf.h"

namespace lumi {

/// Adaptive SVGF [Schied18]: SVGF whose temporal filter gives up as much of its history as the light has changed. One
/// sample of the previous frame in each stratum of 3x3 pixels is shaded again at its surface point of now with its
/// random numbers of then (sec. 4.1); the differences are filtered over the strata by an edge-avoiding à-trous
/// transform (sec. 4.3), and lambda = min(1, |difference| / greater of the two) moves alpha towards 1 (sec. 4.4):
///
///     alpha' = (1 - lambda) alpha + lambda
///
/// Differs from the paper:
/// - The gradient samples are extra, 1/9 of a path a pixel: all methods side by side then see identical samples. The
///   paper puts them in the place of ordinary ones.
/// - Which sample of a stratum is drawn is a hash of stratum and frame; where several land in one stratum of the
///   present frame the first in memory's order stays.
/// - Visibility of a projected sample is tested against the depth and the object of the pixel that it lands in.
/// - The strata are filtered by the 5x5 B3 spline of SVGF's wavelet with the weights of depth and normal, not
///   luminance.
/// - Direct and indirect light have a lambda each; the history's length shrinks by the larger, so that variance comes
///   from the neighbourhood again where history was given up.
class AsvgfModule : public SvgfModule {
public:
    AsvgfModule();
    SignalSet reads() const override { return SvgfModule::reads() | gradientSignals(); }
    void describe(ParameterVisitor&) override;
    void forget() override;
    size_t byteCount() const override;

private:
    bool estimateLoss(const FrameContext&, HistoryLoss& loss) override;
    void commit() override { samples_.commit(); }
    bool filterStrata(const FrameContext&, const std::vector<ReshadedSample>& samples);
    void keepTaps(const std::vector<ReshadedSample>& samples);

    int levels_ = 5;
    float strength_ = 1;
    FrameHistory<std::vector<GradientSample>> samples_;
    Image guide_;                ///< of the strata: inverse depth, its slopes, normal
    Illumination strata_[2][2];  ///< ping and pong; per component R: difference, G: greater of the two
    Image loss_[2];              ///< lambda of direct and indirect
};

}  // namespace lumi
