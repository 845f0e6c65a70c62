#pragma once
#include "filter/demodulation.h"
#include "filter/edge_avoiding.h"
#include "filter/temporal.h"
#include "reconstruct/antialiasing_pass.h"
#include "reconstruct/captured_taps.h"

namespace lumi {

/// Edge-avoiding à-trous wavelets [Dammertz10], SVGF's main baseline, on direct and indirect illumination together,
/// demodulated by the first surface's albedo; with temporal accumulation before it as [Schied17, sec. 5.1] augments it,
/// or without, as its authors run it.
///
/// Differs from the paper: see filter/edge_avoiding.h.
class EawModule : public Module {
public:
    EawModule();
    SignalSet reads() const override;
    Jitter preferredJitter() const override { return Jitter::PerFrame; }
    void describe(ParameterVisitor&) override;
    void resize(Extent2 extent) override;
    void forget() override;
    RunResult run(const FrameContext&, Image& out) override;
    std::span<const Tap> taps() const override { return taps_.declared(); }
    const Image& tap(const std::string& name) const override;
    bool keepsHistory(const Changes& changes) const override { return temporal_ && !changes.cut; }
    size_t byteCount() const override;

    static constexpr int kMaxLevels = 7;

private:
    bool integrate(const FrameContext&);
    const Image* filterSpatially(const FrameContext&);

    Extent2 extent_;
    bool temporal_ = true;
    TemporalSettings temporalSettings_;
    int levels_ = 5;
    EdgeAvoidingSettings edges_;
    AntialiasingPass antialiasing_{false};
    FrameHistory<TemporalHistory> history_;
    DemodulatedFrame frame_;
    Image input_, planes_[2];
    CapturedTaps taps_;
};

}  // namespace lumi
