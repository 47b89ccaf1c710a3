#include "ensonify/evaluation/image_scores.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "ensonify/core/random.hpp"

namespace ensonify {
namespace {

Image2<float> constant(float level, int side = 32) { return Image2<float>(side, side, level); }

/// A bright square on a dark ground.
Image2<float> square() {
  Image2<float> image(64, 64, 30.0F);
  for (int r = 20; r < 44; ++r) {
    for (int c = 20; c < 44; ++c) image(r, c) = 120.0F;
  }
  return image;
}

TEST(ImageScores, PsnrOfAConstantDifferenceIsTheClosedForm) {
  EXPECT_NEAR(psnr_db(constant(30), constant(20)), 20.0 * std::log10(25.5), 1e-9);
  EXPECT_TRUE(std::isinf(psnr_db(constant(30), constant(30))));
}

/// Two constants a, b: variances are 0, so that ssim = (2 a b + C1) / (a^2 + b^2 + C1), C1 = (0.01 * 255)^2.
TEST(ImageScores, SsimOfTwoConstantsIsTheClosedForm) {
  const double a = 40, b = 70, c1 = 2.55 * 2.55;
  EXPECT_NEAR(ssim(constant(40), constant(70)), (2 * a * b + c1) / (a * a + b * b + c1), 1e-9);
  EXPECT_NEAR(ssim(square(), square()), 1.0, 1e-12);
  EXPECT_TRUE(std::isnan(ssim(constant(1, 10), constant(1, 10))));
}

/// A window flipped about its mean has the covariance of the opposite sign.
TEST(ImageScores, SsimOfTheNegativeIsNegative) {
  Image2<float> image(40, 40), negative(40, 40);
  const RandomKey key = RandomKey::from_seed(1);
  for (std::size_t i = 0; i < image.size(); ++i) {
    image.pixels()[i] = static_cast<float>(128.0 + 60.0 * normal_at(key, i));
    negative.pixels()[i] = 256.0F - image.pixels()[i];
  }
  EXPECT_LT(ssim(image, negative), -0.5);
}

TEST(ImageScores, EdgesAreKeptByAScaleAndLostByANegative) {
  Image2<float> brighter = square(), negative = square();
  for (float& x : brighter.pixels()) x = 2 * x + 5;
  for (float& x : negative.pixels()) x = 255 - x;
  EXPECT_NEAR(edge_preservation(brighter, square()), 1.0, 1e-6);
  EXPECT_NEAR(edge_preservation(negative, square()), -1.0, 1e-6);
  EXPECT_TRUE(std::isnan(edge_preservation(constant(3), square())));
}

/// Rayleigh amplitudes have m^2 / s^2 = pi / (4 - pi) = 3.660; the mean of n of them n times that. 256 tiles of 256
/// pixels, seed 2: the median's deviation is about 1.25 * 3.66 * sqrt(4 / 256) / 16, so 0.12 is 6.7 of them (the
/// median's bias is part of it). The scene's own steps must not count.
TEST(ImageScores, LooksAreThoseOfTheSpeckleAndNotOfTheScene) {
  Image2<float> clean(256, 256), one(256, 256), four(256, 256);
  const RandomKey key = RandomKey::from_seed(2);
  const auto rayleigh = [&](std::uint64_t at) {
    return std::sqrt(-2.0 * std::log(uniform_at(key, at))) / std::sqrt(M_PI / 2);
  };
  for (int r = 0; r < 256; ++r) {
    for (int c = 0; c < 256; ++c) {
      clean(r, c) = 25.0F + static_cast<float>((r + c) % 40);
      const std::uint64_t at = 4 * (static_cast<std::uint64_t>(r) * 256 + static_cast<std::uint64_t>(c));
      double sum = 0;
      for (std::uint64_t k = 0; k < 4; ++k) sum += rayleigh(at + k);
      one(r, c) = clean(r, c) * static_cast<float>(rayleigh(at));
      four(r, c) = clean(r, c) * static_cast<float>(sum / 4);
    }
  }
  EXPECT_NEAR(equivalent_looks(one, clean), M_PI / (4 - M_PI), 0.12);
  EXPECT_NEAR(equivalent_looks(four, clean), 4 * M_PI / (4 - M_PI), 0.5);
  EXPECT_TRUE(std::isnan(equivalent_looks(one, constant(10, 256))));
}

}  // namespace
}  // namespace ensonify
