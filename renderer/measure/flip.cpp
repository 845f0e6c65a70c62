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
    for (size_t i = 0; i < linear.size(); ++i)
        out.data()[i] = glm::clamp(linear.data()[i] * factor, 0.0f, 1.0f);
    return out;
}

}  // namespace

Measurement measureFlip(const ImagePair& pair, bool wantMap) {
    Measurement result;
    const FlipFeatures test = flipFeatures(displayed(pair.image, pair.exposureEv));
    const FlipFeatures reference = flipFeatures(displayed(pair.reference, pair.exposureEv));
    Image error = flipError(test, reference);
    result.value = meanOverMask(error, pair);
    if (wantMap) {
        clearUncounted(error, pair);
        result.map = std::move(error);
    }
    return result;
}

}  // namespace lumi
