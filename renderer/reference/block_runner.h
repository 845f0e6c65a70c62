#pragma once
#include <functional>

#include "base/timer.h"
#include "reference/block_tracer.h"
#include "reference/reference_file.h"

namespace lumi {

/// Adds samples to a state, and keeps what is done now and then.
class BlockRunner {
public:
    /// `save` (may be empty) keeps `state` as it stands; it is called every few seconds, less often where that takes
    /// long, and when the run is stopped.
    BlockRunner(BlockTracer& tracer, const ReferenceOptions& options, ReferenceState& state,
                std::function<void()> save);

    /// Traces samples up to `end`, a multiple of kLeafSamples; the first one, if there are no blocks yet, is `begin`.
    /// `progress.target` is told as it is. Throws Error(Interrupted), Error(Resources) if the sums do not fit.
    void advanceTo(uint64_t begin, uint64_t end, const ReferenceProgress& progress);
    /// Throws Error(Resources) if the sums of samples up to `end` do not fit the memory limit.
    void checkMemoryFor(uint64_t end) const;
    /// What has been traced since the last save is kept.
    void save();
    bool traced() const { return traced_; }

private:
    std::vector<SampleRange> nextRanges(uint64_t begin, uint64_t end) const;
    [[noreturn]] void interrupted();

    BlockTracer& tracer_;
    const ReferenceOptions& options_;
    ReferenceState& state_;
    std::function<void()> save_;
    Timer sinceSave_;
    double saveMs_ = 0;
    bool unsaved_ = false, traced_ = false;
};

}  // namespace lumi
