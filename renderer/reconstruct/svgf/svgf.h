#pragma once
#include <algorithm>

#include "filter/atrous.h"
#include "reconstruct/screen_filter.h"

namespace lumi {

/// Spatiotemporal variance-guided filtering [Schied17]: direct and indirect illumination of one path a pixel, each
/// demodulated by the first surface's albedo, are integrated over time along motion vectors (sec. 4.1), their luminance
/// variance is estimated from the integrated moments or, where history is short, from the neighbourhood (sec. 4.2), and
/// that variance steers five levels of an edge-avoiding à-trous wavelet transform (sec. 4.3, 4.4). The first level's
/// output is the next frame's colour history.
///
/// Differs from the paper:
/// - Eq. 3 works on 1/depth in place of clip-space depth; both are affine on a plane in screen space. Under an
///   orthographic camera depth itself is, and takes its place (filter/orthographic_guide.h).
/// - The second moment is kept about the mean (filter/temporal.h): the same variance with more digits.
/// - The 3x3 fall-back's weights, which the paper does not state, are equal.
/// - Fig. 3 feeds colour *and* moments of the first level back, sec. 4.3 colour alone: the moments stay unfiltered.
/// - Values that are not finite are dropped and counted before anything reads them: with a history such a sample counts
///   nothing, without one its neighbours' mean stands in.
/// - Antialiasing runs on linear light at the scene's exposure that Karis's weights compress, before the tone curve,
///   which is the view's; the paper tone maps first (sec. 3).
/// - A bilinear tap of weight 0 is neither tested nor given the share of a refused one (kTapUnused): where nothing
///   moves there is one tap, and where that is refused the 3x3 fall-back, or without it the history, is lost.
/// - Path-space regularization (path.regularize) follows diffuse scatterings; the paper's follows any, which is
///   path.regularize-after.
///
/// With its antialiasing on, as it is by default, still detail that stands out of its 3x3 pixels by more than
/// taa-clip-gamma deviations is clipped with the history: that light without noise passes unchanged holds of the filter
/// alone.
///
/// What it leaves, as sec. 6 says of aliased geometry: single bright pixels on ribs, pots and leaves that turn within a
/// few pixels. Eq. 4 refuses every neighbour there, at every level, so that a pixel has but its own history to lean on:
/// on the atrium's vault 13 pixels of 480x270 are three times their surroundings after 24 frames; 6 with a sigma_n of
/// 32, 1 with 8, 28 without the variance prefilter. Their histories are whole, and their albedos are like others'.
class SvgfModule : public ScreenFilter {
public:
    enum class DepthWeight { AsPrinted, PlaneDistance };
    enum class VarianceSource { Spatiotemporal, Spatial };

    SvgfModule();
    SignalSet reads() const override;
    void describe(ParameterVisitor&) override;
    size_t byteCount() const override;

    static constexpr int kComponents = 2;  ///< direct, indirect
    static constexpr int kMaxLevels = 7;

protected:
    /// Of a relative with buffers of its own beside SVGF's.
    explicit SvgfModule(const std::vector<Tap>& own);
    /// How much of its history each component is to give up (filter/temporal.h); left empty, as here: none. Called once
    /// a run, before the temporal filter. Returns false if stopped.
    virtual bool estimateLoss(const FrameContext&, HistoryLoss&) { return true; }
    /// Default of the alphas of colour and moments.
    void useAlpha(float alpha) { parameters_.temporal.colourAlpha = parameters_.temporal.momentsAlpha = alpha; }

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
    SurfaceGuide surfaceGuideOf(const FrameContext&);
    bool filter(const FrameContext&, const Step&, Image& out) override;
    bool integrate(const FrameContext&, const Step&);
    void handOver(TemporalHistory& next);
    bool estimateVariance(const FrameContext&, const TemporalHistory& integrated);
    const Levels* filterSpatially(const FrameContext&);
    int feedbackLevel() const { return std::min(parameters_.feedbackLevel, parameters_.levels); }

    Parameters parameters_;
    Levels input_;      ///< of the first level: integrated colour and its variance
    Levels levels_[2];  ///< ping and pong
    Image depth_;       ///< of the guide under an orthographic camera
    Levels feedback_;   ///< of the level whose output is the next frame's colour history
};

}  // namespace lumi
