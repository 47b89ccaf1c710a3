#include "ensonify/core/gamma_function.hpp"

#include <math.h>

#include <cmath>
#include <limits>

namespace ensonify {
namespace {

constexpr int most_terms = 100'000;

}  // namespace

double log_gamma(double x) {
  int sign = 0;
  return ::lgamma_r(x, &sign);
}

double digamma(double x) {
  double below = 0;
  for (; x < 10; x += 1) below -= 1 / x;
  const double y = 1 / (x * x);
  const double series = y * (1.0 / 12 - y * (1.0 / 120 - y * (1.0 / 252 - y * (1.0 / 240 - y * (5.0 / 660)))));
  return below + std::log(x) - 0.5 / x - series;
}

double gamma_series(double a, double x, double close) {
  double term = 1 / a, sum = term;
  for (int n = 1; n < most_terms && term > close * sum; ++n) {
    term *= x / (a + n);
    sum += term;
  }
  return sum;
}

double gamma_fraction(double a, double x, double close) {
  // Lentz's method, as modified by Thompson and Barnett (1986).
  const double tiny = std::numeric_limits<double>::min() / close;
  double b = x + 1 - a, c = 1 / tiny, d = 1 / b, fraction = d;
  for (int n = 1; n < most_terms; ++n) {
    const double numerator = -n * (n - a);
    b += 2;
    const double below = numerator * d + b, ratio = b + numerator / c;
    d = 1 / (std::abs(below) < tiny ? tiny : below);
    c = std::abs(ratio) < tiny ? tiny : ratio;
    fraction *= d * c;
    if (std::abs(d * c - 1) < close) break;
  }
  return fraction;
}

double gamma_distribution(double a, double x) {
  if (!(x > 0)) return 0;
  constexpr double close = 1e-14;
  const double scale = std::exp(a * std::log(x) - x - log_gamma(a));
  return x < a + 1 ? scale * gamma_series(a, x, close) : 1 - scale * gamma_fraction(a, x, close);
}

}  // namespace ensonify
