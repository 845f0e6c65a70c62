#pragma once
#include <algorithm>
#include <cmath>

#include "frame/signals.h"
#include "math/statistics.h"

namespace lumi::test {

/// Two renderings of one scene by independent samples: does every pixel's mean agree? A z-test a pixel and channel at a
/// level that Sidak's correction makes 1% over the image; sample variances below 1e-4 count as 1e-4 (Mitsuba's test).
/// Returns the share of pixels that pass. Both need Noisy and SampleVariance.
inline double agreeingShare(const Signals& a, const Signals& b) {
    const Image &meanA = a[Signal::Noisy], &meanB = b[Signal::Noisy];
    const Image &varA = a[Signal::SampleVariance], &varB = b[Signal::SampleVariance];
    const double level = sidakLevel(0.01, static_cast<int64_t>(meanA.size()));
    size_t passed = 0;
    for (size_t i = 0; i < meanA.size(); ++i) {
        const double variance = std::max(1e-4, double(varA.data()[i])) / a.samplesPerPixel() +
                                std::max(1e-4, double(varB.data()[i])) / b.samplesPerPixel();
        const double z = std::abs(double(meanA.data()[i]) - double(meanB.data()[i])) / std::sqrt(variance);
        passed += 2 * normalTail(z) > level;
    }
    return static_cast<double>(passed) / static_cast<double>(meanA.size());
}

/// Mean over all pixels of a colour image's difference, in standard errors of that mean: finds a bias that no single
/// pixel shows.
inline double biasInSigmas(const Signals& a, const Signals& b) {
    const Image &meanA = a[Signal::Noisy], &meanB = b[Signal::Noisy];
    double difference = 0, variance = 0;
    for (size_t i = 0; i < meanA.size(); ++i) {
        difference += double(meanA.data()[i]) - double(meanB.data()[i]);
        variance += double(a[Signal::SampleVariance].data()[i]) / a.samplesPerPixel() +
                    double(b[Signal::SampleVariance].data()[i]) / b.samplesPerPixel();
    }
    // The three channels of a pixel are one sample: at most three times the variance of independent ones.
    return difference / std::sqrt(3 * variance + 1e-12);
}

}  // namespace lumi::test
