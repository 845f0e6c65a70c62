#include "filter/temporal_kernels.h"

namespace lumi::LUMI_ISA {
namespace {

/// A plane's value at the k-th tap of pixel x.
template <bool InARow>
inline float tapOf(const float* plane, const HistoryTaps& taps, int k, int x) {
    if constexpr (InARow) return plane[taps.index[k][0] + x];
    return plane[taps.index[k][x]];
}

template <int Taps, bool InARow>
void lengths(const HistoryLengthRow& row) {
    const float* __restrict previous = row.previousLength;
    const uint32_t* __restrict object = row.object;
    float* __restrict length = row.length;
    float* __restrict colour = row.colourAlphas;
    float* __restrict moments = row.momentsAlphas;
    const float warmUp = row.arithmeticWarmUp ? 1.0f : 0.0f, longest = row.longest;
    for (int x = 0; x < row.count; ++x) {
        float sum = 0, weights = 0;
        for (int k = 0; k < Taps; ++k) {
            const float weight = row.taps.weight[k][x];
            sum += weight * tapOf<InARow>(previous, row.taps, k, x);
            weights += weight;
        }
        sum += 1.0f;
        sum = sum < longest ? sum : longest;
        length[x] = object[x] == 0 ? 0.0f : sum;
        const float least = object[x] == 0 ? 0.0f : warmUp / sum;
        const float a = row.colourAlpha > least ? row.colourAlpha : least,
                    b = row.momentsAlpha > least ? row.momentsAlpha : least;
        colour[x] = weights > 0.0f ? a : 1.0f;
        moments[x] = weights > 0.0f ? b : 1.0f;
    }
}

void lengthRow(const HistoryLengthRow& row) {
    switch (row.taps.taps) {
        case 0: return lengths<0, false>(row);
        case 4: return row.taps.inARow ? lengths<4, true>(row) : lengths<4, false>(row);
        default: return lengths<9, false>(row);
    }
}

template <int Taps, bool InARow>
void integrateColour(const IntegrationRow& row, int channel) {
    const float* __restrict previous = row.previousColour[channel];
    const float* __restrict sample = row.sample[channel];
    const float* __restrict alpha = row.colourAlphas;
    float* __restrict out = row.colour[channel];
    for (int x = 0; x < row.count; ++x) {
        float past = 0;
        for (int k = 0; k < Taps; ++k) past += row.taps.weight[k][x] * tapOf<InARow>(previous, row.taps, k, x);
        out[x] = past + alpha[x] * (sample[x] - past);
    }
}

template <int Taps, bool InARow>
void integrateMoments(const IntegrationRow& row) {
    const float* __restrict means = row.previousMean;
    const float* __restrict variances = row.previousVariance;
    const float* __restrict r = row.sample[0];
    const float* __restrict g = row.sample[1];
    const float* __restrict b = row.sample[2];
    const float* __restrict alpha = row.momentsAlphas;
    float* __restrict mean = row.mean;
    float* __restrict variance = row.variance;
    for (int x = 0; x < row.count; ++x) {
        float pastMean = 0, pastVariance = 0;
        for (int k = 0; k < Taps; ++k) pastMean += row.taps.weight[k][x] * tapOf<InARow>(means, row.taps, k, x);
        // The second moment of the taps together, about their common mean.
        for (int k = 0; k < Taps; ++k) {
            const float shift = tapOf<InARow>(means, row.taps, k, x) - pastMean;
            pastVariance += row.taps.weight[k][x] * (tapOf<InARow>(variances, row.taps, k, x) + shift * shift);
        }
        const float difference = (0.2126f * r[x] + 0.7152f * g[x] + 0.0722f * b[x]) - pastMean;
        mean[x] = pastMean + alpha[x] * difference;
        variance[x] = (1.0f - alpha[x]) * (pastVariance + alpha[x] * difference * difference);
    }
}

/// Rec. 709, of what integrateColour() has just written.
void luminanceOfColour(const IntegrationRow& row) {
    const float* __restrict r = row.colour[0];
    const float* __restrict g = row.colour[1];
    const float* __restrict b = row.colour[2];
    float* __restrict out = row.luminance;
    for (int x = 0; x < row.count; ++x) out[x] = 0.2126f * r[x] + 0.7152f * g[x] + 0.0722f * b[x];
}

template <int Taps, bool InARow>
void integrate(const IntegrationRow& row) {
    for (int channel = 0; channel < 3; ++channel) integrateColour<Taps, InARow>(row, channel);
    if (row.mean) integrateMoments<Taps, InARow>(row);
    if (row.luminance) luminanceOfColour(row);
}

void integrateRow(const IntegrationRow& row) {
    switch (row.taps.taps) {
        case 0: return integrate<0, false>(row);
        case 4: return row.taps.inARow ? integrate<4, true>(row) : integrate<4, false>(row);
        default: return integrate<9, false>(row);
    }
}

void adaptRow(const float* __restrict lambda, const float* __restrict alphas, float* __restrict adapted, int count) {
    for (int x = 0; x < count; ++x) adapted[x] = alphas[x] + (1.0f - alphas[x]) * lambda[x];
}

}  // namespace

const TemporalKernels& temporalTable() {
    static const TemporalKernels table{lengthRow, integrateRow, adaptRow};
    return table;
}

}  // namespace lumi::LUMI_ISA
