#include "ensonify/noise/image_stages.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "ensonify/sensor_models/beam_table.hpp"
#include "support/statistics.hpp"

namespace ensonify {
namespace {

constexpr int bins = 200;
constexpr int beams = 101;

SonarGeometry geometry() {
  SonarGeometry g;
  g.range_max_m = 2.0;
  g.range_bins = bins;
  g.beam_azimuth_rad = uniform_sine_beams(beams, 1.0);
  return g;
}

Image2<float> after(const NoiseStage<double>& stage, float level = 0.2F, std::uint64_t ping = 1) {
  return disturb_image({"test", {stage}}, Image2<float>(bins, beams, level), geometry(), RandomKey::from_seed(ping));
}

double ratio(const Image2<float>& image, int bin, int beam) { return static_cast<double>(image(bin, beam)) / 0.2; }

TEST(CentreStripe, BrightensTheMiddle) {
  const auto image = after(CentreStripe<double>{3.0, 2.0});
  EXPECT_NEAR(ratio(image, 10, 50), 3.0, 1e-5);
  EXPECT_NEAR(ratio(image, 150, 52), 1.0 + 2.0 * std::exp(-0.5), 1e-5);
  EXPECT_NEAR(ratio(image, 10, 70), 1.0, 1e-5);
}

TEST(NearEdges, RaiseTheEdgesNearby) {
  const auto image = after(NearEdges<double>{2.0, 0.4});
  EXPECT_NEAR(ratio(image, 0, 0), 1.0 + std::exp(-0.005 / 0.4), 1e-4);
  EXPECT_NEAR(ratio(image, 40, 100), 1.0 + std::exp(-0.405 / 0.4), 1e-4);
  EXPECT_NEAR(ratio(image, 0, 50), 1.0, 1e-4);
  EXPECT_NEAR(ratio(image, 199, 0), 1.0, 0.01);
}

TEST(GainWobble, IsOneFactorABeamAndPing) {
  std::vector<double> factors;
  for (std::uint64_t ping = 0; ping < 50; ++ping) {
    const auto image = after(GainWobble<double>{0.1}, 0.2F, ping);
    for (int b = 0; b < beams; ++b) {
      ASSERT_EQ(image(0, b), image(199, b));
      factors.push_back((ratio(image, 0, b) - 1.0) / 0.1);
    }
  }
  const auto normal = [](double x) { return 0.5 * std::erfc(-x / std::sqrt(2.0)); };
  EXPECT_LT(test::ks_distance(factors, normal), test::ks_critical(static_cast<double>(factors.size())));
}

TEST(DroppedBeams, AreBlackAsOftenAsAsked) {
  int dropped = 0;
  for (std::uint64_t ping = 0; ping < 100; ++ping) {
    const auto image = after(DroppedBeams<double>{0.05}, 0.2F, ping);
    for (int b = 0; b < beams; ++b) {
      ASSERT_EQ(image(3, b), image(199, b));
      dropped += image(3, b) == 0.0F;
    }
  }
  const double n = 100 * beams;
  EXPECT_NEAR(dropped, 0.05 * n, 4.0 * std::sqrt(n * 0.05 * 0.95));
}

TEST(AzimuthStreaks, ChangeRowsThatAreBrightEnough) {
  Image2<float> level(2, 100, 0.1F);
  for (int b = 0; b < 8; ++b) level(0, b) = 0.6F;
  for (int b = 0; b < 7; ++b) level(1, b) = 0.6F;
  const auto streaked = [&](double strength) {
    return disturb_image({"test", {AzimuthStreaks<double>{strength, 0.08}}}, level, geometry(), {});
  };
  EXPECT_NEAR(streaked(-1.0)(0, 0), 0.36, 1e-6);
  EXPECT_NEAR(streaked(-1.0)(0, 50), 0.01, 1e-6);
  EXPECT_NEAR(streaked(1.0)(0, 50), 0.19, 1e-6);
  EXPECT_EQ(streaked(-1.0)(1, 0), 0.6F);  // 7 of 100 beams are too few
}

// Mean of a Rayleigh is 1.2533 sigma; (r / range_max)^2 of the row, and 1 + centre in the middle beam.
TEST(RangeNoise, GrowsWithRange) {
  double near = 0, far = 0, middle = 0;
  constexpr int pings = 200;
  for (std::uint64_t ping = 0; ping < pings; ++ping) {
    const auto image = after(RangeNoise<double>{0.1, 2.0, 0.5}, 0.0F, ping);
    for (int b = 0; b < 20; ++b) {
      near += static_cast<double>(image(99, b)) / (20.0 * pings);
      far += static_cast<double>(image(199, b)) / (20.0 * pings);
    }
    middle += static_cast<double>(image(199, 50)) / pings;
  }
  EXPECT_NEAR(far, 0.12533, 0.12533 * 4.0 * 0.523 / std::sqrt(20.0 * pings));
  EXPECT_NEAR(near / far, 0.25, 0.02);
  EXPECT_NEAR(middle / far, 1.5, 0.2);
}

}  // namespace
}  // namespace ensonify
