#include "trace/sampler_kernels.h"

#include "trace/sobol.h"

namespace lumi::LUMI_ISA {
namespace {

inline float unitOf(uint32_t bits24) { return static_cast<float>(static_cast<int32_t>(bits24)) * 0x1p-24f; }

void pairs(const uint32_t* __restrict scramble, const uint32_t* __restrict index, int count, uint32_t pair,
           uint64_t* __restrict seeds, float* __restrict x, float* __restrict y) {
    for (int i = 0; i < count; ++i) seeds[i] = sobolSeeds(scramble[i], pair);
    if (!y) {
        for (int i = 0; i < count; ++i) {
            const auto seedX = static_cast<uint32_t>(seeds[i]), seedY = static_cast<uint32_t>(seeds[i] >> 32);
            x[i] = unitOf(sobolX(sobolShuffled(index[i], seedX, seedY), seedX));
        }
        return;
    }
    for (int i = 0; i < count; ++i) {
        const auto seedX = static_cast<uint32_t>(seeds[i]), seedY = static_cast<uint32_t>(seeds[i] >> 32);
        const uint32_t shuffled = sobolShuffled(index[i], seedX, seedY);
        x[i] = unitOf(sobolX(shuffled, seedX));
        y[i] = unitOf(sobolY(shuffled, seedY));
    }
}

}  // namespace

const SamplerKernels& samplerTable() {
    static const SamplerKernels table{pairs};
    return table;
}

}  // namespace lumi::LUMI_ISA
