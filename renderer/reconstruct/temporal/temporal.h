#pragma once
#include "reconstruct/screen_filter.h"

namespace lumi {

/// Geometry-validated temporal accumulation alone [Schied17, sec. 4.1]: what SVGF makes of a frame before it filters in
/// space. Direct and indirect light are integrated together, demodulated.
///
/// Differs from the paper: nowhere beyond filter/temporal.h.
class TemporalModule : public ScreenFilter {
public:
    TemporalModule();
    SignalSet reads() const override { return commonSignals() | reprojectionSignals(); }
    void describe(ParameterVisitor&) override;
    size_t byteCount() const override { return ScreenFilter::byteCount() + sum_.bytes(); }

private:
    bool filter(const FrameContext&, const Step&, Image& out) override;

    TemporalSettings settings_;
    Image sum_;
};

}  // namespace lumi
