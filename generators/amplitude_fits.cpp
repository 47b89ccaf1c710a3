#include "ensonify/generators/amplitude_fits.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <vector>

#include "ensonify/core/gamma_function.hpp"

namespace ensonify {
namespace {

/// Greatest distance between a law and the steps of sorted values.
template <typename Law>
double ks_distance(std::span<const double> sorted, const Law& law) {
  const auto n = static_cast<double>(sorted.size());
  double worst = 0;
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    const double p = law(sorted[i]);
    worst = std::max({worst, p - static_cast<double>(i) / n, static_cast<double>(i + 1) / n - p});
  }
  return worst;
}

/// Where a rising function passes through 0, between positive bounds.
template <typename Function>
double root(double low, double high, const Function& rising) {
  for (int i = 0; i < 100; ++i) {
    const double middle = std::sqrt(low * high);
    (rising(middle) < 0 ? low : high) = middle;
  }
  return low;
}

/// Maximum likelihood: ln k - digamma(k) = ln <x> - <ln x>.
double fit_gamma_shape(double mean, double mean_log) {
  const double spread = std::log(mean) - mean_log;
  return root(1e-3, 1e6, [&](double k) { return spread - (std::log(k) - digamma(k)); });
}

/// Distribution function of the K law of mean square 1.
double k_distribution(double shape, double x) {
  const double z = 2 * std::sqrt(shape) * x;
  if (!(z > 0)) return 0;
  if (z > 600) return 1;  // where K underflows
  const double bessel = std::cyl_bessel_k(shape, z);
  if (!std::isfinite(bessel)) return 0;
  return 1 - std::exp(std::numbers::ln2 - log_gamma(shape) + shape * std::log(z / 2) + std::log(bessel));
}

}  // namespace

double fit_weibull_shape(std::span<const double> logs) {
  const auto n = static_cast<double>(logs.size());
  const double mean_log = std::accumulate(logs.begin(), logs.end(), 0.0) / n;
  const double top = *std::max_element(logs.begin(), logs.end());
  double low = 0.01, high = 1000;
  double k = 1;
  // Newton's steps on the equation of the likelihood, which rises with k; halving where a step leads out.
  for (int i = 0; i < 200; ++i) {
    double sum = 0, first = 0, second = 0;
    for (const double log : logs) {
      const double weight = std::exp(k * (log - top)), d = log - mean_log;
      sum += weight;
      first += weight * d;
      second += weight * d * d;
    }
    const double mean = first / sum, excess = mean - 1 / k;
    (excess < 0 ? low : high) = k;
    double next = k - excess / (second / sum - mean * mean + 1 / (k * k));
    if (!(next > low && next < high)) next = std::sqrt(low * high);
    if (std::abs(next - k) < 1e-10 * k) return next;
    k = next;
  }
  return k;
}

AmplitudeFits fit_amplitudes(std::span<const double> values) {
  std::vector<double> sorted(values.begin(), values.end());
  std::sort(sorted.begin(), sorted.end());
  std::vector<double> logs(sorted.size());
  std::transform(sorted.begin(), sorted.end(), logs.begin(), [](double x) { return std::log(x); });
  const auto mean_of = [&](const auto& function) {
    double sum = 0;
    for (const double x : sorted) sum += function(x);
    return sum / static_cast<double>(sorted.size());
  };
  const double mean = mean_of([](double x) { return x; });
  const double square = mean_of([](double x) { return x * x; });
  const double fourth = mean_of([](double x) { return x * x * x * x; });
  const double mean_log = std::accumulate(logs.begin(), logs.end(), 0.0) / static_cast<double>(logs.size());

  AmplitudeFits f;
  f.weibull_shape = fit_weibull_shape(logs);
  f.weibull_scale = std::pow(mean_of([&](double x) { return std::pow(x, f.weibull_shape); }), 1 / f.weibull_shape);
  f.gamma_shape = fit_gamma_shape(mean, mean_log);
  f.gamma_scale = mean / f.gamma_shape;
  f.lognormal_scale = std::exp(mean_log);
  for (const double log : logs) f.lognormal_sigma += (log - mean_log) * (log - mean_log);
  f.lognormal_sigma = std::sqrt(f.lognormal_sigma / static_cast<double>(logs.size()));
  f.nakagami_shape = fit_gamma_shape(square, 2 * mean_log);  // the square is of the gamma law
  f.nakagami_scale = std::sqrt(square);
  const double excess = fourth / (square * square) / 2 - 1;
  f.k_shape = excess > 1 / most_k_shape ? 1 / excess : most_k_shape;

  const auto rayleigh = [&](double x) { return -std::expm1(-x * x / square); };
  f.ks.rayleigh = ks_distance(sorted, rayleigh);
  f.ks.exponential = ks_distance(sorted, [&](double x) { return -std::expm1(-x / mean); });
  f.ks.weibull =
      ks_distance(sorted, [&](double x) { return -std::expm1(-std::pow(x / f.weibull_scale, f.weibull_shape)); });
  f.ks.gamma = ks_distance(sorted, [&](double x) { return gamma_distribution(f.gamma_shape, x / f.gamma_scale); });
  f.ks.lognormal = ks_distance(sorted, [&](double x) {
    return 0.5 * std::erfc(-(std::log(x) - mean_log) / (f.lognormal_sigma * std::numbers::sqrt2));
  });
  f.ks.nakagami = ks_distance(
      sorted, [&](double x) { return gamma_distribution(f.nakagami_shape, f.nakagami_shape * x * x / square); });
  f.ks.k = f.k_shape < most_k_shape
               ? ks_distance(sorted, [&](double x) { return k_distribution(f.k_shape, x / f.nakagami_scale); })
               : f.ks.rayleigh;
  return f;
}

}  // namespace ensonify
