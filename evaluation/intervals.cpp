#include "ensonify/evaluation/intervals.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace ensonify {
namespace {

constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

/// 97.5 % point of Student's t: tabulated up to 4 degrees of freedom, from there on Abramowitz and Stegun 26.7.5, right
/// to 0.1 %.
double student_975(int degrees) {
  constexpr std::array table{12.7062, 4.3027, 3.1824, 2.7764};
  if (degrees <= static_cast<int>(table.size())) return table[static_cast<std::size_t>(degrees) - 1];
  const double z = 1.959964, n = degrees;
  const double z3 = z * z * z, z5 = z3 * z * z, z7 = z5 * z * z;
  return z + (z3 + z) / (4 * n) + (5 * z5 + 16 * z3 + 3 * z) / (96 * n * n) +
         (3 * z7 + 19 * z5 + 17 * z3 - 15 * z) / (384 * n * n * n);
}

double percentile_of(const std::vector<double>& sorted, double share) {
  const double at = share * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(at);
  const auto above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (at - static_cast<double>(below)) * (sorted[above] - sorted[below]);
}

}  // namespace

Estimate mean_estimate(std::span<const double> values) {
  double sum = 0, squares = 0;
  int n = 0;
  for (const double v : values) {
    if (!std::isfinite(v)) continue;
    sum += v;
    ++n;
  }
  if (n == 0) return {nothing, nothing, nothing, 0};
  const double mean = sum / n;
  if (n == 1) return {mean, nothing, nothing, 1};
  for (const double v : values) {
    if (std::isfinite(v)) squares += (v - mean) * (v - mean);
  }
  const double half = student_975(n - 1) * std::sqrt(squares / (n - 1) / n);
  return {mean, mean - half, mean + half, n};
}

Estimate bootstrap_estimate(int frames, RandomKey key, const std::function<double(std::span<const int>)>& statistic) {
  constexpr int resamples = 1000;
  std::vector<int> weights(static_cast<std::size_t>(frames), 1);
  Estimate estimate{statistic(weights), nothing, nothing, frames};
  if (frames < 2) return estimate;
  RandomSequence random(key);
  std::vector<double> values;
  for (int i = 0; i < resamples; ++i) {
    std::ranges::fill(weights, 0);
    for (int f = 0; f < frames; ++f) ++weights[static_cast<std::size_t>(random.below(frames))];
    if (const double value = statistic(weights); std::isfinite(value)) values.push_back(value);
  }
  if (values.empty()) return estimate;
  std::ranges::sort(values);
  estimate.low = percentile_of(values, 0.025);
  estimate.high = percentile_of(values, 0.975);
  return estimate;
}

}  // namespace ensonify
