#include "filter/atrous_kernels.h"

#include <cmath>

#include "filter/atrous_taps.h"
#include "filter/edge_stopping_lanes.h"

namespace lumi::LUMI_ISA {
namespace {

constexpr float kLogSpline[5] = {-4, -2, -1.4150375f, -2, -4};  ///< log2 of kSpline

/// One component's sums of eq. 1 and of its variance, and what its pixels bring to eq. 5.
struct Component {
    Lanes luminance, scale;
    Lanes weight, r, g, b, variance;
};

template <class Span>
LUMI_LANES void start(const IlluminationView& in, const float* scale, std::ptrdiff_t at, int x, const Span& span, Component& c) {
    const Lanes h = lanes(kSpline[2] * kSpline[2]);  // the pixel itself: w(p, p) = 1
    c.luminance = span.load(in.luminance + at);
    c.scale = span.load(scale + x);
    c.weight = h;
    c.r = h * span.load(in.rgb[0] + at);
    c.g = h * span.load(in.rgb[1] + at);
    c.b = h * span.load(in.rgb[2] + at);
    c.variance = h * h * span.load(in.sampleVariance + at);
}

/// Adds taps of eq. 1.
template <int Components, bool Edge, size_t Taps>
LUMI_LANES void add(const AtrousRow& row, const std::array<LaneTap<Edge>, Taps>& taps, Component (&components)[Components]) {
    Lanes w[Taps * Components];
    for (size_t t = 0; t < Taps; ++t)
        for (int c = 0; c < Components; ++c) {
            const Lanes luminance = taps[t].span.load(row.in[c].luminance + taps[t].at);
            w[t * Components + c] = subMul(taps[t].exponent, distanceOf(components[c].luminance, luminance), components[c].scale);
        }
    weightExp2(w);
    for (size_t t = 0; t < Taps; ++t)
        for (int c = 0; c < Components; ++c) {
            const auto load = [&](const float* plane) [[gnu::always_inline]] { return taps[t].span.load(plane + taps[t].at); };
            const IlluminationView& in = row.in[c];
            Component& sum = components[c];
            const Lanes weight = w[t * Components + c];
            sum.weight = sum.weight + weight;
            sum.r = mulAdd(weight, load(in.rgb[0]), sum.r);
            sum.g = mulAdd(weight, load(in.rgb[1]), sum.g);
            sum.b = mulAdd(weight, load(in.rgb[2]), sum.b);
            sum.variance = mulAdd(weight * weight, load(in.sampleVariance), sum.variance);
        }
}

template <class Span>
LUMI_LANES void finish(const IlluminationOutput& out, std::ptrdiff_t at, const Span& span, const Component& c) {
    const Lanes inverse = lanes(1.0f) / c.weight;
    const Lanes r = c.r * inverse, g = c.g * inverse, b = c.b * inverse;
    span.store(out.rgb[0] + at, r);
    span.store(out.rgb[1] + at, g);
    span.store(out.rgb[2] + at, b);
    span.store(out.sampleVariance + at, c.variance * inverse * inverse);
    span.store(out.luminance + at, mulAdd(lanes(0.2126f), r, mulAdd(lanes(0.7152f), g, lanes(0.0722f) * b)));
}

/// The pixels from column x on, as many as a register holds. The sums stay in registers over all taps.
template <int Components, bool Usual, bool Edge>
LUMI_LANES void filterLanes(const AtrousRow& row, const TapPairs<2>& taps, int x) {
    const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(row.guide.y) * row.guide.width + x;
    const Span<Edge> here = spanOf<Edge>(x, 0, row.guide.width);
    Component components[Components];
    for (int c = 0; c < Components; ++c) start(row.in[c], row.luminanceScale[c], at, x, here, components[c]);
    const EdgeStop<Usual, Edge> edges(row.guide, x);
    for (int i = 0; i < taps.count; ++i)
        edges.forPair(taps.pairs[i], [&](const auto& pair) [[gnu::always_inline]] { add(row, pair, components); });
    for (int c = 0; c < Components; ++c) finish(row.out[c], at, here, components[c]);
}

template <int Components, bool Usual>
void filterLoop(const AtrousRow& row) {
    const TapPairs<2> taps(row.guide, row.step, kLogSpline);
    forRegisters(row.guide.width, 2 * row.step, [&](int x) { filterLanes<Components, Usual, false>(row, taps, x); },
                 [&](int x) { filterLanes<Components, Usual, true>(row, taps, x); });
}

void filterRow(const AtrousRow& row) {
    const bool usual = isUsual(row.guide.edges);
    if (row.components == 1) return usual ? filterLoop<1, true>(row) : filterLoop<1, false>(row);
    usual ? filterLoop<2, true>(row) : filterLoop<2, false>(row);
}

void luminanceScaleRow(const float* variance, int width, int height, int y, float sigmaLuminance, bool prefilter,
                       float* __restrict scale) {
    const float* __restrict at = variance + static_cast<std::ptrdiff_t>(y) * width;
    if (!prefilter) {
        for (int x = 0; x < width; ++x) scale[x] = at[x];
    } else {
        const float* __restrict above = at - (y > 0 ? width : 0);
        const float* __restrict below = at + (y + 1 < height ? width : 0);
        const auto column = [&](int x) { return above[x] + 2.0f * at[x] + below[x]; };
        for (int x = 1; x + 1 < width; ++x) scale[x] = (column(x - 1) + 2.0f * column(x) + column(x + 1)) * (1.0f / 16);
        const int end = width - 1;
        scale[0] = (3.0f * column(0) + column(end < 1 ? end : 1)) * (1.0f / 16);
        if (end > 0) scale[end] = (column(end - 1) + 3.0f * column(end)) * (1.0f / 16);
    }
    for (int x = 0; x < width; ++x) scale[x] = kLog2E / (sigmaLuminance * std::sqrt(scale[x] + kVarianceEpsilon) + 1e-30f);
}

void luminanceRow(const float* const rgb[3], float* __restrict out, int width) {
    const float* __restrict r = rgb[0];
    const float* __restrict g = rgb[1];
    const float* __restrict b = rgb[2];
    for (int x = 0; x < width; ++x) out[x] = 0.2126f * r[x] + 0.7152f * g[x] + 0.0722f * b[x];
}

}  // namespace

const AtrousKernels& atrousTable() {
    static const AtrousKernels table{filterRow, luminanceScaleRow, luminanceRow};
    return table;
}

}  // namespace lumi::LUMI_ISA
