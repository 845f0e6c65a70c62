#pragma once
#include <cstdint>

#include "base/isa.h"

namespace lumi {

/// Sobol pairs of many paths at once, the same bits as SampleStream's.
struct SamplerKernels {
    /// Numbers of dimensions 2 pair and 2 pair + 1 for `count` paths, by the scramble and index of each stream. `y` may
    /// be null. `seeds` is scratch.
    void (*pairs)(const uint32_t* scramble, const uint32_t* index, int count, uint32_t pair, uint64_t* seeds, float* x,
                  float* y);
};

LUMI_KERNELS(SamplerKernels, sampler)

}  // namespace lumi
