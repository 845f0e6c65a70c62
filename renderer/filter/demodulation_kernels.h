#pragma once
#include "base/isa.h"

namespace lumi {

/// Demodulated light is at most this: squares of it, and sums of those, are still numbers.
constexpr float kBrightestDemodulated = 1e15f;

/// One channel of a stretch of pixels; see filter/demodulation.h.
struct DemodulationRow {
    int count = 0;
    const float* diffuseAlbedo = nullptr;
    const float* specularAlbedo = nullptr;
    const float* inEmission = nullptr;
    const float* inDirect = nullptr;
    const float* inIndirect = nullptr;
    float* albedo = nullptr;
    float* emission = nullptr;
    float* direct = nullptr;
    float* indirect = nullptr;
    float* bad = nullptr;  ///< set to 1 where a value was not finite, else left
};

struct DemodulationKernels {
    void (*divide)(const DemodulationRow& row);
    /// out = emission + albedo * (direct + indirect); `indirect` may be null.
    void (*multiply)(const float* emission, const float* albedo, const float* direct, const float* indirect, float* out,
                     int count);
};

LUMI_KERNELS(DemodulationKernels, demodulation)

}  // namespace lumi
