#pragma once
#include "filter/demodulation.h"
#include "filter/temporal.h"
#include "reconstruct/antialiasing_pass.h"
#include "reconstruct/captured_taps.h"

namespace lumi {

/// A method that filters a frame's lighting in screen space, with the history of the frame before: demodulates the
/// lighting, lets filter() make an image of it, antialiases that. It owns what such methods have in common, and keeps
/// the transaction that Module asks for: history, taps and antialiasing advance together, or not at all.
class ScreenFilter : public Module {
public:
    void resize(Extent2 extent) final;
    void forget() override;
    RunResult run(const FrameContext& context, Image& out) final;
    int64_t droppedPixels() const final { return dropped_; }
    std::span<const Tap> taps() const final { return taps_.declared(); }
    const Image& tap(const std::string& name) const final;
    Lineage lineage() const final { return lineage_; }
    bool keepsHistory(const Changes& changes) const final {
        return (accumulates() || antialiasing_.enabled()) && !changes.cut;
    }
    size_t byteCount() const override;

protected:
    using Step = FrameHistory<TemporalHistory>::Step;

    /// `taps`: the method's own; `dropped` is every method's. `antialiased`: the default of the parameter `taa`.
    ScreenFilter(std::vector<Tap> taps, bool antialiased);

    /// From frame() to the scene-linear image. Writes the whole of step.next, or leaves it empty if the method keeps no
    /// history. Returns false if stopped.
    virtual bool filter(const FrameContext& context, const Step& step, Image& out) = 0;
    /// Does filter() keep history, with the present parameters? That of the antialiasing pass is kept beside it.
    virtual bool accumulates() const { return true; }
    /// The run is complete: a method with history of its own commits it.
    virtual void commit() {}

    /// What run() reads beside what filter() does.
    SignalSet commonSignals() const { return demodulationSignals() | antialiasing_.reads(); }
    /// The parameters of the antialiasing pass; the last of a method.
    void describeAntialiasing(ParameterVisitor& v) { antialiasing_.describe(v); }

    Extent2 extent() const { return extent_; }
    DemodulatedFrame& frame() { return frame_; }
    CapturedTaps& captured() { return taps_; }
    /// Where filter() writes the rows of the pixel that is asked about; null: none is.
    Lineage* inspected() { return pendingLineage_.pixel.x >= 0 ? &pendingLineage_ : nullptr; }

private:
    Extent2 extent_;
    DemodulatedFrame frame_;
    FrameHistory<TemporalHistory> history_;
    AntialiasingPass antialiasing_;
    CapturedTaps taps_;
    Lineage lineage_, pendingLineage_;
    int64_t dropped_ = 0;
};

/// The taps of filterTemporally(): `reprojection` and `refusals`, its verdicts, and `historyLength`.
std::vector<Tap> temporalTaps();
/// Where the verdicts go, for those who want them.
VerdictImages verdictImages(CapturedTaps& taps);
/// The frame's dropped pixels and the taps, for filterTemporally().
TemporalOptions temporalOptions(const DemodulatedFrame& frame, CapturedTaps& taps);
/// The taps of a frame whose history nobody looked for.
void keepNoHistory(CapturedTaps& taps, Extent2 extent);

/// Temporal accumulation before another filter, as [Schied17, sec. 5.1] augments the methods it compares with: direct
/// and indirect light together, and the parameter `temporal` that switches it off.
class AccumulatedInput {
public:
    AccumulatedInput() { settings_.moments = false; }
    SignalSet reads() const { return enabled_ ? reprojectionSignals() : SignalSet{}; }
    void describe(ParameterVisitor& v);
    bool enabled() const { return enabled_; }
    /// The light of `frame`, integrated if that is switched on; `next` is left empty if not. Null if stopped.
    const Image* integrate(const FrameContext& context, const DemodulatedFrame& frame, const TemporalHistory* previous,
                           TemporalHistory& next, CapturedTaps& taps, Lineage* lineage);
    size_t byteCount() const { return sum_.bytes(); }

private:
    bool enabled_ = true;
    TemporalSettings settings_;
    Image sum_;
};

}  // namespace lumi
