#include "filter/demodulation.h"

#include <algorithm>
#include <atomic>

#include "base/parallel.h"
#include "filter/demodulation_kernels.h"

namespace lumi {
namespace {

constexpr int64_t kGrain = 1 << 13;

}  // namespace

void demodulate(const Signals& signals, DemodulatedFrame& frame) {
    const Extent2 extent = signals.extent();
    for (Image* image : {&frame.emission, &frame.albedo, &frame.direct, &frame.indirect})
        if (image->extent() != extent) image->reset(extent, 3);
    if (frame.dropped.extent() != extent) frame.dropped.reset(extent, 1);
    std::atomic<int64_t> dropped{0};
    parallelRanges(extent.area(), kGrain, [&](int64_t begin, int64_t end) {
        float* bad = frame.dropped.data() + begin;
        std::fill(bad, bad + (end - begin), 0.0f);
        for (int c = 0; c < 3; ++c) {
            const auto in = [&](Signal signal) { return signals[signal].plane(c).data + begin; };
            const auto to = [&](Image& image) { return image.plane(c).data + begin; };
            demodulationKernels().divide({static_cast<int>(end - begin), in(Signal::Albedo), in(Signal::SpecularAlbedo),
                                          in(Signal::Emission), in(Signal::Direct), in(Signal::Indirect), to(frame.albedo),
                                          to(frame.emission), to(frame.direct), to(frame.indirect), bad});
        }
        dropped += std::count(bad, bad + (end - begin), 1.0f);
    });
    frame.droppedPixels = dropped;
}

void DemodulatedFrame::addComponents(Image& sum) const {
    if (sum.extent() != direct.extent()) sum.reset(direct.extent(), 3);
    parallelRanges(static_cast<int64_t>(sum.size()), kGrain, [&](int64_t begin, int64_t end) {
        for (int64_t i = begin; i < end; ++i) sum.data()[i] = direct.data()[i] + indirect.data()[i];
    });
}

size_t DemodulatedFrame::bytes() const {
    return emission.bytes() + albedo.bytes() + direct.bytes() + indirect.bytes() + dropped.bytes();
}

void remodulate(const DemodulatedFrame& frame, const Image& direct, const Image* indirect, Image& out) {
    const Extent2 extent = frame.albedo.extent();
    if (out.extent() != extent || out.channels() != 3) out.reset(extent, 3);
    parallelRanges(static_cast<int64_t>(out.size()), kGrain, [&](int64_t begin, int64_t end) {
        demodulationKernels().multiply(frame.emission.data() + begin, frame.albedo.data() + begin, direct.data() + begin,
                                       indirect ? indirect->data() + begin : nullptr, out.data() + begin, static_cast<int>(end - begin));
    });
}

}  // namespace lumi
