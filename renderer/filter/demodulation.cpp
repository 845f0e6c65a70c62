#include "filter/demodulation.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "base/parallel.h"
#include "filter/combined_albedo.h"
#include "filter/demodulation_kernels.h"

namespace lumi {
namespace {

constexpr int64_t kGrain = 1 << 13;

bool isFinite(const Image& image, int x, int y) {
    return std::isfinite(image.at(0, x, y)) && std::isfinite(image.at(1, x, y)) && std::isfinite(image.at(2, x, y));
}

void fillEmission(const Image& input, DemodulatedFrame& frame) {
    for (int y = 0; y < input.height(); ++y)
        for (int x = 0; x < input.width(); ++x) {
            if (frame.dropped.at(0, x, y) == 0 || isFinite(input, x, y)) continue;
            float sum[3] = {0, 0, 0}, count = 0;
            for (int j = std::max(y - 1, 0); j <= std::min(y + 1, input.height() - 1); ++j)
                for (int i = std::max(x - 1, 0); i <= std::min(x + 1, input.width() - 1); ++i) {
                    if (!isFinite(input, i, j)) continue;
                    for (int c = 0; c < 3; ++c) sum[c] += input.at(c, i, j);
                    ++count;
                }
            for (int c = 0; c < 3; ++c) frame.emission.at(c, x, y) = count > 0 ? sum[c] / count : 0;
        }
}

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
                                          in(Signal::Emission), in(Signal::Direct), in(Signal::Indirect),
                                          to(frame.albedo), to(frame.emission), to(frame.direct), to(frame.indirect),
                                          bad});
        }
        dropped += std::count(bad, bad + (end - begin), 1.0f);
    });
    frame.droppedPixels = dropped;
    if (dropped > 0) fillEmission(signals[Signal::Emission], frame);
}

namespace {

bool seesSurface(const DemodulatedFrame& frame, int x, int y) {
    float least = 0;
    for (int c = 0; c < 3; ++c)
        least = std::max({least, frame.albedo.at(c, x, y) - kLeastAlbedo, std::abs(frame.direct.at(c, x, y)),
                          std::abs(frame.indirect.at(c, x, y))});
    return least > 0;
}

bool wasDropped(const Image& input, const DemodulatedFrame& frame, int x, int y) {
    for (int c = 0; c < 3; ++c)
        if (!std::isfinite(input.at(c, x, y) / frame.albedo.at(c, x, y))) return true;
    return false;
}

void fillFromNeighbours(const DemodulatedFrame& frame, Image& component, int x, int y) {
    float sum[3] = {0, 0, 0}, count = 0;
    for (int j = std::max(y - 1, 0); j <= std::min(y + 1, component.height() - 1); ++j)
        for (int i = std::max(x - 1, 0); i <= std::min(x + 1, component.width() - 1); ++i) {
            if (frame.dropped.at(0, i, j) != 0 || !seesSurface(frame, i, j)) continue;
            for (int c = 0; c < 3; ++c) sum[c] += component.at(c, i, j);
            ++count;
        }
    for (int c = 0; c < 3; ++c) component.at(c, x, y) = count > 0 ? sum[c] / count : 0;
}

}  // namespace

void fillDropped(const Signals& signals, DemodulatedFrame& frame) {
    if (frame.droppedPixels == 0) return;
    for (int y = 0; y < frame.dropped.height(); ++y)
        for (int x = 0; x < frame.dropped.width(); ++x) {
            if (frame.dropped.at(0, x, y) == 0) continue;
            if (wasDropped(signals[Signal::Direct], frame, x, y)) fillFromNeighbours(frame, frame.direct, x, y);
            if (wasDropped(signals[Signal::Indirect], frame, x, y)) fillFromNeighbours(frame, frame.indirect, x, y);
        }
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
        demodulationKernels().multiply(frame.emission.data() + begin, frame.albedo.data() + begin,
                                       direct.data() + begin, indirect ? indirect->data() + begin : nullptr,
                                       out.data() + begin, static_cast<int>(end - begin));
    });
}

}  // namespace lumi
