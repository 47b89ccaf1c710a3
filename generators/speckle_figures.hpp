#pragma once

#include <array>
#include <string>
#include <vector>

#include "ensonify/core/grey_image.hpp"
#include "ensonify/core/image2.hpp"
#include "ensonify/core/random.hpp"
#include "ensonify/generators/amplitude_fits.hpp"

namespace ensonify {

/// Rows [row0, row1), columns [column0, column1).
struct Region {
  int row0 = 0, row1 = 0, column0 = 0, column1 = 0;

  int rows() const { return row1 - row0; }
  int columns() const { return column1 - column0; }
  bool within(int image_rows, int image_columns) const {
    return row0 >= 0 && column0 >= 0 && rows() > 0 && columns() > 0 && row1 <= image_rows && column1 <= image_columns;
  }
};

constexpr int most_lag = 7;
constexpr int most_fitted = 6000;
constexpr int speckle_window = 25;
constexpr double saturated_level = 254;
using Autocorrelation = std::array<double, most_lag + 1>;

/// Statistics of the speckle of one region.
struct SpeckleFigures {
  double mean_level = 0;
  double zero_share = 0, saturated_share = 0;  ///< of pixels: level 0; level 254 or more
  double contrast = 0;                         ///< standard deviation over mean of the values fitted
  AmplitudeFits fits;                          ///< of values of mean 1
  double moment_ratio = 0;                     ///< <I^2> / <I>^2 of I = x^(Weibull shape): 2 where fully developed
  Autocorrelation range{}, beam{};             ///< lags 0..7
};

/// The region divided by its local mean: pixel plus an even jitter of one step (a look-up of `key` and the pixel's
/// place in the image), at least a thousandth of a step, over the mean of 25 x 25 of those, the region mirrored at its
/// border. The region must lie within the image.
Image2<double> normalised_speckle(const GreyImage& image, const Region& region, RandomKey key);

/// Of values of mean 1 that are drawn from all, at most 6000.
std::vector<double> drawn_values(const Image2<double>& normalised, RandomKey key);

/// Normalised autocorrelation along range or along beams; 0 where an image is too small for a lag or even.
Autocorrelation range_autocorrelation(const Image2<double>& image);
Autocorrelation beam_autocorrelation(const Image2<double>& image);

/// Pearson's correlation of two images of one size; 0 where one is even.
double correlation(const Image2<double>& a, const Image2<double>& b);

/// Of every figure the median over regions; of none, zeros.
SpeckleFigures median_figures(std::vector<SpeckleFigures> regions);

/// All of it, by the conventions of docs/datasets.md, "Against real images".
SpeckleFigures speckle_figures(const GreyImage& image, const Region& region, RandomKey key);

}  // namespace ensonify
