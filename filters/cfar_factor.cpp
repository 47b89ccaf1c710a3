#include <algorithm>
#include <cmath>

#include "ensonify/filters/cfar.hpp"

namespace ensonify {
namespace {

/// Order of the cell that `rank` of n cells lie at or below, 1..n.
int order(double rank, int n) { return std::clamp(static_cast<int>(std::ceil(rank * n)), 1, n); }

/// P(smaller of two sums of n cells * t < x), Gandhi and Kassam 1988, eq. 24, t on the sum.
double soca_rate(double t, int n) {
  double sum = 0, log_term = -n * std::log(2.0 + t);  // k = 0
  for (int k = 0; k < n; ++k) {
    sum += std::exp(log_term);
    log_term += std::log((n + k) / (k + 1.0)) - std::log(2.0 + t);
  }
  return 2.0 * sum;
}

/// Probability of false alarm of threshold t times the sum (os: times the cell of that order) in unit exponential
/// cells.
double false_alarms(CfarRule rule, double t, int before, int after, double rank) {
  const int n = before + after;
  if (rule == CfarRule::os) {
    double rate = 1.0;
    for (int i = 0; i < order(rank, n); ++i) rate *= (n - i) / (n - i + t);
    return rate;
  }
  const int half = std::min(before, after);
  if (rule == CfarRule::ca || half == 0) return std::pow(1.0 + t, -n);
  const double smaller = soca_rate(t, half);
  return rule == CfarRule::soca ? smaller : 2.0 * std::pow(1.0 + t, -half) - smaller;
}

}  // namespace

double cfar_factor(CfarRule rule, int before, int after, double pfa, double rank) {
  double low = 0.0, high = 1.0;
  while (false_alarms(rule, high, before, after, rank) > pfa && high < 1e12) high *= 2.0;
  for (int step = 0; step < 100; ++step) {
    const double middle = 0.5 * (low + high);
    (false_alarms(rule, middle, before, after, rank) > pfa ? low : high) = middle;
  }
  if (rule == CfarRule::os) return high;
  // From a factor on the sum to one on the mean.
  const int half = std::min(before, after);
  return high * (rule == CfarRule::ca || half == 0 ? before + after : half);
}

}  // namespace ensonify
