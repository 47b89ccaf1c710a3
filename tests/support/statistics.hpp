#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

/// Statistics for tests, told apart from the product's own.
namespace ensonify::test {

/// Largest distance between the empirical distribution and `cdf`.
template <typename Cdf>
double ks_distance(std::vector<double> x, const Cdf& cdf) {
  std::sort(x.begin(), x.end());
  const auto n = static_cast<double>(x.size());
  double distance = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double p = cdf(x[i]);
    distance = std::max({distance, p - static_cast<double>(i) / n, static_cast<double>(i + 1) / n - p});
  }
  return distance;
}

/// Critical Kolmogorov-Smirnov distance of n independent values at alpha = 0.001: sqrt(-ln(alpha / 2) / 2 / n).
inline double ks_critical(double n) { return 1.9495 / std::sqrt(n); }

inline double mean_of(const std::vector<double>& x) {
  double sum = 0;
  for (const double v : x) sum += v;
  return sum / static_cast<double>(x.size());
}

/// <x^2> / <x>^2.
inline double moment_ratio(const std::vector<double>& x) {
  double squares = 0;
  for (const double v : x) squares += v * v;
  const double mean = mean_of(x);
  return squares / static_cast<double>(x.size()) / (mean * mean);
}

inline double correlation_of(const std::vector<double>& a, const std::vector<double>& b) {
  const double ma = mean_of(a);
  const double mb = mean_of(b);
  double ab = 0, aa = 0, bb = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    ab += (a[i] - ma) * (b[i] - mb);
    aa += (a[i] - ma) * (a[i] - ma);
    bb += (b[i] - mb) * (b[i] - mb);
  }
  return ab / std::sqrt(aa * bb);
}

/// Regularised lower incomplete gamma function by its series: an oracle for shapes and arguments of some tens.
inline double gamma_cdf(double shape, double x) {
  if (x <= 0) return 0.0;
  double term = 1.0 / shape;
  double sum = term;
  for (int n = 1; n < 10000 && term > 1e-17 * sum; ++n) {
    term *= x / (shape + n);
    sum += term;
  }
  return std::min(1.0, sum * std::exp(shape * std::log(x) - x - std::lgamma(shape)));
}

}  // namespace ensonify::test
