#pragma once
#include <functional>
#include <span>
#include <stop_token>

#include "reference/reference.h"
#include "reference/sample_blocks.h"
#include "trace/tracer.h"

namespace lumi {

/// Traces samples of one spec. The scene is posed and built when the first ray needs it.
class BlockTracer {
public:
    explicit BlockTracer(const ReferenceSpec& spec) : spec_(spec) {}

    /// One leaf; false if stopped.
    bool traceLeaf(uint64_t first, SampleBlock& out, std::stop_token stop);
    /// An aligned block of any size, leaf by leaf; false if stopped.
    bool traceBlock(SampleRange range, SampleBlock& out, std::stop_token stop);
    /// Sum of fewer samples than a leaf has; false if stopped.
    bool traceSum(SampleRange range, ImageOf<double>& out, std::stop_token stop);
    /// View depth of the first sample of each pixel.
    Image traceDepth();

    const ReferenceSpec& spec() const { return spec_; }

private:
    bool sample(SampleRange range, const SignalSet& wanted, Signals& signals, std::stop_token stop);

    const ReferenceSpec spec_;
    Tracer tracer_;
    bool bound_ = false;
};

/// Several tracers that share the work on one reference. What each traces does not change any bit.
class BlockTeam {
public:
    virtual ~BlockTeam() = default;
    virtual int size() const = 0;
    /// Traces up to size() aligned blocks, the first of them with `own`, and hands them to `take` in order. False if
    /// stopped; then `take` got those before the first that is not whole.
    virtual bool trace(BlockTracer& own, std::span<const SampleRange> ranges,
                       const std::function<void(SampleBlock)>& take, std::stop_token stop) = 0;
    /// The present image is done with; what comes is of another tracer.
    virtual void nextImage() = 0;
};

}  // namespace lumi
