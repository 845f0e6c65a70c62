#include "filter/edge_weights.h"

#include <algorithm>
#include <cmath>

namespace lumi {

float prefilteredVariance(const Image& sampleVariance, Pixel p) {
    constexpr float kBinomial[3] = {0.25f, 0.5f, 0.25f};
    float sum = 0;
    for (int j = -1; j <= 1; ++j)
        for (int i = -1; i <= 1; ++i)
            sum += kBinomial[i + 1] * kBinomial[j + 1] *
                   sampleVariance.at(0, std::clamp(p.x + i, 0, sampleVariance.width() - 1),
                                     std::clamp(p.y + j, 0, sampleVariance.height() - 1));
    return sum;
}

EdgeWeights edgeWeights(const SurfaceGuide& guide, const AtrousSettings& settings, const Illumination& illumination,
                        Pixel p, int dx, int dy) {
    const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(p.y) * guide.width + p.x,
                         to = at + static_cast<std::ptrdiff_t>(dy) * guide.width + dx;
    const EdgeStopping& edges = settings.edges;
    EdgeWeights w;
    const float z = guide.inverseDepth[at];
    const float rise = guide.slopeX[at] * static_cast<float>(dx) + guide.slopeY[at] * static_cast<float>(dy);
    const float distance = std::fabs(guide.inverseDepth[to] - z - (edges.planeDistance ? rise : 0.0f));
    w.depth = std::exp(-distance / (edges.sigmaDepth * std::fabs(rise) + kDepthEpsilon * z + 1e-30f));
    float cosine = 0;
    for (const float* normal : guide.normal) cosine += normal[at] * normal[to];
    w.normal = std::pow(std::max(cosine, 0.0f), edges.sigmaNormal);
    const float variance = settings.variancePrefilter ? prefilteredVariance(illumination.sampleVariance, p)
                                                      : illumination.sampleVariance.data()[at];
    w.luminance = std::exp(-std::fabs(illumination.luminance.data()[at] - illumination.luminance.data()[to]) /
                           (edges.sigmaLuminance * std::sqrt(variance + kVarianceEpsilon) + 1e-30f));
    return w;
}

}  // namespace lumi
