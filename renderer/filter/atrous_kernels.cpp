#include "filter/atrous_kernels.h"

#include "filter/edge_stopping_lanes.h"
#include "filter/spline.h"

namespace lumi::LUMI_ISA {
namespace {

constexpr float kLogSpline[5] = {-4, -2, -1.4150375f, -2, -4};  ///< log2 of kSpline

/// One component's sums of eq. 1 and of its variance, and what its pixels bring to eq. 5.
struct Component {
    Lanes luminance, scale;
    Lanes weight, r, g, b, variance;
};

/// g3x3(Var) of eq. 5 for the pixels from column x on; borders repeat.
template <bool Edge>
LUMI_LANES Lanes steeringVariance(const AtrousRow& row, const float* variance, std::ptrdiff_t at, int x) {
    const GuideRow& guide = row.guide;
    const Span<Edge> here = spanOf<Edge>(x, 0, guide.width);
    const float* line = variance + at;
    if (!row.variancePrefilter) return here.load(line);
    const std::ptrdiff_t above = guide.y > 0 ? -guide.width : 0, below = guide.y + 1 < guide.height ? guide.width : 0;
    const auto column = [&](const Span<Edge>& span, int i) LUMI_LANES_LAMBDA {
        return mulAdd(lanes(2.0f), span.load(line + i), span.load(line + above + i) + span.load(line + below + i));
    };
    const Lanes centre = column(here, 0);
    Lanes sides = column(spanOf<Edge>(x, -1, guide.width), -1) + column(spanOf<Edge>(x, 1, guide.width), 1);
    if constexpr (Edge) {
        const int last = guide.width - 1 - x;
        if (x == 0) sides = sides + column({laneMask(0, 1)}, 0);
        if (last < kLanes) sides = sides + column({laneMask(last, last + 1)}, 0);
    }
    return mulAdd(lanes(2.0f), centre, sides) * lanes(1.0f / 16);
}

template <bool Edge>
LUMI_LANES void start(const AtrousRow& row, int component, std::ptrdiff_t at, int x, Component& c) {
    const IlluminationView& in = row.in[component];
    const Span<Edge> span = spanOf<Edge>(x, 0, row.guide.width);
    const Lanes h = lanes(kSpline[2] * kSpline[2]);  // the pixel itself: w(p, p) = 1
    const Lanes variance = steeringVariance<Edge>(row, in.sampleVariance, at, x) + lanes(kVarianceEpsilon);
    c.luminance = span.load(in.luminance + at);
    c.scale = atLeast(inverseRoot(variance) * lanes(kLog2E / row.guide.edges.sigmaLuminance), lanes(0.0f));
    c.weight = h;
    c.r = h * span.load(in.rgb[0] + at);
    c.g = h * span.load(in.rgb[1] + at);
    c.b = h * span.load(in.rgb[2] + at);
    c.variance = h * h * span.load(in.sampleVariance + at);
}

/// Adds taps of eq. 1.
template <int Components, bool Edge, size_t Taps>
LUMI_LANES void add(const AtrousRow& row, const std::array<LaneTap<Edge>, Taps>& taps,
                    Component (&components)[Components]) {
    Lanes w[Taps * Components];
    for (size_t t = 0; t < Taps; ++t)
        for (int c = 0; c < Components; ++c) {
            const Lanes luminance = taps[t].span.load(row.in[c].luminance + taps[t].at);
            w[t * Components + c] =
                subMul(taps[t].exponent, distanceOf(components[c].luminance, luminance), components[c].scale);
        }
    weightExp2(w);
    for (size_t t = 0; t < Taps; ++t)
        for (int c = 0; c < Components; ++c) {
            const auto load = [&](const float* plane)
                                  LUMI_LANES_LAMBDA { return taps[t].span.load(plane + taps[t].at); };
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

template <bool Edge>
LUMI_LANES void finish(const IlluminationOutput& out, std::ptrdiff_t at, const Span<Edge>& span, const Component& c) {
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
    Component components[Components];
    for (int c = 0; c < Components; ++c) start<Edge>(row, c, at, x, components[c]);
    const EdgeStop<Usual, Edge> edges(row.guide, x);
    for (int i = 0; i < taps.count; ++i)
        edges.forPair(taps.pairs[i], [&](const auto& pair) LUMI_LANES_LAMBDA { add(row, pair, components); });
    for (int c = 0; c < Components; ++c) finish(row.out[c], at, spanOf<Edge>(x, 0, row.guide.width), components[c]);
}

template <int Components, bool Usual>
void filterLoop(const AtrousRow& row) {
    const TapPairs<2> taps(row.guide, row.step, kLogSpline);
    forRegisters(
        row.guide.width, 2 * row.step, [&](int x) { filterLanes<Components, Usual, false>(row, taps, x); },
        [&](int x) { filterLanes<Components, Usual, true>(row, taps, x); });
}

void filterRow(const AtrousRow& row) {
    const bool usual = isUsual(row.guide.edges);
    if (row.components == 1) return usual ? filterLoop<1, true>(row) : filterLoop<1, false>(row);
    usual ? filterLoop<2, true>(row) : filterLoop<2, false>(row);
}

}  // namespace

const AtrousKernels& atrousTable() {
    static const AtrousKernels table{filterRow};
    return table;
}

}  // namespace lumi::LUMI_ISA
