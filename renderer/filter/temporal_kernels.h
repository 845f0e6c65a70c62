#pragma once
#include <cstdint>

#include "base/isa.h"

namespace lumi {

/// The taps of a row of pixels in the previous frame's planes. Weights of a pixel sum to 1, or are all 0: it has no
/// history.
struct HistoryTaps {
    static constexpr int kMost = 9;
    int taps = 0;         ///< 0 (there is no previous frame), 4 or 9
    bool inARow = false;  ///< each index is one more than that of the pixel before
    const int32_t* index[kMost];
    const float* weight[kMost];
};

/// The first `count` pixels of a row: the length of their history and how much the new sample counts.
struct HistoryLengthRow {
    int count = 0;
    HistoryTaps taps;
    const float* previousLength = nullptr;  ///< plane
    const uint32_t* object = nullptr;       ///< 0: sky
    float colourAlpha = 1, momentsAlpha = 1, longest = 0;
    bool arithmeticWarmUp = false;
    float* length = nullptr;
    float* colourAlphas = nullptr;
    float* momentsAlphas = nullptr;
};

/// The first `count` pixels of one component's row.
struct IntegrationRow {
    int count = 0;
    HistoryTaps taps;
    const float* previousColour[3];  ///< planes
    const float* previousMean = nullptr;
    const float* previousVariance = nullptr;
    const float* sample[3];
    const float* colourAlphas = nullptr;
    const float* momentsAlphas = nullptr;
    float* colour[3];
    float* mean = nullptr;  ///< null: no moments
    float* variance = nullptr;
    float* luminance = nullptr;  ///< of the integrated colour; null: nobody wants it
};

struct TemporalKernels {
    void (*lengthRow)(const HistoryLengthRow& row);
    /// C' = alpha C + (1 - alpha) C'(i-1), and the same for the moments about the mean.
    void (*integrateRow)(const IntegrationRow& row);
    /// a' = a + (1 - a) lambda.
    void (*adaptRow)(const float* lambda, const float* alphas, float* adapted, int count);
};

LUMI_KERNELS(TemporalKernels, temporal)

}  // namespace lumi
