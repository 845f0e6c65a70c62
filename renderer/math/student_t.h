#pragma once

namespace lumi {

/// Regularised incomplete beta function I_x(a, b) for a, b > 0 and x in [0,1], by its continued fraction
/// [Abramowitz & Stegun 26.5.8] with Lentz's method.
double incompleteBeta(double a, double b, double x);

/// Upper tail of Student's t distribution: the probability that t with `dof` > 0 degrees of freedom exceeds `t`.
double studentTail(double t, double dof);

/// The t whose upper tail is `tail`, in (0, 0.5]: 12.706 for (0.025, 1), 1.96 for (0.025, infinity).
double studentQuantile(double tail, double dof);

}  // namespace lumi
