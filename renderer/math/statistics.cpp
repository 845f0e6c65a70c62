#include "math/statistics.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>
#include <vector>

namespace lumi {
namespace {

/// Lower incomplete gamma by its power series, for x < a + 1.
double gammaPSeries(double a, double x) {
    double term = 1 / a, sum = term;
    for (int n = 1; n < 10000 && std::abs(term) > std::abs(sum) * 1e-15; ++n) {
        term *= x / (a + n);
        sum += term;
    }
    return sum * std::exp(-x + a * std::log(x) - std::lgamma(a));
}

/// Upper incomplete gamma by Lentz's continued fraction, for x >= a + 1.
double gammaQFraction(double a, double x) {
    const double tiny = 1e-300;
    double b = x + 1 - a, c = 1 / tiny, d = 1 / b, h = d;
    for (int n = 1; n < 10000; ++n) {
        const double an = -n * (n - a);
        b += 2;
        d = an * d + b;
        if (std::abs(d) < tiny) d = tiny;
        c = b + an / c;
        if (std::abs(c) < tiny) c = tiny;
        d = 1 / d;
        const double factor = d * c;
        h *= factor;
        if (std::abs(factor - 1) < 1e-15) break;
    }
    return std::exp(-x + a * std::log(x) - std::lgamma(a)) * h;
}

}  // namespace

double median(std::vector<double> values) {
    if (values.empty()) return 0;
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return values.size() % 2 ? *middle : 0.5 * (*middle + *std::max_element(values.begin(), middle));
}

double normalTail(double z) { return 0.5 * std::erfc(z / std::sqrt(2.0)); }

double gammaQ(double a, double x) {
    assert(a > 0 && x >= 0);
    if (x <= 0) return 1;
    return x < a + 1 ? 1 - gammaPSeries(a, x) : gammaQFraction(a, x);
}

double chiSquareTail(double x, double dof) { return gammaQ(dof / 2, x / 2); }

double sidakLevel(double alpha, int64_t count) { return -std::expm1(std::log1p(-alpha) / static_cast<double>(count)); }

double chiSquareTest(std::span<const double> observed, std::span<const double> expected) {
    assert(observed.size() == expected.size());
    std::vector<size_t> order(observed.size());
    std::iota(order.begin(), order.end(), size_t(0));
    std::sort(order.begin(), order.end(), [&](size_t a, size_t b) { return expected[a] < expected[b]; });

    double statistic = 0, pooledObserved = 0, pooledExpected = 0;
    int cells = 0;
    for (const size_t cell : order) {
        // A cell that cannot happen and did: no distribution fits.
        if (expected[cell] <= 0) {
            if (observed[cell] > 0) return 0;
            continue;
        }
        pooledObserved += observed[cell];
        pooledExpected += expected[cell];
        if (pooledExpected < 5) continue;
        const double difference = pooledObserved - pooledExpected;
        statistic += difference * difference / pooledExpected;
        pooledObserved = pooledExpected = 0;
        ++cells;
    }
    return cells > 1 ? chiSquareTail(statistic, cells - 1) : 1;
}

}  // namespace lumi
