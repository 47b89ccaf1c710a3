#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

#include "ensonify/filters/filter_chain.hpp"
#include "ensonify/filters/filter_registry.hpp"
#include "ensonify/filters/haar.hpp"

namespace ensonify {
namespace {

Image2<float> random_image(int rows, int columns) {
  Image2<float> image(rows, columns);
  for (float& x : image.pixels()) x = static_cast<float>(*rc::gen::inRange(0, 1021)) / 4.0F;
  return image;
}

double energy(const Image2<float>& image) {
  double sum = 0;
  for (const float x : image.pixels()) sum += static_cast<double>(x) * x;
  return sum;
}

RC_GTEST_PROP(Haar, JoiningUndoesSplitting, ()) {
  const Image2<float> image = random_image(*rc::gen::inRange(1, 40), *rc::gen::inRange(1, 40));
  Image2<float> low = image;
  const auto levels = split_haar(low, *rc::gen::inRange(1, 7));
  const Image2<float> joined = join_haar(low, levels);
  for (std::size_t i = 0; i < image.size(); ++i) RC_ASSERT(std::abs(joined.pixels()[i] - image.pixels()[i]) < 1e-3F);
}

RC_GTEST_PROP(Haar, EnergyIsKeptWhereSidesAreEven, ()) {
  const Image2<float> image = random_image(8 * *rc::gen::inRange(1, 4), 8 * *rc::gen::inRange(1, 4));
  Image2<float> low = image;
  double sum = 0;
  for (const HaarLevel& level : split_haar(low, 3)) {
    sum += energy(level.rows) + energy(level.columns) + energy(level.diagonal);
  }
  RC_ASSERT(std::abs(sum + energy(low) - energy(image)) <= 1e-5 * energy(image));
}

/// A vertical edge has detail across columns only.
TEST(Haar, BandsAreWhatTheirNamesSay) {
  Image2<float> image(2, 2);
  image(0, 0) = image(1, 0) = 8;
  const auto levels = split_haar(image, 1);
  EXPECT_EQ(image(0, 0), 8);
  EXPECT_EQ(levels[0].columns(0, 0), 8);
  EXPECT_EQ(levels[0].rows(0, 0), 0);
  EXPECT_EQ(levels[0].diagonal(0, 0), 0);
}

/// A coefficient d of a 16 x 16 image (one level, 4 x 4 pixels apart) becomes max(d - T, 0), T = sigma sqrt(2 ln 256).
TEST(Wavelet, VisuShrinkTakesTheUniversalThresholdOff) {
  Image2<float> image(16, 16, 100.0F);
  image(4, 4) += 40, image(4, 5) -= 40, image(5, 4) -= 40, image(5, 5) += 40;  // one diagonal coefficient of 80
  FilterStep step = make_filter("wavelet");
  assign_parameter(step, "sigma=3");
  const Image2<float> out = apply({"test", {step}}, {image, GreyDepth::real}).grey;
  const double left = (80.0 - 3.0 * std::sqrt(2.0 * std::log(256.0))) / 2.0;
  EXPECT_NEAR(out(4, 4), 100.0 + left, 1e-4);
  EXPECT_NEAR(out(4, 5), 100.0 - left, 1e-4);
  EXPECT_NEAR(out(0, 0), 100.0, 1e-4);
}

}  // namespace
}  // namespace ensonify
