#include "ensonify/evaluation/intervals.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>

namespace ensonify {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// 1 2 3 4: mean 2.5, s = 1.29099, t(3) = 3.18245.
TEST(Intervals, StudentsIntervalIsTheTables) {
  const std::vector<double> values{1, 2, nan, 3, 4};
  const Estimate e = mean_estimate(values);
  EXPECT_EQ(e.frames, 4);
  EXPECT_DOUBLE_EQ(e.value, 2.5);
  EXPECT_NEAR(e.high - e.value, 3.18245 * 1.290994 / 2.0, 0.01);
  EXPECT_NEAR(e.value - e.low, e.high - e.value, 1e-12);
}

TEST(Intervals, NothingGivesNothing) {
  EXPECT_TRUE(std::isnan(mean_estimate({}).value));
  const std::vector<double> one{3};
  EXPECT_EQ(mean_estimate(one).value, 3.0);
  EXPECT_TRUE(std::isnan(mean_estimate(one).low));
}

/// Of 1000 samples of 40 normal numbers (seed 5), the 95 % interval of their mean holds the true mean in 95 %:
/// binomial, alpha 0.001 gives 950 +- 23; the bootstrap is known to be narrow, by 2 % at 40 values (Efron and
/// Tibshirani 1993, ch. 14).
TEST(Intervals, TheTruthLiesInsideAsOftenAsTheySay) {
  const RandomKey key = RandomKey::from_seed(5);
  int student = 0, bootstrap = 0;
  for (std::uint64_t sample = 0; sample < 1000; ++sample) {
    std::vector<double> values;
    for (std::uint64_t i = 0; i < 40; ++i) values.push_back(3.0 + normal_at(key, 40 * sample + i));
    const Estimate e = mean_estimate(values);
    student += e.low <= 3.0 && 3.0 <= e.high;
    if (sample >= 300) continue;  // a thousand resamples each
    const Estimate b = bootstrap_estimate(40, key.child(sample), [&](std::span<const int> weights) {
      return std::inner_product(values.begin(), values.end(), weights.begin(), 0.0) / 40.0;
    });
    EXPECT_NEAR(b.value, e.value, 1e-12);
    bootstrap += b.low <= 3.0 && 3.0 <= b.high;
  }
  EXPECT_NEAR(student, 950, 23);
  EXPECT_NEAR(bootstrap, 0.94 * 300, 13 + 0.01 * 300);
}

TEST(Intervals, TheSameKeyGivesTheSameBits) {
  const auto estimate = [](std::uint64_t seed) {
    return bootstrap_estimate(30, RandomKey::from_seed(seed), [](std::span<const int> w) { return 1.0 * w[0] + w[7]; });
  };
  EXPECT_EQ(estimate(1).high, estimate(1).high);
}

}  // namespace
}  // namespace ensonify
