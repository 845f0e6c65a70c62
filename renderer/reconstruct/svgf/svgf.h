#pragma once
#include "filter/atrous.h"
#include "filter/demodulation.h"
#include "filter/temporal.h"
#include "reconstruct/antialiasing_pass.h"
#include "reconstruct/svgf/svgf_taps.h"

namespace lumi {

/// Spatiotemporal variance-guided filtering [Schied17]: direct and indirect illumination of one path a pixel, each
/// demodulated by the first surface's albedo, are integrated over time along motion vectors (sec. 4.1), their luminance
/// variance is estimated from the integrated moments or, where history is short, from the neighbourhood (sec. 4.2), and
/// that variance steers five levels of an edge-avoiding à-trous wavelet transform (sec. 4.3, 4.4). The first level's
/// output is the next frame's colour history.
///
/// Differs from the paper:
/// - Eq. 3 works on 1/depth in place of clip-space depth; both are affine on a plane in screen space.
/// - The second moment is kept about the mean (filter/temporal.h): the same variance with more digits.
/// - The 3x3 fall-back's weights, which the paper does not state, are equal.
/// - Fig. 3 feeds colour *and* moments of the first level back, sec. 4.3 colour alone: the moments stay unfiltered.
/// - Values that are not finite are dropped and counted before anything reads them.
class SvgfModule : public Module {
public:
    enum class DepthWeight { AsPrinted, PlaneDistance };
    enum class VarianceSource { Spatiotemporal, Spatial };

    SvgfModule();
    SignalSet reads() const override;
    Jitter preferredJitter() const override { return Jitter::PerFrame; }
    void describe(ParameterVisitor&) override;
    void resize(Extent2 extent) override;
    void forget() override;
    RunResult run(const FrameContext&, Image& out) override;
    std::span<const Tap> taps() const override { return taps_.declared(); }
    const Image& tap(const std::string& name) const override;
    size_t byteCount() const override;

    static constexpr int kComponents = 2;  ///< direct, indirect
    static constexpr int kMaxLevels = 7;

private:
    struct Parameters {
        TemporalSettings temporal;
        VarianceSource varianceSource = VarianceSource::Spatiotemporal;
        int spatialVarianceFrames = 4;
        int levels = 5;
        int feedbackLevel = 1;
        DepthWeight depthWeight = DepthWeight::AsPrinted;
        AtrousSettings atrous;
    };
    using Levels = std::array<Illumination, kComponents>;

    AtrousSettings atrousSettings() const;
    bool integrate(const FrameContext&, const TemporalHistory* previous, TemporalHistory& next);
    bool estimateVariance(const FrameContext&, const TemporalHistory& integrated);
    const Levels* filterSpatially(const FrameContext&, TemporalHistory& next);

    Extent2 extent_;
    Parameters parameters_;
    AntialiasingPass antialiasing_{true};
    FrameHistory<TemporalHistory> history_;
    DemodulatedFrame frame_;
    Levels input_;          ///< of the first level: integrated colour and its variance
    Levels levels_[2];      ///< ping and pong
    SvgfTaps taps_;
};

}  // namespace lumi
