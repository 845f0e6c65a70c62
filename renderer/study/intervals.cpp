#include "study/intervals.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "math/hash.h"
#include "math/statistics.h"
#include "math/student_t.h"

namespace lumi {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr int kResamples = 4000;

double meanOf(std::span<const double> values) {
    double sum = 0;
    for (const double value : values) sum += value;
    return sum / static_cast<double>(values.size());
}

/// The z whose upper tail is `tail`.
double normalQuantile(double tail) {
    const double infinite = std::numeric_limits<double>::infinity();
    return tail <= 0.5 ? studentQuantile(std::max(tail, 1e-12), infinite)
                       : -studentQuantile(std::max(1 - tail, 1e-12), infinite);
}

/// Skewness of the mean's leave-one-out values: the acceleration of the bootstrap interval.
double acceleration(std::span<const double> values, double mean) {
    const double n = static_cast<double>(values.size());
    double squares = 0, cubes = 0;
    for (const double value : values) {
        const double deviation = (value - mean) / (n - 1);
        squares += deviation * deviation;
        cubes += deviation * deviation * deviation;
    }
    return squares > 0 ? cubes / (6 * std::pow(squares, 1.5)) : 0;
}

void bootstrap(std::span<const double> values, double level, Interval& interval) {
    const uint32_t count = static_cast<uint32_t>(values.size());
    std::vector<double> means(kResamples);
    uint64_t drawn = 0;
    for (double& mean : means) {
        double sum = 0;
        for (uint32_t i = 0; i < count; ++i) {
            sum += values[static_cast<size_t>(((mixBits(drawn++) >> 32) * count) >> 32)];
        }
        mean = sum / count;
    }
    std::sort(means.begin(), means.end());
    const auto below = std::lower_bound(means.begin(), means.end(), interval.mean) - means.begin();
    const auto upTo = std::upper_bound(means.begin(), means.end(), interval.mean) - means.begin();
    const double share =
        std::clamp(0.5 * static_cast<double>(below + upTo) / kResamples, 0.5 / kResamples, 1 - 0.5 / kResamples);
    const double bias = normalQuantile(1 - share);
    const double a = acceleration(values, interval.mean);
    const auto end = [&](double tail) {
        const double z = bias - normalQuantile(tail);
        const double corrected = 1 - normalTail(bias + z / (1 - a * z));
        const double index = std::clamp(corrected * kResamples, 0.0, kResamples - 1.0);
        return means[static_cast<size_t>(index)];
    };
    interval.low = end((1 - level) / 2);
    interval.high = end(1 - (1 - level) / 2);
}

/// Are there enough values for resamples to say something at this level? With n of them every mean of a resample has
/// one sign wherever all values have, and noise alone gives them one in 2^(1-n) of all cases.
bool canResample(size_t count, double level) {
    return std::ldexp(1.0, 1 - static_cast<int>(std::min<size_t>(count, 64))) < 1 - level;
}

std::vector<double> finiteOf(std::span<const double> values) {
    std::vector<double> finite;
    for (const double value : values)
        if (std::isfinite(value)) finite.push_back(value);
    return finite;
}

}  // namespace

Interval meanInterval(std::span<const double> all, double level, IntervalMethod method) {
    const std::vector<double> values = finiteOf(all);
    Interval interval;
    interval.count = static_cast<int64_t>(values.size());
    if (values.empty()) {
        interval.mean = interval.standardError = interval.low = interval.high = kNaN;
        return interval;
    }
    RunningMoments moments;
    for (const double value : values) moments.add(value);
    interval.mean = meanOf(values);
    interval.standardError = values.size() > 1 ? std::sqrt(moments.meanVariance()) : kNaN;
    if (values.size() < 2) {
        interval.low = interval.high = kNaN;
    } else if (method == IntervalMethod::Bootstrap && canResample(values.size(), level)) {
        bootstrap(values, level, interval);
    } else {
        const double half =
            studentQuantile((1 - level) / 2, static_cast<double>(values.size() - 1)) * interval.standardError;
        interval.low = interval.mean - half;
        interval.high = interval.mean + half;
    }
    return interval;
}

