// LDR-FLIP [Andersson 2020, "FLIP: A Difference Evaluator for Alternating Images"].
#include "base/parallel.h"
#include "measure/measure_kernels.h"
#include "measure/metrics.h"
#include "measure/perceived.h"

namespace lumi {
namespace {

/// What a display shows of the tone-mapped image, in linear light: clamped, since sRGB encoding and decoding cancel.
Image displayed(const Image& linear, float exposureEv) {
    Image out(linear.extent(), 3);
    const float factor = std::exp2(exposureEv);
    parallelRanges(static_cast<int64_t>(linear.size()), 1 << 15, [&](int64_t begin, int64_t end) {
        const float* in = linear.data();
        for (int64_t i = begin; i < end; ++i) out.data()[i] = glm::clamp(in[i] * factor, 0.0f, 1.0f);
    });
    return out;
}

}  // namespace

Measurement measureFlip(const ImagePair& pair, bool wantMap) {
    const FlipFeatures test = flipFeatures(displayed(pair.image, pair.exposureEv));
    const FlipFeatures reference = flipFeatures(displayed(pair.reference, pair.exposureEv));
    return meanMeasurement(flipError(test, reference), pair, wantMap);
}

}  // namespace lumi
