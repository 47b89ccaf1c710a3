// The drift against its own model (docs/recipes.md): an axis is sigma sqrt(1/2) (b t / T + W(t) / sqrt(T)), b standard
// normal, W Brownian, sigma = 1.1 m / sqrt(pi / 2), T = 1200 s. Seeds 0 to n - 1. Means and covariances may be off by 4
// standard errors (two-sided alpha = 6e-5 each).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "ensonify/generators/attitude_noise.hpp"
#include "ensonify/generators/drift.hpp"

namespace ensonify {
namespace {

const Drift paper{1.1, 1200.0};
const double sigma_m = 1.1 / std::sqrt(std::numbers::pi / 2);
constexpr double T = 1200.0;

RandomKey seed(int s) { return RandomKey::from_seed(static_cast<std::uint64_t>(s)).child("drift"); }

// The standard deviation of a Rayleigh radius is 0.523 of its mean: 1.65 % of standard error of n = 1000, so 5 % is 3.
TEST(DriftStatistics, MeanRadiusAfterTwentyMinutesIsThatOfThePaper) {
  double radius = 0;
  for (int s = 0; s < 1000; ++s) radius += drift_m(paper, seed(s), T).norm() / 1000;
  std::printf("mean radius of 1000 seeds %.4f m\n", radius);
  EXPECT_NEAR(radius, 1.1, 0.05 * 1.1);
}

// Kolmogorov-Smirnov, alpha = 0.001: the critical distance is sqrt(-ln(alpha / 2) / 2 / n) = 0.0616 for n = 1000.
TEST(DriftStatistics, RadiusIsRayleigh) {
  constexpr int n = 1000;
  std::vector<double> radius;
  for (int s = 0; s < n; ++s) radius.push_back(drift_m(paper, seed(s), T).norm());
  std::sort(radius.begin(), radius.end());
  double distance = 0;
  for (int i = 0; i < n; ++i) {
    const double cdf = 1 - std::exp(-0.5 * std::pow(radius[static_cast<std::size_t>(i)] / sigma_m, 2));
    distance = std::max({distance, std::abs(cdf - static_cast<double>(i) / n), std::abs(cdf - (i + 1.0) / n)});
  }
  std::printf("KS distance %.4f, critical %.4f\n", distance, std::sqrt(-std::log(0.0005) / 2 / n));
  EXPECT_LT(distance, std::sqrt(-std::log(0.0005) / 2 / n));
}

// The variance of an axis is sigma^2 / 2 (t^2 / T^2 + t / T): half bias, half walk at T, the walk before, the bias
// after. A variance of 2 n values has a standard error of 1 / sqrt(n); axes do not correlate.
TEST(DriftStatistics, VarianceIsHalfQuadraticHalfLinear) {
  constexpr int n = 4000;
  for (const double share : {1.0 / 64, 0.1, 0.25, 0.5, 1.0, 3.0}) {
    double xx = 0, yy = 0, xy = 0;
    for (int s = 0; s < n; ++s) {
      const Eigen::Vector2d e = drift_m(paper, seed(s), share * T);
      xx += e.x() * e.x() / n;
      yy += e.y() * e.y() / n;
      xy += e.x() * e.y() / n;
    }
    const double expected = 0.5 * sigma_m * sigma_m * (share * share + share);
    EXPECT_NEAR(0.5 * (xx + yy) / expected, 1.0, 4 / std::sqrt(n)) << share;
    EXPECT_NEAR(xx / yy, 1.0, 4 * 2 / std::sqrt(n)) << share;
    EXPECT_LT(std::abs(xy) / expected, 4 / std::sqrt(n)) << share;
  }
}

// Steps of d seconds: variance sigma^2 / 2 (d^2 / T^2 + d / T), and what two steps share is the bias alone, sigma^2 / 2
// d^2 / T^2. The times lie across the borders of the dyadic construction.
TEST(DriftStatistics, StepsOfTheWalkAreIndependent) {
  constexpr int n = 4000;
  constexpr int steps = 24;
  constexpr double d = 17.3;
  std::vector<double> covariance(4, 0.0);
  double before_and_after = 0;  // the walk so far tells nothing of the next step
  for (int s = 0; s < n; ++s) {
    std::vector<Eigen::Vector2d> step;
    for (int k = 0; k < steps; ++k) {
      step.push_back(drift_m(paper, seed(s), 3 + (k + 1) * d) - drift_m(paper, seed(s), 3 + k * d));
    }
    const int k = s % (steps - 3);
    for (int lag = 0; lag < 4; ++lag) covariance[lag] += step[k].dot(step[k + lag]) / (2 * n);
    before_and_after += drift_m(paper, seed(s), 3 + k * d).dot(step[k]) / (2 * n);
  }
  const double unit = 0.5 * sigma_m * sigma_m;
  const double bias = unit * d * d / T / T;
  const double variance = bias + unit * d / T;
  EXPECT_NEAR(covariance[0] / variance, 1.0, 4 / std::sqrt(n));
  for (int lag = 1; lag < 4; ++lag)
    EXPECT_NEAR((covariance[lag] - bias) / variance, 0.0, 4 / std::sqrt(2.0 * n)) << lag;
  // Of the bias the two share d t / T^2; k is even over 0 .. steps - 4.
  const double mean_t = 3 + d * (steps - 4) / 2.0;
  const double spread = std::sqrt(variance * unit * (mean_t * mean_t / T / T + mean_t / T));
  EXPECT_NEAR(before_and_after, unit * d * mean_t / T / T, 4 * 1.2 * spread / std::sqrt(2.0 * n));
}

// Rocking over 4000 periods: the mean of 16 cosines vanishes, the rms is that of the settings, axes do not correlate,
// the rate has 2 pi sqrt(13 / 12) rms / period. Neighbouring waves may beat slowly: 5 %. What 1000 keys give at one
// time is zero-mean with the rms (standard errors 3.2 % and 2.2 %).
TEST(RockingStatistics, RmsMeanRateAndIndependence) {
  const AttitudeNoise noise{2.0, 3.0, 0.0, 6.0};
  const RandomKey key = seed(7);
  double mean = 0, rr = 0, pp = 0, rp = 0, rate = 0;
  constexpr int n = 96000;
  constexpr double dt = 0.25;
  for (int i = 0; i < n; ++i) {
    const Vec3 a = rocking_rad(noise, key, i * dt) / radians(1.0);
    const Vec3 b = rocking_rad(noise, key, i * dt + 1e-3) / radians(1.0);
    EXPECT_EQ(a.z(), 0.0);
    mean += a.x() / n;
    rr += a.x() * a.x() / n;
    pp += a.y() * a.y() / n;
    rp += a.x() * a.y() / n;
    rate += std::pow((b.x() - a.x()) / 1e-3, 2) / n;
  }
  EXPECT_NEAR(mean, 0.0, 0.01);
  EXPECT_NEAR(std::sqrt(rr), 2.0, 0.1);
  EXPECT_NEAR(std::sqrt(pp), 3.0, 0.15);
  EXPECT_LT(std::abs(rp), 0.05 * 6);
  EXPECT_NEAR(std::sqrt(rate), 2 * std::numbers::pi * std::sqrt(13.0 / 12) * 2.0 / 6.0, 0.05 * 2.2);
  double over_keys = 0, square = 0;
  for (int s = 0; s < 1000; ++s) {
    const double roll = rocking_rad(noise, seed(s), 33.3).x() / radians(2.0);
    over_keys += roll / 1000;
    square += roll * roll / 1000;
  }
  EXPECT_NEAR(over_keys, 0.0, 4 * 0.032);
  EXPECT_NEAR(std::sqrt(square), 1.0, 4 * 0.022);
}

// Nothing below half or above one and a half of 1 / period: the share of a Fourier line's power there is leakage, below
// 1e-3 of the strongest inside over 200 periods with a Hann window.
TEST(RockingStatistics, IsBandLimited) {
  const AttitudeNoise noise{1.0, 0.0, 0.0, 4.0};
  constexpr int n = 3200;
  constexpr double dt = 0.25;
  const auto power = [&](double frequency_hz) {
    double c = 0, s = 0;
    for (int i = 0; i < n; ++i) {
      const double w = 1 - std::cos(2 * std::numbers::pi * i / n);
      const double phase = 2 * std::numbers::pi * frequency_hz * i * dt;
      const double x = rocking_rad(noise, seed(1), i * dt).x();
      c += w * x * std::cos(phase);
      s += w * x * std::sin(phase);
    }
    return c * c + s * s;
  };
  double inside = 0;
  for (double f = 0.5 / 4; f <= 1.5 / 4; f += 1 / (n * dt)) inside = std::max(inside, power(f));
  for (const double f : {0.0, 0.1 / 4, 0.3 / 4, 0.45 / 4, 1.55 / 4, 1.8 / 4, 3.0 / 4, 6.0 / 4}) {
    EXPECT_LT(power(f), 1e-3 * inside) << f;
  }
}

}  // namespace
}  // namespace ensonify
