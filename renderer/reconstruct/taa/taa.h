#pragma once
#include "filter/taa.h"
#include "frame/history.h"
#include "reconstruct/captured_taps.h"

namespace lumi {

/// Temporal antialiasing alone, on the raw frame [Karis14]; see filter/taa.h.
class TaaModule : public Module {
public:
    SignalSet reads() const override { return SignalSet{Signal::Noisy} | taaSignals(); }
    Jitter preferredJitter() const override { return Jitter::PerFrame; }
    void describe(ParameterVisitor& v) override { settings_.describe(v); }
    void resize(Extent2 extent) override;
    void forget() override;
    RunResult run(const FrameContext&, Image& out) override;
    std::span<const Tap> taps() const override { return taps_.declared(); }
    const Image& tap(const std::string& name) const override;
    int64_t droppedPixels() const override { return dropped_; }
    size_t byteCount() const override;

private:
    Extent2 extent_;
    TaaSettings settings_;
    FrameHistory<Image> history_;
    Image scratch_;
    int64_t dropped_ = 0;
    CapturedTaps taps_{{droppedTap()}};
};

}  // namespace lumi
