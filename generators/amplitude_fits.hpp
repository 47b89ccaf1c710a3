#pragma once

#include <span>

namespace ensonify {

/// Laws of a positive random amplitude, location 0, fitted to values; each with its Kolmogorov-Smirnov distance to
/// them.
struct AmplitudeFits {
  double weibull_shape = 0, weibull_scale = 0;
  double gamma_shape = 0, gamma_scale = 0;
  double lognormal_sigma = 0, lognormal_scale = 0;  ///< of ln x; median
  double nakagami_shape = 0, nakagami_scale = 0;    ///< m; root of the mean square
  double k_shape = 0;                               ///< at most most_k_shape, where the law is Rayleigh's
  struct Distance {
    double rayleigh = 0, exponential = 0, weibull = 0, gamma = 0, lognormal = 0, nakagami = 0, k = 0;
  } ks;
};

constexpr double most_k_shape = 100;

/// Shape of the Weibull law by maximum likelihood, kept within 0.01 and 1000. `logs`: ln of the values, at least one.
double fit_weibull_shape(std::span<const double> logs);

/// All laws by maximum likelihood, but K, which takes the shape nu from <x^4> / <x^2>^2 = 2 (1 + 1 / nu) (Jakeman and
/// Pusey 1976). Values must be above 0, at least two of them different.
AmplitudeFits fit_amplitudes(std::span<const double> values);

}  // namespace ensonify
