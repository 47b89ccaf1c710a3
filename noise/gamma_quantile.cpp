#include "ensonify/noise/gamma_quantile.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "ensonify/noise/random_row.hpp"

namespace ensonify {
namespace {

/// ln of the lower and upper tail of the gamma distribution: whichever is the smaller is exact to rounding (series and
/// continued fraction; Press et al. 2007, 6.2).
struct Tails {
  double log_lower, log_upper;
};

Tails gamma_tails(double a, double x) {
  const double front = a * std::log(x) - x - std::lgamma(a);
  if (x < a + 1.0) {
    double term = 1.0 / a;
    double sum = term;
    for (int n = 1; n < 2000 && term > 1e-16 * sum; ++n) {
      term *= x / (a + n);
      sum += term;
    }
    const double log_lower = front + std::log(sum);
    return {log_lower, std::log1p(-std::min(std::exp(log_lower), 1.0 - 1e-16))};
  }
  double b = x + 1.0 - a;
  double c = 1e300;
  double d = 1.0 / b;
  double h = d;
  for (int n = 1; n < 2000; ++n) {
    const double an = -n * (n - a);
    b += 2.0;
    d = 1.0 / (an * d + b);
    c = b + an / c;
    const double step = d * c;
    h *= step;
    if (std::abs(step - 1.0) < 1e-15) break;
  }
  const double log_upper = front + std::log(h);
  return {std::log1p(-std::min(std::exp(log_upper), 1.0 - 1e-16)), log_upper};
}

/// x with P(shape, x) = Phi(z), by bisection in ln x on the smaller tail.
double gamma_at_normal(double shape, double z) {
  const bool low = z < 0.0;
  const double wanted = std::log(0.5 * std::erfc(std::abs(z) / std::numbers::sqrt2));
  double below = (z < 0.0 ? -200.0 : -10.0);
  double above = std::log(shape + 60.0 + 12.0 * std::sqrt(shape));
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (below + above);
    const Tails tails = gamma_tails(shape, std::exp(middle));
    const bool too_low = low ? tails.log_lower < wanted : tails.log_upper > wanted;
    (too_low ? below : above) = middle;
  }
  return std::exp(0.5 * (below + above));
}

}  // namespace

GammaQuantile::GammaQuantile(double shape) {
  for (int i = 0; i <= steps; ++i) {
    const double z = reach * (2.0 * i / steps - 1.0);
    cube_root_[i] = static_cast<float>(std::cbrt(gamma_at_normal(shape, z) / shape));
  }
  cube_root_[steps + 1] = cube_root_[steps];
}

void GammaQuantile::apply(std::span<float> uniforms) const {
  to_normal(uniforms);
  constexpr float scale = steps / (2.0f * reach);
  for (float& u : uniforms) {
    const float place = std::min(std::max((u + reach) * scale, 0.0f), static_cast<float>(steps));
    const int i = static_cast<int>(place);
    const float root = cube_root_[i] + (place - static_cast<float>(i)) * (cube_root_[i + 1] - cube_root_[i]);
    u = root * root * root;
  }
}

}  // namespace ensonify
