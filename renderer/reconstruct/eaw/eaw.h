#pragma once
#include "filter/edge_avoiding.h"
#include "reconstruct/screen_filter.h"

namespace lumi {

/// Edge-avoiding à-trous wavelets [Dammertz10], SVGF's main baseline, on direct and indirect illumination together,
/// demodulated by the first surface's albedo; with temporal accumulation before it as [Schied17, sec. 5.1] augments it,
/// or without, as its authors run it.
///
/// Differs from the paper: see filter/edge_avoiding.h.
class EawModule : public ScreenFilter {
public:
    EawModule();
    SignalSet reads() const override;
    void describe(ParameterVisitor&) override;
    size_t byteCount() const override;

    static constexpr int kMaxLevels = 7;

private:
    bool accumulates() const override { return input_.enabled(); }
    bool filter(const FrameContext&, const Step&, Image& out) override;

    AccumulatedInput input_;
    int levels_ = 5;
    EdgeAvoidingSettings edges_;
    Image planes_[2];
};

}  // namespace lumi
