#pragma once
#include "reconstruct/accumulate/image_block_sum.h"
#include "reconstruct/module.h"

namespace lumi {

/// The progressive mean of all samples since the last reset: the reference that every method is measured against.
///
/// The mean of N samples has the same bits whether they came as one frame of N samples a pixel, as N frames of one, or
/// as any aligned split in between: sums are in double over aligned power-of-two blocks (image_block_sum.h,
/// math/block_sum.h). NaN and infinity stay in their pixel.
class AccumulateModule : public Module {
public:
    enum class Reset { AnyChange, CutOnly };

    AccumulateModule();
    SignalSet reads() const override { return {Signal::Noisy, Signal::SampleVariance}; }
    Jitter preferredJitter() const override { return Jitter::PerPixel; }
    void describe(ParameterVisitor&) override;
    void resize(Extent2 extent) override;
    void forget() override;
    RunResult run(const FrameContext&, Image& out) override;
    std::span<const Tap> taps() const override { return taps_; }
    const Image& tap(const std::string& name) const override;
    Convergence convergence() const override;
    bool keepsHistory(const Changes& changes) const override { return !resets(changes); }
    size_t byteCount() const override;

private:
    /// Sum of squared deviations of the samples from their mean, a channel each, with the sum of the samples.
    struct Moments {
        uint64_t samples = 0;
        ImageOf<double> sum, squares;
    };
    /// One frame as it came in, not yet part of the history: a run with the same number replaces it.
    struct Step {
        FrameNumber frame = -1;
        uint64_t samples = 0;
        bool reset = false;    ///< the history before it does not count
        bool counted = false;  ///< false: the limit had been reached before
        ImageOf<double> sum;
        Image sampleVariance;
    };

    bool resets(const Changes& changes) const;
    void commitLastStep();
    void writeTaps(const TapSet& wanted);
    void writeStandardError();

    Extent2 extent_;
    ImageBlockSum blocks_;
    Moments history_;  ///< of all committed steps
    Step last_;
    std::vector<Tap> taps_;
    Image sampleCount_, standardError_;

    bool limited_ = false;
    int maxSamples_ = 1024;
    Reset reset_ = Reset::AnyChange;
};

}  // namespace lumi
