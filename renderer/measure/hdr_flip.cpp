// HDR-FLIP [Andersson 2021, "Visualizing Errors in Rendered High Dynamic Range Images"]: the maximum of LDR-FLIP over
// exposures between the one that shows the reference's brightest pixel and the one that shows its median.
#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "measure/measure_kernels.h"
#include "measure/metrics.h"
#include "measure/perceived.h"

namespace lumi {
namespace {

/// ACES fit [Narkowicz 2015] with the factor 0.6 that matches the reference implementation's brightness.
constexpr float kAces[6] = {0.6f * 0.6f * 2.51f, 0.6f * 0.03f, 0.0f, 0.6f * 0.6f * 2.43f, 0.6f * 0.59f, 0.14f};

/// Input of the tone mapper at which it gives 0.85.
double brightInput() {
    const double t = 0.85;
    const double a = kAces[0] - t * kAces[3], b = kAces[1] - t * kAces[4], c = kAces[2] - t * kAces[5];
    const double root = std::sqrt(b * b - 4 * a * c);
    return std::max((-b + root) / (2 * a), (-b - root) / (2 * a));
}

double medianOf(std::vector<float>& values) {
    const size_t middle = values.size() / 2;
    std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(middle), values.end());
    const double upper = values[middle];
    if (values.size() % 2) return upper;
    const double lower = *std::max_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(middle));
    return (lower + upper) / 2;
}

Image toneMapped(const Image& linear, float exposureEv) {
    Image out(linear.extent(), 3);
    const MeasureKernels& kernels = measureKernels();
    const float factor = std::exp2(exposureEv);
    parallelRanges(linear.height(), 16, [&](int64_t begin, int64_t end) {
        for (int y = static_cast<int>(begin); y < end; ++y)
            for (int c = 0; c < 3; ++c)
                kernels.toneRational(linear.plane(c).row(y), factor, kAces, out.plane(c).row(y), linear.width());
    });
    return out;
}

}  // namespace

FlipExposures flipExposures(const Image& reference) {
    std::vector<float> luminances;
    luminances.reserve(static_cast<size_t>(reference.extent().area()));
    for (int y = 0; y < reference.height(); ++y)
        for (int x = 0; x < reference.width(); ++x) {
            const Vec3 c(reference.at(0, x, y), reference.at(1, x, y), reference.at(2, x, y));
            luminances.push_back(std::max(0.0f, luminance(c)));
        }
    if (luminances.empty()) return {};
    const double brightest = *std::max_element(luminances.begin(), luminances.end());
    if (brightest <= 0) return {};
    double median = medianOf(luminances);
    if (median <= 0) {
        luminances.erase(std::remove(luminances.begin(), luminances.end(), 0.0f), luminances.end());
        median = medianOf(luminances);
    }
    return FlipExposures::over(std::log2(brightInput() / brightest), std::log2(brightInput() / median));
}

Measurement measureHdrFlip(const ImagePair& pair, bool wantMap) {
    const FlipExposures range =
        pair.settings.flipExposures ? *pair.settings.flipExposures : flipExposures(pair.reference);
    Image worst(pair.image.extent(), 1);
    for (int i = 0; i < range.count; ++i) {
        const auto exposure =
            static_cast<float>(range.start + (range.stop - range.start) * i / std::max(range.count - 1, 1));
        const Image error = flipError(flipFeatures(toneMapped(pair.image, exposure)),
                                      flipFeatures(toneMapped(pair.reference, exposure)));
        parallelRanges(static_cast<int64_t>(worst.size()), 1 << 15, [&](int64_t begin, int64_t end) {
            float* out = worst.data();
            for (int64_t p = begin; p < end; ++p) out[p] = std::max(out[p], error.data()[p]);
        });
    }
    Measurement result = meanMeasurement(std::move(worst), pair, wantMap);
    result.details = {{"start_exposure", range.start},
                      {"stop_exposure", range.stop},
                      {"exposures", static_cast<double>(range.count)}};
    return result;
}

}  // namespace lumi
