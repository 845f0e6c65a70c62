#pragma once
#include <cstdint>
#include <span>
#include <vector>

namespace lumi {

/// Running mean and variance without cancellation [Welford 1962].
class RunningMoments {
public:
    void add(double x) {
        ++count_;
        const double delta = x - mean_;
        mean_ += delta / static_cast<double>(count_);
        m2_ += delta * (x - mean_);
    }
    int64_t count() const { return count_; }
    double mean() const { return mean_; }
    /// Unbiased variance of one sample; 0 for fewer than two.
    double sampleVariance() const { return count_ > 1 ? m2_ / static_cast<double>(count_ - 1) : 0; }
    /// Variance of the mean.
    double meanVariance() const { return count_ > 0 ? sampleVariance() / static_cast<double>(count_) : 0; }

private:
    int64_t count_ = 0;
    double mean_ = 0, m2_ = 0;
};

/// The middle value, or the mean of the two in the middle; 0 of none.
double median(std::vector<double> values);

/// Upper tails: the probability that a standard normal exceeds z, and that chi-square with `dof` exceeds x.
double normalTail(double z);
double chiSquareTail(double x, double dof);

/// Regularised upper incomplete gamma function Q(a, x) by series or continued fraction.
double gammaQ(double a, double x);

/// Level for each of `count` independent tests so that all together have level `alpha` [Sidak 1967].
double sidakLevel(double alpha, int64_t count);

/// Pearson's test. Cells with an expected count below 5 are pooled in order of expectation. Returns the p-value.
/// Spans have one length; `expected` sums to about the sum of `observed`.
double chiSquareTest(std::span<const double> observed, std::span<const double> expected);

}  // namespace lumi
