#include "filter/atrous.h"

#include <cassert>

#include "base/parallel.h"
#include "filter/atrous_kernels.h"
#include "filter/spatial_variance_kernels.h"

namespace lumi {
namespace {

constexpr int64_t kRows = 16;  ///< rows of one task

/// The i-th row of an image of `height` rows in the order 0, step, 2 step, ..., 1, 1 + step, ...: those that follow
/// each other share four of the five rows of their windows, which then are in the cache still.
int rowInStride(int64_t i, int64_t height, int64_t step) {
    const int64_t rows = height / step, longer = height % step;  // the first `longer` of the strides have a row more
    const int64_t split = longer * (rows + 1);
    if (i < split) return static_cast<int>(i % (rows + 1) * step + i / (rows + 1));
    return static_cast<int>((i - split) % rows * step + longer + (i - split) / rows);
}

GuideRow guideRow(const SurfaceGuide& guide, const EdgeStopping& edges) {
    GuideRow row;
    row.width = guide.width;
    row.height = guide.height;
    row.inverseDepth = guide.inverseDepth;
    row.slopeX = guide.slopeX;
    row.slopeY = guide.slopeY;
    for (int c = 0; c < 3; ++c) row.normal[c] = guide.normal[c];
    row.edges = edges;
    return row;
}

}  // namespace

void Illumination::reset(Extent2 extent) {
    if (rgb.extent() == extent && rgb.channels() == 3) return;
    rgb.reset(extent, 3);
    luminance.reset(extent, 1);
    sampleVariance.reset(extent, 1);
}

bool atrousLevel(const SurfaceGuide& guide, const AtrousSettings& settings, int step,
                 const std::vector<const Illumination*>& in, const std::vector<Illumination*>& out,
                 std::stop_token stop) {
    assert(in.size() == out.size() && in.size() <= AtrousRow::kMaxComponents);
    const AtrousKernels& kernels = atrousKernels();
    AtrousRow shared;
    shared.guide = guideRow(guide, settings.edges);
    shared.step = step;
    shared.variancePrefilter = settings.variancePrefilter;
    shared.components = static_cast<int>(in.size());
    for (size_t c = 0; c < in.size(); ++c) {
        out[c]->reset({guide.width, guide.height});
        for (int channel = 0; channel < 3; ++channel) {
            shared.in[c].rgb[channel] = in[c]->rgb.plane(channel).data;
            shared.out[c].rgb[channel] = out[c]->rgb.plane(channel).data;
        }
        shared.in[c].luminance = in[c]->luminance.data();
        shared.in[c].sampleVariance = in[c]->sampleVariance.data();
        shared.out[c].luminance = out[c]->luminance.data();
        shared.out[c].sampleVariance = out[c]->sampleVariance.data();
    }
    parallelRanges(
        guide.height, kRows,
        [&](int64_t begin, int64_t end) {
            AtrousRow row = shared;
            for (int64_t i = begin; i < end; ++i) {
                row.guide.y = rowInStride(i, guide.height, step);
                kernels.filterRow(row);
            }
        },
        stop);
    return !stop.stop_requested();
}

bool estimateVarianceSpatially(const SurfaceGuide& guide, const EdgeStopping& edges, const float* historyLength,
                               float minLength, const std::vector<MomentPlanes>& components, std::stop_token stop) {
    assert(components.size() <= SpatialVarianceRow::kMaxComponents);
    SpatialVarianceRow shared;
    shared.guide = guideRow(guide, edges);
    shared.historyLength = historyLength;
    shared.minLength = minLength;
    shared.components = static_cast<int>(components.size());
    for (size_t c = 0; c < components.size(); ++c) {
        shared.mean[c] = components[c].mean;
        shared.centred[c] = components[c].centred;
        shared.variance[c] = components[c].sampleVariance;
    }
    parallelRanges(
        guide.height, kRows,
        [&](int64_t begin, int64_t end) {
            SpatialVarianceRow row = shared;
            for (row.guide.y = static_cast<int>(begin); row.guide.y < end; ++row.guide.y)
                spatialVarianceKernels().estimateRow(row);
        },
        stop);
    return !stop.stop_requested();
}

}  // namespace lumi
