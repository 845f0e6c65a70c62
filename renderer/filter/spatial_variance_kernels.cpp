#include "filter/spatial_variance_kernels.h"

#include "filter/edge_stopping_lanes.h"

namespace lumi::LUMI_ISA {
namespace {

constexpr int kRadius = 3;
constexpr float kEqual[2 * kRadius + 1] = {0, 0, 0, 0, 0, 0, 0};  ///< log2 of weights

/// One component's sums: differences from the pixel's own mean, which float holds more digits of, and second moments
/// about it.
struct Moments {
    Lanes mean, shift, square;
};

/// The pixels from column x on, as many as a register holds.
template <int Components, bool Usual, bool Edge>
LUMI_LANES void estimateLanes(const SpatialVarianceRow& row, const TapPairs<kRadius>& taps, int x) {
    const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(row.guide.y) * row.guide.width + x;
    const Span<Edge> here = spanOf<Edge>(x, 0, row.guide.width);
    const Lanes least = lanes(row.minLength), length = here.load(row.historyLength + at);
    Lanes weight = lanes(1.0f);
    Moments moments[Components];
    for (int c = 0; c < Components; ++c)
        moments[c] = {here.load(row.mean[c] + at), lanes(0.0f), here.load(row.centred[c] + at)};
    if (anyAbove(least, length)) {
        const EdgeStop<Usual, Edge> edges(row.guide, x);
        for (int i = 0; i < taps.count; ++i)
            edges.forPair(
                taps.pairs[i], [&]<size_t Taps>(const std::array<LaneTap<Edge>, Taps>& pair) LUMI_LANES_LAMBDA {
                    Lanes w[Taps];
                    for (size_t t = 0; t < Taps; ++t) w[t] = pair[t].exponent;
                    weightExp2(w);
                    for (size_t t = 0; t < Taps; ++t) {
                        weight = weight + w[t];
                        for (int c = 0; c < Components; ++c) {
                            const Lanes difference = pair[t].span.load(row.mean[c] + pair[t].at) - moments[c].mean;
                            const Lanes centred = pair[t].span.load(row.centred[c] + pair[t].at);
                            moments[c].shift = mulAdd(w[t], difference, moments[c].shift);
                            moments[c].square =
                                mulAdd(w[t], mulAdd(difference, difference, centred), moments[c].square);
                        }
                    }
                });
    }
    for (int c = 0; c < Components; ++c) {
        const Lanes shift = moments[c].shift / weight, estimate = subMul(moments[c].square / weight, shift, shift);
        here.store(row.variance[c] + at,
                   selectAbove(least, length, atLeast(estimate, lanes(0.0f)), here.load(row.centred[c] + at)));
    }
}

template <int Components, bool Usual>
void estimateLoop(const SpatialVarianceRow& row) {
    const TapPairs<kRadius> taps(row.guide, 1, kEqual);
    forRegisters(
        row.guide.width, kRadius, [&](int x) { estimateLanes<Components, Usual, false>(row, taps, x); },
        [&](int x) { estimateLanes<Components, Usual, true>(row, taps, x); });
}

void estimateRow(const SpatialVarianceRow& row) {
    const bool usual = isUsual(row.guide.edges);
    if (row.components == 1) return usual ? estimateLoop<1, true>(row) : estimateLoop<1, false>(row);
    usual ? estimateLoop<2, true>(row) : estimateLoop<2, false>(row);
}

}  // namespace

const SpatialVarianceKernels& spatialVarianceTable() {
    static const SpatialVarianceKernels table{estimateRow};
    return table;
}

}  // namespace lumi::LUMI_ISA
