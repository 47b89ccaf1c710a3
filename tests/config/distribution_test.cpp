#include "ensonify/config/distribution.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "ensonify/core/error.hpp"

namespace ensonify {
namespace {

Distribution parse(const std::string& value, Limits limits = any_number) {
  Reader reader = Reader::from_text("a: " + value + "\n", "t.yaml");
  return read_distribution(reader, "a", limits);
}

std::string refusal(const std::string& value, Limits limits = any_number) {
  try {
    parse(value, limits);
  } catch (const ConfigError& e) {
    return e.what();
  }
  return {};
}

struct Moments {
  double low, high, mean, sigma;
};

/// n = 20000 draws, seed 4.
Moments draw(const Distribution& distribution) {
  constexpr int n = 20'000;
  RandomSequence random(RandomKey::from_seed(4));
  Moments m{1e300, -1e300, 0, 0};
  double squares = 0;
  for (int i = 0; i < n; ++i) {
    const double x = sample(distribution, random);
    m.low = std::min(m.low, x);
    m.high = std::max(m.high, x);
    m.mean += x / n;
    squares += x * x / n;
  }
  m.sigma = std::sqrt(std::max(0.0, squares - m.mean * m.mean));
  return m;
}

TEST(Distribution, Constant) {
  const Moments m = draw(parse("2.5"));
  EXPECT_EQ(m.low, 2.5);
  EXPECT_EQ(m.high, 2.5);
}

// Standard error of the mean: sigma / sqrt(n) = sigma / 141; 4 of them.
TEST(Distribution, UniformMeanAndRange) {
  const Moments m = draw(parse("{uniform: [-2, 6]}"));
  EXPECT_GE(m.low, -2.0);
  EXPECT_LE(m.high, 6.0);
  EXPECT_NEAR(m.mean, 2.0, 4 * 2.31 / 141);  // 8 / sqrt 12
  EXPECT_NEAR(m.sigma, 8.0 / std::sqrt(12.0), 0.05);
}

// Density 1 / (x ln(b/a)): mean (b - a) / ln(b / a).
TEST(Distribution, LogUniformMeanAndRange) {
  const Moments m = draw(parse("{log_uniform: [0.1, 10]}"));
  EXPECT_GE(m.low, 0.1);
  EXPECT_LE(m.high, 10.0);
  EXPECT_NEAR(m.mean, 9.9 / std::log(100.0), 4 * 2.6 / 141);
}

// Clamped at 3 sigma: variance 1 - 2 [3 phi(3) + (1 - 9) Q(3)] = 0.9950 of sigma^2.
TEST(Distribution, NormalIsCutAtThreeSigma) {
  const Moments m = draw(parse("{normal: [10, 2]}"));
  EXPECT_GE(m.low, 4.0);
  EXPECT_LE(m.high, 16.0);
  EXPECT_NEAR(m.mean, 10.0, 4 * 2.0 / 141);
  EXPECT_NEAR(m.sigma, 2.0 * std::sqrt(0.995), 0.04);
}

TEST(Distribution, ChoiceTakesEachValue) {
  const Moments m = draw(parse("{choice: [1, 2, 4]}"));
  EXPECT_EQ(m.low, 1.0);
  EXPECT_EQ(m.high, 4.0);
  EXPECT_NEAR(m.mean, 7.0 / 3.0, 4 * 1.25 / 141);
}

// What can be drawn keeps the limits, to the last bit.
TEST(Distribution, LogUniformOfOnePointStaysOnIt) {
  for (const double v : {0.1, 0.3, 3.0, 5.0, 7.3, 10.0, 1e-3, 123.456}) {
    RandomSequence random(RandomKey::from_seed(1));
    for (int i = 0; i < 100; ++i) ASSERT_EQ(sample(LogUniform{v, v}, random), v);
  }
}

TEST(Distribution, EndsAreTheLeastAndTheLargestDrawn) {
  const auto ends = [](const std::string& value) {
    const Limits limits = ends_of(parse(value));
    return std::pair(limits.low, limits.high);
  };
  EXPECT_EQ(ends("3"), std::pair(3.0, 3.0));
  EXPECT_EQ(ends("{uniform: [-2, 6]}"), std::pair(-2.0, 6.0));
  EXPECT_EQ(ends("{log_uniform: [0.1, 10]}"), std::pair(0.1, 10.0));
  EXPECT_EQ(ends("{normal: [10, 2]}"), std::pair(4.0, 16.0));
  EXPECT_EQ(ends("{choice: [4, 1, 2]}"), std::pair(1.0, 4.0));
}

TEST(Distribution, Refusals) {
  EXPECT_THAT(refusal("{uniform: [3, 1]}"), testing::HasSubstr("t.yaml:1: a.uniform"));
  EXPECT_THAT(refusal("{uniform: [0, 11]}", {0, 10}), testing::HasSubstr("must lie in [0, 10]"));
  EXPECT_THAT(refusal("{uniform: [1]}"), testing::HasSubstr("list of 2 numbers"));
  EXPECT_THAT(refusal("{log_uniform: [0, 1]}"), testing::HasSubstr("above 0"));
  EXPECT_THAT(refusal("{log_uniform: [-1, 1]}"), testing::HasSubstr("above 0"));
  EXPECT_THAT(refusal("{normal: [0, -1]}"), testing::HasSubstr("sigma"));
  EXPECT_THAT(refusal("{normal: [5, 2]}", {0, 10}), testing::HasSubstr("3 sigma"));
  EXPECT_THAT(refusal("{choice: []}"), testing::HasSubstr("at least one"));
  EXPECT_THAT(refusal("{choice: [1, 12]}", {0, 10}), testing::HasSubstr("must lie in [0, 10]"));
  EXPECT_THAT(refusal("{unifrom: [1, 2]}"), testing::HasSubstr("unifrom"));
  EXPECT_THAT(refusal("{uniform: [1, 2], normal: [1, 2]}"), testing::HasSubstr("unknown key"));
  EXPECT_THAT(refusal("{}"), testing::HasSubstr("one of uniform"));
  EXPECT_THAT(refusal("[1, 2]"), testing::HasSubstr("plain number"));
  EXPECT_EQ(refusal("{normal: [5, 1]}", {2, 8}), "");
}

}  // namespace
}  // namespace ensonify