Interval pairedInterval(std::span<const double> a, std::span<const double> b, double level, IntervalMethod method) {
    assert(a.size() == b.size());
    std::vector<double> differences(a.size());
    for (size_t i = 0; i < a.size(); ++i) differences[i] = a[i] - b[i];
    return meanInterval(differences, level, method);
}

std::vector<Rank> rankMethods(const std::vector<std::vector<double>>& values, bool higherIsBetter, double level,
                              IntervalMethod method) {
    const int count = static_cast<int>(values.size());
    std::vector<Rank> ranks(values.size(), Rank{1, std::max(count, 1)});
    const double pairLevel = 1 - sidakLevel(1 - level, std::max<int64_t>(int64_t(count) * (count - 1) / 2, 1));
    for (int i = 0; i < count; ++i)
        for (int j = i + 1; j < count; ++j) {
            const size_t a = static_cast<size_t>(i), b = static_cast<size_t>(j);
            const Interval difference = pairedInterval(values[a], values[b], pairLevel, method);
            if (!difference.excludesZero()) continue;
            const bool firstIsBetter = (difference.mean > 0) == higherIsBetter;
            ++ranks[firstIsBetter ? b : a].best;
            --ranks[firstIsBetter ? a : b].worst;
        }
    return ranks;
}

std::vector<double> pseudoValues(double all, std::span<const double> without) {
    std::vector<double> values;
    if (without.size() < 3) return values;
    const double n = static_cast<double>(without.size());
    for (const double other : without) values.push_back(n * all - (n - 1) * other);
    return values;
}

BiasVariance separateBias(std::span<const double> squaredErrors, double squaredMeanError, double referenceNoise) {
    const double n = static_cast<double>(squaredErrors.size());
    const double mean = meanOf(squaredErrors);
    BiasVariance result;
    result.meanSquaredError = mean - referenceNoise;
    // The squared mean error holds the squared bias, the reference's noise and 1/n of the variance.
    result.variance = squaredErrors.size() > 1 ? (mean - squaredMeanError) * n / (n - 1) : kNaN;
    result.squaredBias = squaredErrors.size() > 1 ? squaredMeanError - result.variance / n - referenceNoise : kNaN;
    return result;
}

double logLogSlope(std::span<const double> x, std::span<const double> y) {
    assert(x.size() == y.size());
    double meanX = 0, meanY = 0;
    for (size_t i = 0; i < x.size(); ++i) {
        if (!(x[i] > 0) || !(y[i] > 0)) return kNaN;
        meanX += std::log(x[i]);
        meanY += std::log(y[i]);
    }
    const double n = static_cast<double>(x.size());
    meanX /= n, meanY /= n;
    double xx = 0, xy = 0;
    for (size_t i = 0; i < x.size(); ++i) {
        const double dx = std::log(x[i]) - meanX;
        xx += dx * dx;
        xy += dx * (std::log(y[i]) - meanY);
    }
    return xx > 0 ? xy / xx : kNaN;
}

double logLogAt(std::span<const double> x, std::span<const double> y, double at, Course course) {
    assert(x.size() == y.size());
    for (size_t i = x.size(); i-- > 0;) {
        if (x[i] == at) return y[i];
        if (i == 0) break;
        const bool reached = course == Course::Rising ? x[i - 1] <= at && at <= x[i] : x[i - 1] >= at && at >= x[i];
        if (!reached) continue;
        if (!(x[i - 1] > 0) || !(y[i - 1] > 0) || !(y[i] > 0)) return kNaN;
        const double t = std::log(at / x[i - 1]) / std::log(x[i] / x[i - 1]);
        return std::exp((1 - t) * std::log(y[i - 1]) + t * std::log(y[i]));
    }
    return kNaN;
}

}  // namespace lumi
