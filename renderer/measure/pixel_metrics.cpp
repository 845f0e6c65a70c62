#include <cmath>

#include "base/parallel.h"
#include "measure/metrics.h"

namespace lumi {
namespace {

/// A map of per-pixel errors, averaged over channels; the metric's value is the map's mean.
template <class PixelError>
Image errorMap(const Image& image, const Image& reference, PixelError error) {
    Image map(image.extent(), 1);
    parallelRanges(image.height(), 16, [&](int64_t begin, int64_t end) {
        for (int y = static_cast<int>(begin); y < end; ++y) {
            float* out = map.plane(0).row(y);
            const float *r = image.plane(0).row(y), *g = image.plane(1).row(y), *b = image.plane(2).row(y);
            const float *rr = reference.plane(0).row(y), *rg = reference.plane(1).row(y), *rb = reference.plane(2).row(y);
            for (int x = 0; x < image.width(); ++x)
                out[x] = error(Vec3(r[x], g[x], b[x]), Vec3(rr[x], rg[x], rb[x]));
        }
    });
    return map;
}

Measurement meanOf(Image map, const ImagePair& pair, bool wantMap) {
    Measurement result;
    result.value = meanOverMask(map, pair);
    if (wantMap) {
        clearUncounted(map, pair);
        result.map = std::move(map);
    }
    return result;
}

float squaredError(const Vec3& a, const Vec3& b) {
    const Vec3 d = a - b;
    return glm::dot(d, d) / 3.0f;
}

Measurement ldrMse(const ImagePair& pair, bool wantMap) {
    const Image a = ldrImage(pair.image, pair.exposureEv), b = ldrImage(pair.reference, pair.exposureEv);
    return meanOf(errorMap(a, b, squaredError), pair, wantMap);
}

}  // namespace

Measurement measureMse(const ImagePair& pair, bool wantMap) {
    return meanOf(errorMap(pair.image, pair.reference, squaredError), pair, wantMap);
}

Measurement measureRmse(const ImagePair& pair, bool wantMap) {
    Measurement result = ldrMse(pair, wantMap);
    result.value = std::sqrt(result.value);
    for (size_t i = 0; i < result.map.size(); ++i) result.map.data()[i] = std::sqrt(result.map.data()[i]);
    return result;
}

Measurement measureMae(const ImagePair& pair, bool wantMap) {
    return meanOf(errorMap(pair.image, pair.reference,
                           [](const Vec3& a, const Vec3& b) { return average(glm::abs(a - b)); }),
                  pair, wantMap);
}

Measurement measurePsnr(const ImagePair& pair, bool wantMap) {
    Measurement result = ldrMse(pair, wantMap);
    result.value = result.value > 0 ? -10 * std::log10(result.value) : static_cast<double>(kInfinity);
    return result;
}

Measurement measureRelMse(const ImagePair& pair, bool wantMap) {
    return meanOf(errorMap(pair.image, pair.reference,
                           [](const Vec3& a, const Vec3& b) {
                               const Vec3 d = a - b;
                               return glm::dot(d, d) / (sqr(average(b)) + 0.001f);
                           }),
                  pair, wantMap);
}

Measurement measureSmape(const ImagePair& pair, bool wantMap) {
    return meanOf(errorMap(pair.image, pair.reference,
                           [](const Vec3& a, const Vec3& b) {
                               float sum = 0;
                               for (int c = 0; c < 3; ++c)
                                   sum += 2 * std::abs(a[c] - b[c]) / (std::abs(a[c]) + std::abs(b[c]) + 0.01f);
                               return sum / 3.0f;
                           }),
                  pair, wantMap);
}

}  // namespace lumi
