#pragma once
#include "filter/demodulation.h"
#include "filter/temporal.h"
#include "reconstruct/antialiasing_pass.h"
#include "reconstruct/captured_taps.h"

namespace lumi {

/// Geometry-validated temporal accumulation alone [Schied17, sec. 4.1]: what SVGF makes of a frame before it filters in
/// space. Direct and indirect light are integrated together, demodulated.
///
/// Differs from the paper: nowhere beyond filter/temporal.h.
class TemporalModule : public Module {
public:
    TemporalModule();
    SignalSet reads() const override;
    Jitter preferredJitter() const override { return Jitter::PerFrame; }
    void describe(ParameterVisitor&) override;
    void resize(Extent2 extent) override;
    void forget() override;
    RunResult run(const FrameContext&, Image& out) override;
    std::span<const Tap> taps() const override { return taps_.declared(); }
    const Image& tap(const std::string& name) const override;
    size_t byteCount() const override;

private:
    Extent2 extent_;
    TemporalSettings settings_;
    AntialiasingPass antialiasing_{false};
    FrameHistory<TemporalHistory> history_;
    DemodulatedFrame frame_;
    CapturedTaps taps_;
};

}  // namespace lumi
