// Kolmogorov-Smirnov tests, seed 2023, alpha = 0.001: the critical distance is sqrt(-ln(alpha / 2) / 2 / n) =
// 1.9495 / sqrt n. The seed is fixed, so the outcome is too.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "ensonify/core/error.hpp"
#include "ensonify/noise/image_stages.hpp"

namespace ensonify {
namespace {

const RandomKey key = RandomKey::from_seed(2023);
constexpr int side = 512;
const double n = side * side;
const double critical = 1.9495 / std::sqrt(n);

template <typename Cdf>
double ks_distance(std::vector<double> x, const Cdf& cdf) {
  std::sort(x.begin(), x.end());
  double distance = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double p = cdf(x[i]);
    const double size = static_cast<double>(x.size());
    distance = std::max({distance, p - static_cast<double>(i) / size, static_cast<double>(i + 1) / size - p});
  }
  return distance;
}

double normal_cdf(double x) { return 0.5 * std::erfc(-x / std::numbers::sqrt2); }
double rayleigh_cdf(double x) { return 1.0 - std::exp(-0.5 * x * x); }

Image2<float> disturb(const NoiseChain& chain, const Image2<float>& level, RandomKey numbers) {
  return disturb_image(chain, level, SonarGeometry{}, numbers);
}
NoiseChain speckle(double sigma) { return {"test", {GaussianSpeckle<double>{sigma}}}; }
NoiseChain rayleigh(double sigma) { return {"test", {AdditiveRayleigh<double>{sigma}}}; }

// level = 0.4 (1 + 0.25 N): inside 0..1 for N in [-4, 6], so next to nothing is clipped.
TEST(NoiseStatistics, GaussianSpeckle) {
  const Image2<float> image = disturb(speckle(0.25), Image2<float>(side, side, 0.4F), key);
  std::vector<double> x;
  double sum = 0;
  double squares = 0;
  for (const float v : image.pixels()) {
    x.push_back((static_cast<double>(v) / 0.4 - 1.0) / 0.25);
    sum += x.back();
    squares += x.back() * x.back();
  }
  EXPECT_NEAR(sum / n, 0.0, 4.0 / std::sqrt(n));
  EXPECT_NEAR(std::sqrt(squares / n), 1.0, 4.0 / std::sqrt(2.0 * n));
  EXPECT_LT(ks_distance(x, normal_cdf), critical);
}

// On black: Rayleigh of scale 0.05, mean 0.05 sqrt(pi / 2), variance 0.05^2 (2 - pi / 2).
TEST(NoiseStatistics, AdditiveRayleigh) {
  const Image2<float> image = disturb(rayleigh(0.05), Image2<float>(side, side, 0.0F), key);
  std::vector<double> x;
  double sum = 0;
  for (const float v : image.pixels()) {
    x.push_back(static_cast<double>(v) / 0.05);
    sum += x.back();
  }
  EXPECT_NEAR(sum / n, std::sqrt(std::numbers::pi / 2.0), 4.0 * 0.6551 / std::sqrt(n));
  EXPECT_LT(ks_distance(x, rayleigh_cdf), critical);
}

// Neighbours along rows, columns and the diagonal: |correlation| < 4 / sqrt n.
TEST(NoiseStatistics, WhiteInBothDirections) {
  const Image2<float> image = disturb(speckle(0.25), Image2<float>(side, side, 0.4F), key);
  for (const auto& [dr, dc] : {std::pair{0, 1}, std::pair{1, 0}, std::pair{1, 1}, std::pair{0, 4}, std::pair{0, 64}}) {
    double product = 0;
    for (int r = 0; r + dr < side; ++r) {
      for (int c = 0; c + dc < side; ++c) {
        product += (static_cast<double>(image(r, c)) - 0.4) * (static_cast<double>(image(r + dr, c + dc)) - 0.4);
      }
    }
    EXPECT_LT(std::abs(product / n / 0.01), 4.0 / std::sqrt(n)) << dr << " " << dc;
  }
}

TEST(NoiseKeys, ByBinAndBeamNotByImageSize) {
  const NoiseChain chain{"test", {GaussianSpeckle<double>{0.25}, AdditiveRayleigh<double>{0.05}}};
  const Image2<float> small = disturb(chain, Image2<float>(40, 101, 0.3F), key);
  const Image2<float> large = disturb(chain, Image2<float>(60, 512, 0.3F), key);
  for (int r = 0; r < 40; ++r) {
    for (int c = 0; c < 101; ++c) ASSERT_EQ(small(r, c), large(r, c)) << r << " " << c;
  }
  EXPECT_NE(disturb(chain, Image2<float>(8, 8, 0.3F), key.child(1)), disturb(chain, Image2<float>(8, 8, 0.3F), key));
}

// A stage is addressed by its kind and which of its kind it is, so another stage's absence changes nothing.
TEST(NoiseKeys, StagesDoNotShiftOneAnother) {
  const Image2<float> black(64, 64, 0.0F);
  const NoiseChain both{"test", {GaussianSpeckle<double>{0.25}, AdditiveRayleigh<double>{0.05}}};
  EXPECT_EQ(disturb(both, black, key), disturb(rayleigh(0.05), black, key));  // speckle of nothing is nothing
  const Image2<float> grey(64, 64, 0.4F);
  const NoiseChain with_none{"test", {GaussianSpeckle<double>{0.1}, AdditiveRayleigh<double>{0.0}}};
  EXPECT_EQ(disturb(with_none, grey, key), disturb(speckle(0.1), grey, key));
  const NoiseChain twice{"test", {GaussianSpeckle<double>{0.1}, GaussianSpeckle<double>{0.1}}};
  const NoiseChain once_more{"test", {GaussianSpeckle<double>{0.1}, GaussianSpeckle<double>{0.0}}};
  EXPECT_EQ(disturb(once_more, grey, key), disturb(speckle(0.1), grey, key));
  EXPECT_NE(disturb(twice, grey, key), disturb(speckle(0.2), grey, key));  // the second draws its own numbers
}

TEST(NoiseChain, ClipsAndKeepsAnEmptyChain) {
  const Image2<float> grey(32, 32, 0.9F);
  EXPECT_EQ(disturb({"none", {}}, grey, key), grey);
  const Image2<float> loud = disturb(speckle(2.0), grey, key);
  for (const float v : loud.pixels()) {
    ASSERT_GE(v, 0.0F);
    ASSERT_LE(v, 1.0F);
  }
}

TEST(NoiseProfile, BundledPaper) {
  SampledValues sampled;
  const NoiseChain chain = sample_noise(load_noise("paper"), key, sampled);
  ASSERT_EQ(chain.stages.size(), 2u);
  EXPECT_EQ(std::get<GaussianSpeckle<double>>(chain.stages[0]).sigma, 0.25);
  EXPECT_EQ(std::get<AdditiveRayleigh<double>>(chain.stages[1]).sigma, 0.05);
  EXPECT_TRUE(sampled.empty());
  EXPECT_THROW(load_noise("papre"), ConfigError);
}

TEST(NoiseProfile, SampledNumbersAreRecorded) {
  const NoiseProfile profile{
      "test",
      {GaussianSpeckle<Distribution>{Uniform{0.1, 0.3}}, AdditiveRayleigh<Distribution>{Constant{0.05}},
       GaussianSpeckle<Distribution>{Uniform{0.5, 0.6}}}};
  SampledValues sampled;
  const NoiseChain chain = sample_noise(profile, key, sampled);
  ASSERT_EQ(sampled.size(), 2u);
  EXPECT_EQ(sampled[0].first, "noise.gaussian_speckle.sigma");
  EXPECT_EQ(sampled[1].first, "noise.gaussian_speckle_2.sigma");
  EXPECT_EQ(sampled[0].second, std::get<GaussianSpeckle<double>>(chain.stages[0]).sigma);
  EXPECT_GE(sampled[1].second, 0.5);
}

}  // namespace
}  // namespace ensonify
