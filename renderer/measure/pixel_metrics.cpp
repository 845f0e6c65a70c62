#include <cmath>

#include "base/parallel.h"
#include "measure/metrics.h"

namespace lumi {
namespace {

/// Mean of per-pixel errors over the pixels that count; a map is held only if it is wanted.
template <class PixelError>
Measurement meanError(const Image& image, const Image& reference, const ImagePair& pair, bool wantMap,
                      PixelError error) {
    const int width = image.width(), height = image.height();
    Measurement result;
    if (wantMap) result.map.reset(image.extent(), 1);
    std::vector<double> sums(static_cast<size_t>(height));
    parallelRanges(height, 16, [&](int64_t begin, int64_t end) {
        std::vector<float> buffer(static_cast<size_t>(width));
        for (int y = static_cast<int>(begin); y < end; ++y) {
            float* out = wantMap ? result.map.plane(0).row(y) : buffer.data();
            const float *r = image.plane(0).row(y), *g = image.plane(1).row(y), *b = image.plane(2).row(y);
            const float *rr = reference.plane(0).row(y), *rg = reference.plane(1).row(y),
                        *rb = reference.plane(2).row(y);
            for (int x = 0; x < width; ++x) out[x] = error(Vec3(r[x], g[x], b[x]), Vec3(rr[x], rg[x], rb[x]));
            for (int x = 0; !pair.valid.empty() && x < width; ++x)
                if (!pair.counts(x, y)) out[x] = 0;
            double row = 0;
            for (int x = 0; x < width; ++x) row += out[x];
            sums[static_cast<size_t>(y)] = row;
        }
    });
    result.reason = pair.whyNothingCounts();
    if (!result.reason.empty()) return result;
    double sum = 0;
    for (const double row : sums) sum += row;
    result.value = sum / static_cast<double>(pair.valid.empty() ? image.extent().area() : pair.countedPixels);
    if (!std::isfinite(result.value)) result.reason = "infinite: a pixel's error is beyond what a float holds";
    return result;
}

float squaredError(const Vec3& a, const Vec3& b) {
    const Vec3 d = a - b;
    return glm::dot(d, d) / 3.0f;
}

Measurement ldrMse(const ImagePair& pair, bool wantMap) {
    const Image a = ldrImage(pair.image, pair.exposureEv), b = ldrImage(pair.reference, pair.exposureEv);
    return meanError(a, b, pair, wantMap, squaredError);
}

}  // namespace

Measurement measureMse(const ImagePair& pair, bool wantMap) {
    return meanError(pair.image, pair.reference, pair, wantMap, squaredError);
}

Measurement measureRmse(const ImagePair& pair, bool wantMap) {
    Measurement result = ldrMse(pair, wantMap);
    result.value = std::sqrt(result.value);
    for (size_t i = 0; i < result.map.size(); ++i) result.map.data()[i] = std::sqrt(result.map.data()[i]);
    return result;
}

Measurement measureMae(const ImagePair& pair, bool wantMap) {
    return meanError(pair.image, pair.reference, pair, wantMap,
                     [](const Vec3& a, const Vec3& b) { return average(glm::abs(a - b)); });
}

Measurement measurePsnr(const ImagePair& pair, bool wantMap) {
    Measurement result = ldrMse(pair, wantMap);
    const bool equal = result.value == 0;
    if (equal) result.reason = "infinite: the tone-mapped images are equal";
    result.value = equal ? static_cast<double>(kInfinity) : -10 * std::log10(result.value);
    return result;
}

Measurement measureRelMse(const ImagePair& pair, bool wantMap) {
    const auto epsilon = static_cast<float>(pair.settings.relMseEpsilon);
    Measurement result = meanError(pair.image, pair.reference, pair, wantMap, [epsilon](const Vec3& a, const Vec3& b) {
        const Vec3 d = a - b;
        return glm::dot(d, d) / (sqr(average(b)) + epsilon);
    });
    result.details = {{"epsilon", pair.settings.relMseEpsilon}};
    return result;
}

Measurement measureSmape(const ImagePair& pair, bool wantMap) {
    return meanError(pair.image, pair.reference, pair, wantMap, [](const Vec3& a, const Vec3& b) {
        float sum = 0;
        for (int c = 0; c < 3; ++c) sum += 2 * std::abs(a[c] - b[c]) / (std::abs(a[c]) + std::abs(b[c]) + 0.01f);
        return sum / 3.0f;
    });
}

}  // namespace lumi
