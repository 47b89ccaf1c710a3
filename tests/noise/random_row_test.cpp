#include "ensonify/noise/random_row.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

namespace ensonify {
namespace {

TEST(RandomRow, SameBitsAsOneCallAPixel) {
  const RandomKey key = RandomKey::from_seed(77).child("noise");
  for (const std::size_t length : {0u, 1u, 3u, 4u, 5u, 63u, 64u, 65u, 127u, 511u, 512u, 1001u}) {
    for (const std::uint32_t row : {0u, 1u, 511u, 0xffffffffu}) {
      std::vector<float> numbers(length);
      uniform_row(key, row, numbers);
      for (std::size_t p = 0; p < length; ++p) {
        const std::uint32_t word = random_words(key, static_cast<std::uint32_t>(p / 4), row)[p % 4];
        ASSERT_EQ(numbers[p], uniform_of(word)) << length << " " << p;
      }
    }
  }
}

// random_words knows three words of a counter; the fourth is told by a counter of its own: it must matter.
TEST(RandomRow, SameBitsAtAnyCounters) {
  const RandomKey key = RandomKey::from_seed(78);
  for (const std::size_t length : {1u, 7u, 8u, 9u, 100u}) {
    std::vector<std::uint32_t> c0(length), c1(length), c2(length), c3(length, 0u), word0(length), word1(length);
    for (std::uint32_t i = 0; i < length; ++i) {
      c0[i] = 0x9E3779B9u * i;
      c1[i] = 0xffffffffu - i;
      c2[i] = i * i;
    }
    words_at(key, {c0, c1, c2, c3}, word0, word1);
    for (std::size_t i = 0; i < length; ++i) {
      const auto expected = random_words(key, c0[i], c1[i], c2[i]);
      ASSERT_EQ(word0[i], expected[0]) << length << " " << i;
      ASSERT_EQ(word1[i], expected[1]) << length << " " << i;
    }
    const std::vector<std::uint32_t> before = word0;
    c3.back() = 1;
    words_at(key, {c0, c1, c2, c3}, word0, word1);
    EXPECT_NE(word0.back(), before.back());
  }
}

/// Quantile of the standard normal in double: Newton steps on Phi(x) = erfc(-x / sqrt 2) / 2, by the nearer tail.
double quantile(double p, double start) {
  const double tail = std::min(p, 1.0 - p);
  double x = -std::abs(start);
  for (int i = 0; i < 3; ++i) {
    const double density = std::exp(-0.5 * x * x) / std::sqrt(2.0 * std::numbers::pi);
    x -= (0.5 * std::erfc(-x / std::numbers::sqrt2) - tail) / density;
  }
  return p < 0.5 ? x : -x;
}

// Every 41st of the 2^24 upper halves of a word, and both ends, where (top + 1/2) 2^-24 would round to 1.
TEST(RandomRow, NormalAgainstTheQuantile) {
  double worst = 0;
  double worst_relative = 0;
  const auto check = [&](std::uint32_t top) {
    const float u = uniform_of(top << 8);
    ASSERT_GT(u, 0.0F);
    ASSERT_LT(u, 1.0F) << top;
    const auto x = static_cast<double>(normal_of(u));
    ASSERT_TRUE(std::isfinite(x)) << top;
    const double truth = quantile(static_cast<double>(u), x);
    worst = std::max(worst, std::abs(x - truth));
    if (std::abs(truth) > 1e-3) worst_relative = std::max(worst_relative, std::abs(x / truth - 1.0));
  };
  for (std::uint32_t top = 0; top < (1u << 24); top += 41) check(top);
  for (std::uint32_t i = 0; i < 2000; ++i) {
    check(i);
    check((1u << 24) - 1 - i);
  }
  RecordProperty("worst_absolute", std::to_string(worst));
  std::printf("normal_of: worst error %.2g absolute, %.2g relative\n", worst, worst_relative);
  EXPECT_LT(worst, 1e-5);
  EXPECT_LT(worst_relative, 3e-6);
}

TEST(RandomRow, RayleighAgainstTheQuantile) {
  double worst = 0;
  for (std::uint32_t top = 0; top < (1u << 24); top += 41) {
    const float u = uniform_of(top << 8);
    worst = std::max(
        worst, std::abs(static_cast<double>(rayleigh_of(u)) - std::sqrt(-2.0 * std::log(static_cast<double>(u)))));
  }
  std::printf("rayleigh_of: worst error %.2g\n", worst);
  EXPECT_LT(worst, 2e-6);
}

TEST(RandomRow, RowsAreTheSameAsSingles) {
  std::vector<float> u;
  for (int i = 0; i < 1001; ++i) u.push_back((static_cast<float>(i) + 0.5F) / 1001.0F);
  std::vector<float> normal = u;
  std::vector<float> rayleigh = u;
  to_normal(normal);
  to_rayleigh(rayleigh);
  for (std::size_t i = 0; i < u.size(); ++i) {
    EXPECT_EQ(normal[i], normal_of(u[i]));
    EXPECT_EQ(rayleigh[i], rayleigh_of(u[i]));
  }
}

}  // namespace
}  // namespace ensonify
