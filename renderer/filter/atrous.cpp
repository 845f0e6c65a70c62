#include "filter/atrous.h"

#include <cassert>

#include "base/parallel.h"
#include "filter/atrous_kernels.h"

namespace lumi {
namespace {

constexpr int64_t kRows = 8;  ///< rows of one task

AtrousRow geometryOf(const SurfaceGuide& guide, const EdgeStopping& edges, int step) {
    AtrousRow row;
    row.width = guide.width;
    row.height = guide.height;
    row.step = step;
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

void updateLuminance(Illumination& illumination) {
    const AtrousKernels& kernels = atrousKernels();
    const Image& rgb = illumination.rgb;
    parallelRanges(rgb.extent().area(), 1 << 14, [&](int64_t begin, int64_t end) {
        const float* const row[3] = {rgb.plane(0).data + begin, rgb.plane(1).data + begin, rgb.plane(2).data + begin};
        kernels.luminanceRow(row, illumination.luminance.data() + begin, static_cast<int>(end - begin));
    });
}

bool atrousLevel(const SurfaceGuide& guide, const AtrousSettings& settings, int step,
                 const std::vector<const Illumination*>& in, const std::vector<Illumination*>& out, std::stop_token stop) {
    assert(in.size() == out.size() && in.size() <= AtrousRow::kMaxComponents);
    const AtrousKernels& kernels = atrousKernels();
    AtrousRow shared = geometryOf(guide, settings.edges, step);
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
    parallelRanges(guide.height, kRows, [&](int64_t begin, int64_t end) {
        AtrousRow row = shared;
        std::vector<float> scales(static_cast<size_t>(guide.width) * in.size());
        for (int y = static_cast<int>(begin); y < end; ++y) {
            row.y = y;
            for (size_t c = 0; c < in.size(); ++c) {
                float* scale = scales.data() + c * static_cast<size_t>(guide.width);
                kernels.luminanceScaleRow(in[c]->sampleVariance.data(), guide.width, guide.height, y,
                                          settings.edges.sigmaLuminance, settings.variancePrefilter, scale);
                row.luminanceScale[c] = scale;
            }
            kernels.filterRow(row);
        }
    }, stop);
    return !stop.stop_requested();
}

bool estimateVarianceSpatially(const SurfaceGuide& guide, const EdgeStopping& edges, const float* historyLength,
                               float minLength, const float* mean, const float* centred, float* sampleVariance,
                               std::stop_token stop) {
    const AtrousKernels& kernels = atrousKernels();
    parallelRanges(guide.height, kRows, [&](int64_t begin, int64_t end) {
        AtrousRow row = geometryOf(guide, edges, 1);
        for (int y = static_cast<int>(begin); y < end; ++y) {
            row.y = y;
            kernels.spatialVarianceRow(row, historyLength, minLength, mean, centred,
                                       sampleVariance + static_cast<std::ptrdiff_t>(y) * guide.width);
        }
    }, stop);
    return !stop.stop_requested();
}

}  // namespace lumi
