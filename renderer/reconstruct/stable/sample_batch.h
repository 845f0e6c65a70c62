#pragma once
#include "reconstruct/stable/sample_frame.h"
#include "trace/tracer.h"

namespace lumi {

/// Samples of whole pixels whose rays are traced together: all that is needed between making them and keeping their
/// light, so that they pass memory once. Vectors by slot have a value for each sample, in the order of pixels.
struct SampleBatch {
    static constexpr uint32_t kIdle = ~0u;  ///< slot of a ray that is not there
    static constexpr size_t kMost = 1024;   ///< starts, and samples: as many as the tracer keeps together

    /// Neighbouring pixels of a row; their samples follow each other in the set and in the batch.
    struct Run {
        uint32_t pixel = 0, count = 0;
        uint32_t slot = 0;  ///< of its first sample
    };
    size_t runCount = 0, sampleCount = 0, startCount = 0;
    Run runs[kMost];
    uint32_t samples[kMost];  ///< by slot: index in the set
    float distances[kMost];   ///< by slot; of samples with a start
    uint16_t startOf[kMost];  ///< by slot; of samples with a start
    PathStart starts[kMost];
    Vec3 radiance[kMost];                     ///< by start
    Vec3 direct[kMost], diffuseShare[kMost];  ///< by slot

    void clear() { runCount = sampleCount = startCount = 0; }
};

}  // namespace lumi
