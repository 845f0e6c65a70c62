#include "reconstruct/lineage_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "filter/edge_weights.h"
#include "filter/spline.h"

namespace lumi {
namespace {

std::string refusalText(uint8_t refused) {
    if (refused == kTapUnused) return "unused: the point lies on a pixel";
    std::string text = "refused:";
    if (refused & kTapOffScreen) text += " off screen";
    if (refused & kTapOtherObject) text += " other object";
    if (refused & kTapDepth) text += " depth";
    if (refused & kTapNormal) text += " normal";
    return text;
}

/// Rows from `first` on: weights to parts of their sum.
void normalise(Lineage& lineage, size_t first) {
    float sum = 0;
    for (size_t i = first; i < lineage.rows.size(); ++i) sum += lineage.rows[i].weight;
    for (size_t i = first; i < lineage.rows.size() && sum > 0; ++i) lineage.rows[i].weight /= sum;
}

/// Calls body(q, i, j) for the pixels of a 5x5 window with `step` pixels between them that lie in the image.
template <class Body>
void forWindow(Extent2 extent, Pixel p, int step, Body body) {
    for (int j = -2; j <= 2; ++j)
        for (int i = -2; i <= 2; ++i) {
            const Pixel q{p.x + i * step, p.y + j * step};
            if (q.x >= 0 && q.y >= 0 && q.x < extent.width && q.y < extent.height) body(q, i, j);
        }
}

}  // namespace

void addHistoryRows(Lineage& lineage, const Signals& signals, const TemporalHistory* previous,
                    const TemporalSettings& settings, const Image* dropped, const std::string& stage,
                    const Image* loss) {
    const Pixel p = lineage.pixel;
    if (signals.ids(Signal::ObjectId).at(0, p.x, p.y) == 0) {
        lineage.rows.push_back({stage, p, 1, "this frame's sample; the sky has no history"});
        return;
    }
    // A method that kept no history in the frame before left its record empty.
    if (!previous || previous->length.extent() != signals.extent()) {
        lineage.rows.push_back({stage, p, 1, "this frame's sample; there is no frame before"});
        return;
    }
    const Reprojection reprojection(signals, previous->surface, settings.reprojection);
    const ReprojectedTaps taps = reprojection.taps(p.x, p.y);
    float length = 1;
    for (size_t k = 0; k < static_cast<size_t>(taps.count); ++k)
        length += taps.weight[k] * previous->length.data()[taps.index[k]];
    float alpha = taps.count == 0 ? 1 : std::max(settings.colourAlpha, settings.arithmeticWarmUp ? 1 / length : 0);
    const bool drops = dropped && taps.count > 0 && dropped->at(0, p.x, p.y) != 0;
    if (drops) alpha = 0;
    const float lambda = loss && taps.count > 0 ? loss->at(0, p.x, p.y) : 0;
    alpha += (1 - alpha) * lambda;
    std::string sample = lambda > 0 ? fmt::format("this frame's sample; lambda {:.3f}", lambda) : "this frame's sample";
    if (drops) sample += ", dropped: it is no number";
    lineage.rows.push_back({stage, p, alpha, std::move(sample)});
    const int width = signals.extent().width;
    const auto placeOf = [&](size_t k) { return Pixel{taps.index[k] % width, taps.index[k] / width}; };
    size_t kept = 0;
    for (size_t k = 0; k < 4; ++k) {
        const bool counts = taps.refusals[k] == kTapKept;
        const Pixel at =
            counts ? placeOf(kept) : Pixel{taps.x0 + static_cast<int>(k & 1), taps.y0 + static_cast<int>(k >> 1)};
        lineage.rows.push_back(
            {stage, at, counts ? (1 - alpha) * taps.weight[kept] : 0, counts ? "kept" : refusalText(taps.refusals[k])});
        kept += counts;
    }
    for (size_t k = 0; taps.wide && k < static_cast<size_t>(taps.count); ++k)
        lineage.rows.push_back({stage, placeOf(k), (1 - alpha) * taps.weight[k], "kept by the 3x3 fall-back"});
}

void addAtrousRows(Lineage& lineage, const std::string& stage, const SurfaceGuide& guide,
                   const AtrousSettings& settings, const Illumination& illumination, int step) {
    const Pixel p = lineage.pixel;
    const size_t first = lineage.rows.size();
    forWindow({guide.width, guide.height}, p, step, [&](Pixel q, int i, int j) {
        EdgeWeights w{1, 1, 1};
        if (i != 0 || j != 0) w = edgeWeights(guide, settings, illumination, p, q.x - p.x, q.y - p.y);
        lineage.rows.push_back({stage, q, kSpline[i + 2] * kSpline[j + 2] * w.product(),
                                fmt::format("w_z {:.3f}  w_n {:.3f}  w_l {:.3f}", w.depth, w.normal, w.luminance)});
    });
    normalise(lineage, first);
}

void addEdgeAvoidingRows(Lineage& lineage, const std::string& stage, const Signals& signals,
                         const EdgeAvoidingSettings& settings, int level, const Image& in) {
    const Pixel p = lineage.pixel;
    const size_t first = lineage.rows.size();
    const Image& inverseDepth = signals[Signal::InverseDepth];
    const float z = inverseDepth.at(0, p.x, p.y), factor = static_cast<float>(1 << level);
    const auto squared = [&](const Image& image, Pixel q) {
        float sum = 0;
        for (int c = 0; c < 3; ++c)
            sum += (image.at(c, p.x, p.y) - image.at(c, q.x, q.y)) * (image.at(c, p.x, p.y) - image.at(c, q.x, q.y));
        return sum;
    };
    const auto weight = [](float square, float sigma) { return std::exp(-square / (sigma * sigma)); };
    forWindow(in.extent(), p, 1 << level, [&](Pixel q, int i, int j) {
        float c = 1, n = 1, x = 1;
        if (i != 0 || j != 0) {
            const bool surfaces = z > 0 && inverseDepth.at(0, q.x, q.y) > 0;
            c = surfaces ? weight(squared(in, q), settings.sigmaColour / factor) : 0;
            n = weight(squared(signals[Signal::Normal], q), settings.sigmaNormal * factor);
            x = weight(squared(signals[Signal::Position], q) * z * z, settings.sigmaPosition);
        }
        lineage.rows.push_back({stage, q, kSpline[i + 2] * kSpline[j + 2] * c * n * x,
                                fmt::format("w_rt {:.3f}  w_n {:.3f}  w_x {:.3f}", c, n, x)});
    });
    normalise(lineage, first);
}

}  // namespace lumi
