#pragma once
#include "base/spares.h"
#include "reconstruct/stable/sample_batch.h"
#include "reconstruct/stable/shading.h"
#include "reconstruct/stable/verification.h"

namespace lumi {

/// What the samples of a frame are traced with.
struct SamplePass {
    const FrameContext& context;
    const SampleSet& previous;  ///< samples of the frame before
    const DensitySettings& density;
    const VerificationSettings& verification;
    const GatheringSettings& gathering;
    GatheringState light;
    uint32_t random = 0;  ///< names the frame
    SampleFrame& frame;   ///< numbered: see numberSamples()
    SampleSet& next;
    Spares<SampleBatch>& spare;

    /// Is direct light averaged, too, not this frame's alone?
    bool averagesDirect() const { return gathering.averageDirect || (gathering.converge && light.still); }
};

/// What verification did.
struct VerificationCounts {
    uint64_t rays = 0;   ///< that were traced
    uint64_t lanes = 0;  ///< of their packets, idle ones included
};

/// Makes, verifies and shades all samples [DalCorso17, sec. 4.3], block of pixels after block: the ray that verifies a
/// sample is the first of the path that shades it, and a sample passes memory once. Blocks are worked on in any order
/// and change nothing in each other. Returns false if stopped.
bool traceSamples(const SamplePass& pass, VerificationCounts& counts);

}  // namespace lumi
