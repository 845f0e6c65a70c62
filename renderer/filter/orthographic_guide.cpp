#include "filter/orthographic_guide.h"

#include <algorithm>
#include <vector>

#include "base/parallel.h"

namespace lumi {

SurfaceGuide orthographicGuide(const Signals& signals, float height, Image& planes) {
    const Extent2 extent = signals.extent();
    if (planes.extent() != extent) planes.reset(extent, 3);
    const Image &inverseDepth = signals[Signal::InverseDepth], &gradient = signals[Signal::DepthGradient];
    std::vector<float> farthest(static_cast<size_t>(extent.height), 0);  // of each row
    parallelFor(extent.height, [&](int64_t row) {
        for (int x = 0; x < extent.width; ++x)
            if (const float inverse = inverseDepth.at(0, x, static_cast<int>(row)); inverse > 0)
                farthest[static_cast<size_t>(row)] = std::max(farthest[static_cast<size_t>(row)], 1 / inverse);
    });
    const float last = *std::max_element(farthest.begin(), farthest.end());
    parallelFor(extent.height, [&](int64_t row) {
        const int y = static_cast<int>(row);
        for (int x = 0; x < extent.width; ++x) {
            const float inverse = inverseDepth.at(0, x, y), depth = inverse > 0 ? 1 / inverse : 0;
            planes.at(0, x, y) = inverse > 0 ? 1 + (last - depth) / height : 0;
            for (int c = 0; c < 2; ++c) planes.at(1 + c, x, y) = gradient.at(c, x, y) * (depth * depth / height);
        }
    });
    SurfaceGuide guide = surfaceGuide(signals);
    guide.inverseDepth = planes.plane(0).data;
    guide.slopeX = planes.plane(1).data;
    guide.slopeY = planes.plane(2).data;
    return guide;
}

}  // namespace lumi
