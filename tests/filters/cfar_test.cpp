#include "ensonify/filters/cfar.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "ensonify/core/random.hpp"

namespace ensonify {
namespace {

/// Rayleigh amplitudes: exponential intensity, the noise for which the factors are made.
GreyImage rayleigh(int rows, int columns, const char* name) {
  const RandomKey key = RandomKey::from_seed(7).child(name);
  GreyImage image{Image2<float>(rows, columns), GreyDepth::real};
  std::uint64_t at = 0;
  for (float& x : image.grey.pixels()) x = static_cast<float>(40.0 * std::sqrt(-std::log(uniform_at(key, at++))));
  return image;
}

double share(const Image2<float>& mask) {
  double sum = 0;
  for (const float x : mask.pixels()) sum += x > 0;
  return sum / static_cast<double>(mask.size());
}

/// n = 2 400 000 cells, seed 7. Detections at a distance of 1 + guard.. share cells: their number's variance is a few
/// times the binomial one; 3.3 sigma (alpha 0.001) of 1.5 times its deviation. The rows near the ends have fewer cells,
/// and are held to the rate as the others are.
class CfarRate : public testing::TestWithParam<CfarRule> {};

TEST_P(CfarRate, FalseAlarmsAreAsManyAsAsked) {
  constexpr int rows = 600, columns = 4000;
  for (const double pfa : {1e-2, 1e-3}) {
    const Cfar method{.rule = GetParam(), .train = 16, .guard = 3, .pfa = pfa};
    const double rate = share(apply(method, rayleigh(rows, columns, "rate")));
    const double deviation = std::sqrt(pfa / (static_cast<double>(rows) * columns));
    EXPECT_NEAR(rate, pfa, 3.3 * 1.5 * deviation) << pfa;
  }
}

TEST_P(CfarRate, TheEndsHaveTheirOwnFactor) {
  constexpr int rows = 12, columns = 200'000;
  const Cfar method{.rule = GetParam(), .train = 8, .guard = 2, .pfa = 1e-2};
  const Image2<float> mask = apply(method, rayleigh(rows, columns, "ends"));
  for (int i = 0; i < rows; ++i) {
    double alarms = 0;
    for (const float x : mask.row(i)) alarms += x > 0;
    EXPECT_NEAR(alarms / columns, 1e-2, 3.9 * std::sqrt(1e-2 / columns)) << "row " << i;  // alpha 0.001 over 12 rows
  }
}

INSTANTIATE_TEST_SUITE_P(Rules, CfarRate, testing::Values(CfarRule::ca, CfarRule::soca, CfarRule::goca, CfarRule::os),
                         [](const auto& rule) {
                           return std::string(choice_names(CfarRule{})[static_cast<std::size_t>(rule.param)]);
                         });

/// Cell averaging: pfa = (1 + T / N)^-N (Finn and Johnson 1968).
TEST(Cfar, TheFactorOfCellAveragingIsTheClosedForm) {
  EXPECT_NEAR(cfar_factor(CfarRule::ca, 10, 10, 1e-4, 0.75), 20.0 * (std::pow(1e-4, -1.0 / 20.0) - 1.0), 1e-9);
}

/// One cell on each side: the smaller of two exponentials is exponential of half the mean, pfa = 2 / (2 + T); the
/// larger has pfa = 2 / (1 + T) - 2 / (2 + T).
TEST(Cfar, SmallestAndGreatestOfTwoCellsAreTheClosedForms) {
  const double t = cfar_factor(CfarRule::soca, 1, 1, 0.01, 0.75);
  EXPECT_NEAR(2.0 / (2.0 + t), 0.01, 1e-12);
  const double g = cfar_factor(CfarRule::goca, 1, 1, 0.01, 0.75);
  EXPECT_NEAR(2.0 / (1.0 + g) - 2.0 / (2.0 + g), 0.01, 1e-12);
}

/// Two targets within each other's training cells: the greater side hides both, the smaller does not.
TEST(Cfar, TheSmallerSideSeesATargetBesideAnother) {
  GreyImage image{Image2<float>(101, 1, 10.0F), GreyDepth::real};
  image.grey(50, 0) = 60;
  image.grey(60, 0) = 200;
  const auto detects = [&](CfarRule rule) {
    return apply(Cfar{.rule = rule, .train = 16, .guard = 3, .pfa = 1e-3}, image)(50, 0) > 0;
  };
  EXPECT_TRUE(detects(CfarRule::soca));
  EXPECT_TRUE(detects(CfarRule::os));
  EXPECT_FALSE(detects(CfarRule::goca));
}

TEST(Cfar, NothingIsDetectedWhereThereIsNothing) {
  const Image2<float> mask = apply(Cfar{}, {Image2<float>(64, 8), GreyDepth::real});
  EXPECT_EQ(share(mask), 0.0);
}

}  // namespace
}  // namespace ensonify
