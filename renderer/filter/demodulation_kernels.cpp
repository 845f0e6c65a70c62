#include "filter/demodulation_kernels.h"

#include <cmath>

#include "filter/combined_albedo.h"

namespace lumi::LUMI_ISA {
namespace {

constexpr float kLargest = 3.402823466e38f;
constexpr float kBrightest = kBrightestDemodulated;

inline float bounded(float v) { return v > kBrightest ? kBrightest : v < -kBrightest ? -kBrightest : v; }

void divide(const DemodulationRow& row) {
    const float* __restrict diffuse = row.diffuseAlbedo;
    const float* __restrict specular = row.specularAlbedo;
    const float* __restrict inEmission = row.inEmission;
    const float* __restrict inDirect = row.inDirect;
    const float* __restrict inIndirect = row.inIndirect;
    float* __restrict albedo = row.albedo;
    float* __restrict emission = row.emission;
    float* __restrict direct = row.direct;
    float* __restrict indirect = row.indirect;
    float* __restrict bad = row.bad;
    for (int i = 0; i < row.count; ++i) {
        const float a = combinedAlbedo(diffuse[i], specular[i]), inverse = 1.0f / a;
        const float e = inEmission[i], d = inDirect[i] * inverse, n = inIndirect[i] * inverse;
        const bool goodE = std::fabs(e) <= kLargest, goodD = std::fabs(d) <= kLargest, goodN = std::fabs(n) <= kLargest;
        albedo[i] = a;
        emission[i] = goodE ? e : 0.0f;
        direct[i] = goodD ? bounded(d) : 0.0f;
        indirect[i] = goodN ? bounded(n) : 0.0f;
        bad[i] = (goodE & goodD & goodN) ? bad[i] : 1.0f;
    }
}

void multiply(const float* __restrict emission, const float* __restrict albedo, const float* __restrict direct,
              const float* __restrict indirect, float* __restrict out, int count) {
    if (!indirect) {
        for (int i = 0; i < count; ++i) out[i] = emission[i] + albedo[i] * direct[i];
        return;
    }
    for (int i = 0; i < count; ++i) out[i] = emission[i] + albedo[i] * (direct[i] + indirect[i]);
}

}  // namespace

const DemodulationKernels& demodulationTable() {
    static const DemodulationKernels table{divide, multiply};
    return table;
}

}  // namespace lumi::LUMI_ISA
