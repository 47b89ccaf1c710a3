#include "ensonify/noise/gamma_quantile.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "ensonify/core/gamma_function.hpp"
#include "ensonify/noise/random_row.hpp"

namespace ensonify {
namespace {

/// The gamma distribution of one shape.
class Gamma {
 public:
  explicit Gamma(double shape) : shape_(shape), log_gamma_(log_gamma(shape)) {}

  /// ln x with P(shape, x) = Phi(z), from a guess near it: Newton's steps on the logarithm of the smaller tail, which
  /// is concave in ln x.
  double log_quantile(double z, double guess) const {
    const bool low = z < 0.0;
    const double wanted = std::log(0.5 * std::erfc(std::abs(z) / std::numbers::sqrt2));
    double y = guess;
    for (int i = 0; i < 50; ++i) {
      const double log_density = shape_ * y - std::exp(y) - log_gamma_;  // of ln x
      const double log_tail = low ? log_lower(y, log_density) : log_upper(y, log_density);
      const double slope = std::exp(log_density - log_tail) * (low ? 1.0 : -1.0);
      const double step = std::clamp((wanted - log_tail) / slope, -2.0, 2.0);
      y += step;
      if (std::abs(step) < 1e-9) break;
    }
    return y;
  }

 private:
  // Each tail by the one of series and fraction that converges.
  double log_lower(double y, double log_density) const {
    const double x = std::exp(y);
    return x < shape_ + 1.0 ? log_density + log_series(x) : other(log_density + log_fraction(x));
  }
  double log_upper(double y, double log_density) const {
    const double x = std::exp(y);
    return x < shape_ + 1.0 ? other(log_density + log_series(x)) : log_density + log_fraction(x);
  }
  static double other(double log_tail) { return std::log1p(-std::min(std::exp(log_tail), 1.0 - 1e-16)); }
  double log_series(double x) const { return std::log(gamma_series(shape_, x, close)); }
  double log_fraction(double x) const { return std::log(gamma_fraction(shape_, x, close)); }

  static constexpr double close = 1e-12;
  double shape_, log_gamma_;
};

}  // namespace

GammaQuantile::GammaQuantile(double shape) {
  const Gamma gamma(shape);
  // From the middle outwards, so that every point begins near its neighbour's solution.
  const double middle = gamma.log_quantile(0.0, std::log(shape > 1.0 ? shape : 0.5 * shape));
  for (const int way : {-1, 1}) {
    double y = middle;
    for (int i = steps / 2; i >= 0 && i <= steps; i += way) {
      y = gamma.log_quantile(reach * (2.0 * i / steps - 1.0), y);
      cube_root_[i] = static_cast<float>(std::cbrt(std::exp(y) / shape));
    }
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
