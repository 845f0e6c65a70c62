#pragma once
#include <vector>

#include "frame/signals.h"
#include "math/hash.h"
#include "math/statistics.h"
#include "scene/animation.h"

// Brute force for what the open shutter and the lens blur: the mean of frames at random times and places.
namespace lumi::test {

const SignalSet kMoments{Signal::Noisy, Signal::SampleVariance};

inline float number(uint32_t a, uint32_t b) { return unitFloat(hashCombine(a, b)); }

/// From one value to the other in the first second.
inline AnimationChannel channel(int node, AnimatedProperty property, int components, std::vector<float> values) {
    AnimationChannel c;
    c.node = node, c.property = property, c.components = components;
    c.times = {0, 1};
    c.values = std::move(values);
    return c;
}

/// Adds frames up as one of so many samples.
class Mean {
public:
    void add(const Signals& frame) {
        const Image& image = frame[Signal::Noisy];
        moments_.resize(image.size());
        for (size_t i = 0; i < image.size(); ++i) moments_[i].add(image.data()[i]);
    }
    Signals signals(Extent2 extent) const {
        Signals s;
        s.reset(extent, kMoments, static_cast<int>(moments_[0].count()));
        for (size_t i = 0; i < moments_.size(); ++i) {
            s[Signal::Noisy].data()[i] = static_cast<float>(moments_[i].mean());
            s[Signal::SampleVariance].data()[i] = static_cast<float>(moments_[i].sampleVariance());
        }
        return s;
    }

private:
    std::vector<RunningMoments> moments_;
};

}  // namespace lumi::test
