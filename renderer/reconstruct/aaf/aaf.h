#pragma once
#include "reconstruct/aaf/emitters.h"
#include "reconstruct/screen_filter.h"

namespace lumi {

/// Axis-aligned filtering of soft shadows [Mehta12], for direct light: a Gaussian on the surface, as wide as the
/// sharpest penumbra there allows, of standard deviation
///
///     beta = sigma (d1/d2max - 1) / k
///
/// with the light's standard deviation sigma, its distance d1 from the surface and the greatest distance d2max from a
/// blocker; applied in two passes, along rows and along columns. Indirect light is only accumulated over time.
///
/// Differs from the paper:
/// - One shadow ray a pixel: d2max comes from a window, and is accumulated over time as visibility is ([Schied17, sec.
///   5.1]).
/// - No adaptive sampling.
/// - What is filtered is demodulated direct light, visibility times irradiance, since one random point of the light
///   tells no irradiance free of noise.
/// - So irradiance is noise that [Mehta12], which filters visibility alone, does not have: where the window holds no
///   blocker nothing is blurred, and that noise stays, but for what accumulation takes.
/// - sigma is measured from the points that the frame sampled on the light; lights of any kind are taken so, each for
///   itself. The triangles of a mesh that shines are one light where they hang together.
/// - The blockers are found by sending the frame's shadow rays once more (trace/tracer.h, shade()).
class AafModule : public ScreenFilter {
public:
    AafModule();
    SignalSet reads() const override;
    void describe(ParameterVisitor&) override;
    size_t byteCount() const override;

private:
    bool accumulates() const override { return temporal_; }
    bool filter(const FrameContext&, const Step&, Image& out) override;
    bool integrate(const FrameContext&, const Step&);
    void chooseWidths(const Image& occlusion);
    void blur(const Signals& signals, const CameraPose& camera, bool alongRows, const Image& in, Image& out) const;

    bool temporal_ = true;
    TemporalSettings temporalSettings_;
    int windowRadius_ = 4, maxRadius_ = 32;
    float overlap_ = 3;  ///< k
    Emitters emitters_;
    Image measured_, occlusion_, width_;
    Image half_, filtered_;
};

}  // namespace lumi
