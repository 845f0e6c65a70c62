#include "filter/demodulation.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "base/parallel.h"

namespace lumi {
namespace {

constexpr int64_t kGrain = 1 << 13;
constexpr float kLeastAlbedo = 0.01f;  ///< as the signals have it

/// The lobes' albedos together. An albedo of exactly 1 beside one that is smaller is the mark of an undivided lobe.
inline float combinedAlbedo(float diffuse, float specular) {
    float sum = diffuse + specular;
    if (diffuse == 1) sum = specular;
    else if (specular == 1) sum = diffuse;
    sum = sum < 1 ? sum : 1.0f;
    return sum >= kLeastAlbedo ? sum : (std::isfinite(sum) ? kLeastAlbedo : 1.0f);
}

/// The value, or 0 with `bad` set where it is no finite number.
inline float finiteOr0(float value, float& bad) {
    const bool finite = std::fabs(value) <= 3.402823466e38f;
    bad = finite ? bad : 1.0f;
    return finite ? value : 0.0f;
}

}  // namespace

void demodulate(const Signals& signals, DemodulatedFrame& frame) {
    const Extent2 extent = signals.extent();
    for (Image* image : {&frame.emission, &frame.albedo, &frame.direct, &frame.indirect})
        if (image->extent() != extent) image->reset(extent, 3);
    frame.dropped.reset(extent, 1);
    std::atomic<int64_t> dropped{0};
    parallelRanges(extent.area(), kGrain, [&](int64_t begin, int64_t end) {
        float* bad = frame.dropped.data();
        for (int c = 0; c < 3; ++c) {
            const float* diffuse = signals[Signal::Albedo].plane(c).data;
            const float* specular = signals[Signal::SpecularAlbedo].plane(c).data;
            const float* inEmission = signals[Signal::Emission].plane(c).data;
            const float* inDirect = signals[Signal::Direct].plane(c).data;
            const float* inIndirect = signals[Signal::Indirect].plane(c).data;
            float* emission = frame.emission.plane(c).data;
            float* albedo = frame.albedo.plane(c).data;
            float* direct = frame.direct.plane(c).data;
            float* indirect = frame.indirect.plane(c).data;
            for (int64_t i = begin; i < end; ++i) {
                const float a = combinedAlbedo(diffuse[i], specular[i]);
                albedo[i] = a;
                emission[i] = finiteOr0(inEmission[i], bad[i]);
                direct[i] = finiteOr0(inDirect[i] / a, bad[i]);
                indirect[i] = finiteOr0(inIndirect[i] / a, bad[i]);
            }
        }
        dropped += std::count(bad + begin, bad + end, 1.0f);
    });
    frame.droppedPixels = dropped;
}

void remodulate(const DemodulatedFrame& frame, const Image& direct, const Image* indirect, Image& out) {
    const Extent2 extent = frame.albedo.extent();
    out.reset(extent, 3);
    parallelRanges(static_cast<int64_t>(out.size()), kGrain, [&](int64_t begin, int64_t end) {
        const float* emission = frame.emission.data();
        const float* albedo = frame.albedo.data();
        const float* d = direct.data();
        for (int64_t i = begin; i < end; ++i)
            out.data()[i] = emission[i] + albedo[i] * (indirect ? d[i] + indirect->data()[i] : d[i]);
    });
}

}  // namespace lumi
