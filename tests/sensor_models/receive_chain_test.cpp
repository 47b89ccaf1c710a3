#include "ensonify/sensor_models/receive_chain.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace ensonify {
namespace {

SonarModel sonar(double spreading_db, double alpha, double gamma) {
  SonarModel model;
  model.geometry.range_min_m = 0.5;
  model.geometry.range_max_m = 10.5;
  model.geometry.range_bins = 1000;
  model.geometry.beam_azimuth_rad = {0.0};
  model.source_level_db = 200;
  model.receive = {spreading_db, alpha, 160.0, gamma, 8};
  return model;
}

/// Echo r^-power 10^(-0.2 alpha r) times `level`.
Image2<float> echo(const SonarModel& model, double level, double power, double alpha) {
  Image2<float> image(1000, 1);
  for (int bin = 0; bin < 1000; ++bin) {
    const double r = model.geometry.bin_centre_m(bin);
    image(bin, 0) = static_cast<float>(level * std::pow(r, -power) * std::pow(10.0, -0.2 * alpha * r));
  }
  return image;
}

// g = 40 takes out r^-4, 30 takes out r^-3, 2 alpha the absorption: the level is SL + 10 log echo - saturation in every
// bin. 200 - 50 - 160 = -10 dB: amplitude 10^-0.5, pixel (10^-0.5)^gamma.
TEST(ReceiveChain, TvgFlattens) {
  for (const auto& [g, power] : {std::pair{40.0, 4.0}, std::pair{30.0, 3.0}, std::pair{20.0, 2.0}}) {
    for (const double gamma : {1.0, 0.5, 0.7}) {
      const SonarModel model = sonar(g, 1.4, gamma);
      const Image2<float> level = receive(model, echo(model, 1e-5, power, 1.4));
      for (int bin = 0; bin < 1000; ++bin) {
        ASSERT_NEAR(static_cast<double>(level(bin, 0)), std::pow(10.0, -0.5 * gamma), 1e-5) << g << " " << gamma;
      }
    }
  }
}

TEST(ReceiveChain, GammaAndClipping) {
  const SonarModel model = sonar(0.0, 0.0, 0.5);
  Image2<float> in(1000, 1);
  in(0, 0) = 0.0F;
  in(1, 0) = 1e-4F;  // full scale: 200 - 40 - 160 = 0 dB
  in(2, 0) = 1e-2F;  // 20 dB above
  in(3, 0) = 1e-8F;  // amplitude 0.01, pixel 0.1
  const Image2<float> level = receive(model, in);
  EXPECT_EQ(level(0, 0), 0.0F);
  EXPECT_NEAR(level(1, 0), 1.0F, 1e-6F);
  EXPECT_EQ(level(2, 0), 1.0F);
  EXPECT_NEAR(level(3, 0), 0.1F, 1e-6F);
}

// 200 + 2 * 20 * 10.5 - 160 = 460 dB is beyond single precision: the gain is infinite, and silence times it NaN.
// Loading refuses such an instrument; a model that a program filled in by itself still gives levels in 0..1.
TEST(ReceiveChain, LevelsAreNumbersAtAnyGain) {
  const SonarModel model = sonar(0.0, 20.0, 0.5);
  const Image2<float> level = receive(model, Image2<float>(1000, 1));
  for (const float l : level.pixels()) ASSERT_TRUE(l >= 0.0F && l <= 1.0F) << l;
  const Image2<float> nan(1, 1, std::nanf(""));
  EXPECT_EQ(quantise(nan)(0, 0), 0);
  EXPECT_EQ(quantise16(nan)(0, 0), 0);
}

// Round to nearest: grey k covers [(k - 1/2) / 255, (k + 1/2) / 255).
TEST(Quantise, RoundsToNearestAndClips) {
  Image2<float> level(1, 8);
  const float values[] = {-1.0F, 0.0F, 0.499F / 255, 0.501F / 255, 7.49F / 255, 7.51F / 255, 1.0F, 3.0F};
  const int grey8[] = {0, 0, 0, 1, 7, 8, 255, 255};
  for (int i = 0; i < 8; ++i) level(0, i) = values[i];
  const auto grey = quantise(level);
  const auto grey16 = quantise16(level);
  for (int i = 0; i < 8; ++i) EXPECT_EQ(grey(0, i), grey8[i]) << i;
  EXPECT_EQ(grey16(0, 0), 0);
  EXPECT_EQ(grey16(0, 6), 65535);
  EXPECT_EQ(grey16(0, 7), 65535);
  EXPECT_EQ(grey16(0, 5), std::lround(7.51 / 255 * 65535));
  for (int k = 0; k <= 255; ++k) {
    Image2<float> one(1, 1, static_cast<float>(k) / 255.0F);
    EXPECT_EQ(quantise(one)(0, 0), k);
  }
  for (int k = 0; k <= 65535; ++k) {
    Image2<float> one(1, 1, static_cast<float>(k) / 65535.0F);
    ASSERT_EQ(quantise16(one)(0, 0), k);
  }
}

}  // namespace
}  // namespace ensonify
