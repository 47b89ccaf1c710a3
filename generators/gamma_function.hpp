#pragma once

namespace ensonify {

/// Derivative of ln Gamma(x), x > 0. Absolute error below 1e-12 (Abramowitz and Stegun 6.3.5, 6.3.18).
double digamma(double x);

/// P(a, x), the regularised lower incomplete gamma function: the distribution function of a gamma variable of shape
/// a > 0 and scale 1. Series below a + 1, continued fraction above (Abramowitz and Stegun 6.5.29, 6.5.31); about 1e-12.
double gamma_distribution(double a, double x);

/// ln Gamma(x), x > 0; unlike std::lgamma it writes no global.
double log_gamma(double x);

}  // namespace ensonify
