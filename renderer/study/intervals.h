#pragma once
#include <cstdint>
#include <span>
#include <vector>

namespace lumi {

/// A mean with its uncertainty. With fewer than two values nothing is known about it: `low` and `high` are NaN.
struct Interval {
    int64_t count = 0;  ///< values that went into it
    double mean = 0;
    double standardError = 0;
    double low = 0, high = 0;  ///< confidence interval of the mean

    bool known() const { return count > 1; }
    /// Is the mean surely not 0, at the interval's level?
    bool excludesZero() const { return known() && (low > 0 || high < 0); }
};

enum class IntervalMethod { StudentT, Bootstrap };

/// Mean of independent values with its two-sided interval at `level` (0.95): Student's t, or the bias-corrected and
/// accelerated bootstrap [Efron 1987] with 4000 resamples from fixed random numbers. With n values of which noise alone
/// gives all one sign more often than the level allows (2^(1-n) >= 1 - level: fewer than six at 0.95) resamples say
/// nothing, and the bootstrap's interval is Student's. Values that are not finite are missing ones: they do not count.
Interval meanInterval(std::span<const double> values, double level, IntervalMethod method = IntervalMethod::StudentT);

/// Interval of the mean difference a[i] - b[i] of values that were measured on the same samples. Pairs of which a value
/// is missing do not count.
Interval pairedInterval(std::span<const double> a, std::span<const double> b, double level,
                        IntervalMethod method = IntervalMethod::StudentT);

/// The places that a method may have in a ranking, counted from 1.
struct Rank {
    int best = 1, worst = 1;
    bool certain() const { return best == worst; }
};

/// Ranks methods by the paired differences between all pairs; each pair is tested at a level that makes `level` hold
/// for all of them together [Sidak 1967]. A method that no test tells from another shares its places. Each row of
/// `values` is one method, measured on the same units; two methods are compared over the units where both have a value.
std::vector<Rank> rankMethods(const std::vector<std::vector<double>>& values, bool higherIsBetter, double level,
                              IntervalMethod method = IntervalMethod::StudentT);

/// Mean squared error of repeated renderings of one image, in two parts: what would stay if the seeds never ended, and
/// what they average away.
struct BiasVariance {
    double meanSquaredError = 0;  ///< mean over the seeds, the reference's own noise taken off
    double squaredBias = 0;       ///< unbiased estimate: may come out a little below 0
    double variance = 0;          ///< of one rendering
};

/// `squaredErrors`: mean over pixels of (image - reference)^2, a seed each; `squaredMeanError`: mean over pixels of the
/// squared mean over the seeds of (image - reference); `referenceNoise`: the reference's own mean squared error.
BiasVariance separateBias(std::span<const double> squaredErrors, double squaredMeanError, double referenceNoise);

/// Jackknife [Quenouille 1956]: pseudo-values of a statistic that is `all` with all units and `without[k]` without unit
/// k; meanInterval() of them is the statistic's interval. None for fewer than three units.
std::vector<double> pseudoValues(double all, std::span<const double> without);

/// Slope of the least-squares line through (log x, log y); NaN with fewer than two different x or a y that is not above
/// 0.
double logLogSlope(std::span<const double> x, std::span<const double> y);

enum class Course { Rising, Falling };

/// y on the polyline through (x, y) in log-log space where x comes to `at` for the last time on a piece that takes this
/// course. Noise may let x turn back in between. NaN where x never comes there, or where a value is not above 0.
double logLogAt(std::span<const double> x, std::span<const double> y, double at, Course course = Course::Rising);

}  // namespace lumi
