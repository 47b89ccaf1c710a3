#include "ensonify/generators/amplitude_fits.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "ensonify/core/gamma_function.hpp"
#include "ensonify/core/random.hpp"

namespace ensonify {
namespace {

const RandomKey key = RandomKey::from_seed(11);

std::vector<double> weibull_sample(double shape, double scale, int n) {
  std::vector<double> values;
  for (int i = 0; i < n; ++i) {
    values.push_back(scale * std::pow(-std::log(uniform_at(key, static_cast<std::uint64_t>(i))), 1 / shape));
  }
  return values;
}

// Values of Abramowitz and Stegun, tables 6.1 and 6.3, and closed forms.
TEST(GammaFunction, TakesKnownValues) {
  EXPECT_NEAR(digamma(1), -0.57721566490153286, 1e-12);
  EXPECT_NEAR(digamma(0.5), -1.96351002602142348, 1e-12);
  EXPECT_NEAR(digamma(30) - digamma(29), 1.0 / 29, 1e-12);
  EXPECT_NEAR(log_gamma(5), std::log(24.0), 1e-12);
  for (const double x : {0.01, 0.5, 1.9, 2.1, 7.0, 40.0}) {
    EXPECT_NEAR(gamma_distribution(1, x), -std::expm1(-x), 1e-12) << x;
    EXPECT_NEAR(gamma_distribution(0.5, x), std::erf(std::sqrt(x)), 1e-12) << x;
    EXPECT_NEAR(gamma_distribution(3, x), 1 - std::exp(-x) * (1 + x + x * x / 2), 1e-12) << x;
  }
  EXPECT_EQ(gamma_distribution(2, 0), 0);
  EXPECT_NEAR(gamma_distribution(1000, 1000), 0.5042, 1e-4);  // 1/2 + 1 / (3 sqrt(2 pi a))
}

// The deviation of the shape's estimate is 0.78 shape / sqrt(n) (Johnson, Kotz, Balakrishnan 1994, 21): four of them.
TEST(AmplitudeFits, FindTheWeibullLawOfASample) {
  constexpr int n = 20000;
  for (const double shape : {0.7, 2.0, 3.9, 9.0}) {
    const AmplitudeFits fits = fit_amplitudes(weibull_sample(shape, 1.7, n));
    EXPECT_NEAR(fits.weibull_shape, shape, 4 * 0.78 * shape / std::sqrt(n)) << shape;
    EXPECT_NEAR(fits.weibull_scale, 1.7, 4 * 1.05 * 1.7 / shape / std::sqrt(n)) << shape;
    EXPECT_LT(fits.ks.weibull, 0.012) << shape;
  }
}

// Of the Weibull family, shape 2 is Rayleigh's law and shape 1 the exponential one; Nakagami and gamma hold them too.
TEST(AmplitudeFits, AgreeWhereLawsAreOne) {
  const AmplitudeFits rayleigh = fit_amplitudes(weibull_sample(2, 1, 20000));
  EXPECT_LT(std::max({rayleigh.ks.rayleigh, rayleigh.ks.nakagami, rayleigh.ks.k, rayleigh.ks.weibull}), 0.012);
  EXPECT_NEAR(rayleigh.nakagami_shape, 1, 0.03);
  EXPECT_GT(rayleigh.k_shape, 20);
  EXPECT_GT(rayleigh.ks.exponential, 0.1);
  const AmplitudeFits exponential = fit_amplitudes(weibull_sample(1, 1, 20000));
  EXPECT_LT(std::max({exponential.ks.exponential, exponential.ks.gamma}), 0.012);
  EXPECT_NEAR(exponential.gamma_shape, 1, 0.03);
  EXPECT_GT(exponential.ks.lognormal, 0.05);
}

// K: Rayleigh's amplitude times the root of a gamma variable of mean 1; of shape 3, a sum of three exponential ones.
TEST(AmplitudeFits, FindTheKLawOfASample) {
  RandomSequence random(key.child("k"));
  std::vector<double> values;
  for (int i = 0; i < 20000; ++i) {
    const double texture = -std::log(random.uniform() * random.uniform() * random.uniform()) / 3;
    values.push_back(std::sqrt(-texture * std::log(random.uniform())));
  }
  const AmplitudeFits fits = fit_amplitudes(values);
  EXPECT_NEAR(fits.k_shape, 3, 0.5);
  EXPECT_LT(fits.ks.k, 0.015);
  EXPECT_GT(fits.ks.rayleigh, 0.03);
}

}  // namespace
}  // namespace ensonify
