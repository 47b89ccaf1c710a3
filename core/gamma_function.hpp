#pragma once

namespace ensonify {

/// Derivative of ln Gamma(x), x > 0. Absolute error below 1e-12 (Abramowitz and Stegun 6.3.5, 6.3.18).
double digamma(double x);

/// P(a, x), the regularised lower incomplete gamma function: the distribution function of a gamma variable of shape
/// a > 0 and scale 1. Series below a + 1, continued fraction above; about 1e-12.
double gamma_distribution(double a, double x);

/// The two, to a relative step below `close`: P(a, x) = density gamma_series and 1 - P(a, x) = density gamma_fraction,
/// where density = exp(a ln x - x - ln Gamma(a)). The series is quick below a + 1, the fraction above (Abramowitz and
/// Stegun 6.5.29, 6.5.31).
double gamma_series(double a, double x, double close);
double gamma_fraction(double a, double x, double close);

/// ln Gamma(x), x > 0. Unlike std::lgamma it writes no global, so that threads may call it at once.
double log_gamma(double x);

}  // namespace ensonify
