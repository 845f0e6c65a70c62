#pragma once
#include "reconstruct/stable/sample_frame.h"
#include "trace/tracer.h"

namespace lumi {

/// Samples of whole pixels whose rays are traced together: all that is needed between making them and keeping their light,
/// so that they pass memory once. Vectors by slot have a value for each sample, in the order of pixels.
struct SampleBatch {
    static constexpr uint32_t kIdle = ~0u;  ///< slot of a ray that is not there
    static constexpr size_t kMost = 1024;   ///< starts, and samples: as many as the tracer keeps together

    struct Pixel {
        uint32_t pixel = 0, slot = 0;  ///< and the slot of its first sample
    };
    size_t pixelCount = 0, sampleCount = 0, startCount = 0;
    Pixel pixels[kMost];      ///< that have samples
    uint32_t samples[kMost];  ///< by slot: index in the set
    Vec3 inWorld[kMost];      ///< by slot: position, or direction into the sky; not set for new ones
    float distances[kMost];   ///< by slot; of samples with a start
    uint16_t startOf[kMost];  ///< by slot; of samples with a start
    PathStart starts[kMost];
    Vec3 radiance[kMost];                     ///< by start
    Vec3 direct[kMost], diffuseShare[kMost];  ///< by slot

    void clear() { pixelCount = sampleCount = startCount = 0; }
};

}  // namespace lumi
