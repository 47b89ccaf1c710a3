#include "ensonify/generators/speckle_figures.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>

#include "ensonify/generators/even_tiles.hpp"

namespace ensonify {
namespace {

const RandomKey key = RandomKey::from_seed(11);

GreyImage image_of(int rows, int columns, const auto& level) {
  GreyImage image{Image2<float>(rows, columns), GreyDepth::bits8};
  for (int r = 0; r < rows; ++r) {
    for (int c = 0; c < columns; ++c) image.grey(r, c) = static_cast<float>(level(r, c));
  }
  return image;
}

// Means mirrored at the border, pixel by pixel by their definition.
TEST(NormalisedSpeckle, IsThePixelOverItsMirroredMean) {
  const GreyImage image = image_of(40, 70, [](int r, int c) { return 30 + (r * 37 + c * 101 + r * c) % 90; });
  const Region region{5, 24, 10, 65};  // 19 rows: fewer than the window
  const Image2<double> normalised = normalised_speckle(image, region, key);
  ASSERT_EQ(normalised.rows(), 19);
  ASSERT_EQ(normalised.columns(), 55);
  const auto mirrored = [](int i, int n) { return i < 0 ? -1 - i : i >= n ? 2 * n - 1 - i : i; };
  for (const auto& [r, c] : {std::pair{0, 0}, {18, 54}, {9, 27}, {3, 50}}) {
    double sum = 0;
    for (int i = -12; i <= 12; ++i) {
      for (int j = -12; j <= 12; ++j) sum += image.grey(5 + mirrored(r + i, 19), 10 + mirrored(c + j, 55));
    }
    EXPECT_NEAR(normalised(r, c), image.grey(5 + r, 10 + c) / (sum / 625), 0.55 / (sum / 625)) << r << " " << c;
  }
}

TEST(NormalisedSpeckle, OfEmptyWaterIsJitter) {
  const GreyImage image = image_of(64, 64, [](int, int) { return 0; });
  const auto normalised = normalised_speckle(image, {0, 64, 0, 64}, key);
  for (const double v : normalised.pixels()) EXPECT_TRUE(v > 0 && std::isfinite(v));
  EXPECT_NEAR(correlation(normalised, normalised_speckle(image, {0, 64, 0, 64}, key.child(1))), 0, 0.06);
  EXPECT_EQ(normalised, normalised_speckle(image, {0, 64, 0, 64}, key));
}

TEST(Autocorrelation, TellsRangeFromBeams) {
  Image2<double> stripes(64, 64);
  for (int r = 0; r < 64; ++r) {
    for (int c = 0; c < 64; ++c) stripes(r, c) = c % 4 < 2 ? 1 : -1;
  }
  const Autocorrelation range = range_autocorrelation(stripes), beam = beam_autocorrelation(stripes);
  for (const double v : range) EXPECT_NEAR(v, 1, 1e-12);
  EXPECT_NEAR(beam[2], -1, 1e-12);
  EXPECT_NEAR(beam[4], 1, 1e-12);
  EXPECT_NEAR(beam[1], 0, 0.02);
}

/// Fully developed speckle at gamma 0.5: white circular complex Gauss cells, smeared before detection by a Gaussian of
/// sigma 1 beam and 0.4 range bin.
GreyImage gaussian_speckle(int rows, int columns, RandomKey cells) {
  constexpr int reach = 5;
  const auto kernel = [](double d, double sigma) { return std::exp(-d * d / (2 * sigma * sigma)); };
  const int wide = columns + 2 * reach;
  const auto cell = [&](int r, int c) {
    const auto at = 2 * (static_cast<std::uint64_t>(r) * wide + c);
    return std::complex<double>(normal_at(cells, at), normal_at(cells, at + 1));
  };
  Image2<std::complex<double>> white(rows + 2 * reach, wide);
  for (int r = 0; r < white.rows(); ++r) {
    for (int c = 0; c < wide; ++c) white(r, c) = cell(r, c);
  }
  return image_of(rows, columns, [&](int r, int c) {
    std::complex<double> sum = 0;
    for (int i = -reach; i <= reach; ++i) {
      for (int j = -reach; j <= reach; ++j) {
        sum += kernel(i, 0.4) * kernel(j, 1.0) * white(r + reach + i, c + reach + j);
      }
    }
    return std::min(255.0, std::round(40 * std::sqrt(std::abs(sum))));
  });
}

// The field's correlation at lag l is exp(-l^2 / (4 sigma^2)), and the root of the amplitude correlates nearly as the
// intensity does: by its square, 0.61 and 0.14 for 1 and 2 beams; the local mean and the root take some of it. Recorded
// for 400 x 256 such cells: shape 3.96, KS 0.008, moment ratio 1.96, beams 0.53 0.11 0.00, range 0.
TEST(SpeckleFigures, OfFullyDevelopedSpeckle) {
  const GreyImage image = gaussian_speckle(400, 256, key.child("cells"));
  const SpeckleFigures f = speckle_figures(image, {0, 400, 0, 256}, key);
  EXPECT_NEAR(f.fits.weibull_shape, 3.96, 0.1);
  EXPECT_LT(f.fits.ks.weibull, 0.016);
  EXPECT_NEAR(f.moment_ratio, 1.97, 0.07);
  EXPECT_NEAR(f.beam[1], 0.54, 0.04);
  EXPECT_NEAR(f.beam[2], 0.11, 0.03);
  EXPECT_NEAR(f.beam[3], 0.0, 0.03);
  EXPECT_NEAR(f.range[1], 0.0, 0.03);
  EXPECT_NEAR(f.contrast, 0.28, 0.02);
  EXPECT_GT(f.fits.ks.rayleigh, 0.15);

  // A tile holds 2048 pixels and mirrors its border, and still says what a large area does.
  std::vector<SpeckleFigures> tiles;
  for (const Tile& tile : all_tiles(image)) tiles.push_back(speckle_figures(image, tile.region, key));
  const SpeckleFigures median = median_figures(tiles);
  std::printf(
      "whole: shape %.3f ks %.4f ratio %.3f beam %.3f %.3f range %.3f; tiles: shape %.3f ks %.4f ratio %.3f beam "
      "%.3f %.3f range %.3f\n",
      f.fits.weibull_shape, f.fits.ks.weibull, f.moment_ratio, f.beam[1], f.beam[2], f.range[1],
      median.fits.weibull_shape, median.fits.ks.weibull, median.moment_ratio, median.beam[1], median.beam[2],
      median.range[1]);
  EXPECT_NEAR(median.fits.weibull_shape, f.fits.weibull_shape, 0.1);
  EXPECT_NEAR(median.moment_ratio, f.moment_ratio, 0.05);
  EXPECT_NEAR(median.beam[1], f.beam[1], 0.02);
  EXPECT_LT(median.fits.ks.weibull, 0.03);
}

}  // namespace
}  // namespace ensonify
