#include "measure/convolve.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "measure/measure_kernels.h"

namespace lumi {

std::vector<float> gaussianWeights(int taps, double sigma) {
    std::vector<double> exact(static_cast<size_t>(taps));
    double sum = 0;
    for (int k = 0; k < taps; ++k) {
        const double x = k - (taps - 1) / 2.0;
        sum += exact[static_cast<size_t>(k)] = std::exp(-x * x / (2 * sigma * sigma));
    }
    std::vector<float> weights;
    for (const double w : exact) weights.push_back(static_cast<float>(w / sum));
    return weights;
}

void convolveClamped(ConstFloatPlane in, std::span<const float> horizontal, std::span<const float> vertical,
                     FloatPlane out) {
    const int width = in.width, height = in.height;
    const int hTaps = static_cast<int>(horizontal.size()), vTaps = static_cast<int>(vertical.size());
    const int hRadius = hTaps / 2, vRadius = vTaps / 2;
    const MeasureKernels& kernels = measureKernels();
    Image rows({width, height}, 1);
    parallelRanges(height, 16, [&](int64_t begin, int64_t end) {
        std::vector<float> extended(static_cast<size_t>(width + hTaps - 1));
        for (int64_t y = begin; y < end; ++y) {
            const float* row = in.row(static_cast<int>(y));
            std::fill_n(extended.begin(), hRadius, row[0]);
            std::copy_n(row, width, extended.begin() + hRadius);
            std::fill_n(extended.begin() + hRadius + width, hRadius, row[width - 1]);
            kernels.convolveRow(extended.data(), horizontal.data(), hTaps, rows.plane(0).row(static_cast<int>(y)),
                                width);
        }
    });
    parallelRanges(height, 16, [&](int64_t begin, int64_t end) {
        std::vector<const float*> taps(static_cast<size_t>(vTaps));
        for (int64_t y = begin; y < end; ++y) {
            for (int k = 0; k < vTaps; ++k)
                taps[static_cast<size_t>(k)] =
                    rows.plane(0).row(std::clamp(static_cast<int>(y) + k - vRadius, 0, height - 1));
            kernels.convolveColumn(taps.data(), vertical.data(), vTaps, out.row(static_cast<int>(y)), width);
        }
    });
}

}  // namespace lumi
