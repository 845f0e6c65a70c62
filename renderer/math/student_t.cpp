#include "math/student_t.h"

#include <cassert>
#include <cmath>

namespace lumi {
namespace {

/// The continued fraction of I_x(a, b); converges fast for x < (a + 1) / (a + b + 2).
double betaFraction(double a, double b, double x) {
    const double tiny = 1e-300;
    const auto away = [&](double value) { return std::abs(value) < tiny ? tiny : value; };
    double c = 1, d = 1 / away(1 - (a + b) * x / (a + 1)), h = d;
    for (int m = 1; m < 10000; ++m) {
        const double even = m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m));
        d = 1 / away(1 + even * d);
        c = away(1 + even / c);
        h *= d * c;
        const double odd = -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1));
        d = 1 / away(1 + odd * d);
        c = away(1 + odd / c);
        const double factor = d * c;
        h *= factor;
        if (std::abs(factor - 1) < 1e-15) break;
    }
    return h;
}

}  // namespace

double incompleteBeta(double a, double b, double x) {
    assert(a > 0 && b > 0);
    if (x <= 0) return 0;
    if (x >= 1) return 1;
    const double front =
        std::exp(std::lgamma(a + b) - std::lgamma(a) - std::lgamma(b) + a * std::log(x) + b * std::log1p(-x));
    if (x < (a + 1) / (a + b + 2)) return front * betaFraction(a, b, x) / a;
    return 1 - front * betaFraction(b, a, 1 - x) / b;
}

double studentTail(double t, double dof) {
    if (std::isinf(dof)) return 0.5 * std::erfc(t / std::sqrt(2.0));
    const double both = incompleteBeta(dof / 2, 0.5, dof / (dof + t * t));
    return t >= 0 ? both / 2 : 1 - both / 2;
}

double studentQuantile(double tail, double dof) {
    assert(tail > 0 && tail <= 0.5);
    double low = 0, high = 1;
    while (studentTail(high, dof) > tail && high < 1e300) high *= 2;
    for (int i = 0; i < 200 && high - low > 1e-14 * high; ++i) {
        const double middle = 0.5 * (low + high);
        (studentTail(middle, dof) > tail ? low : high) = middle;
    }
    return 0.5 * (low + high);
}

}  // namespace lumi
