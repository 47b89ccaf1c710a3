#include "ensonify/filters/wavelet.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <vector>

#include "ensonify/filters/haar.hpp"

namespace ensonify {
namespace {

/// Upper quartile of the standard normal: median |x| of unit noise.
constexpr double normal_quartile = 0.6744897501960817;
/// median |d| / 0.6745 of the coefficients that are not zero; 0 where none is.
double robust_sigma(std::vector<double> details) {
  std::erase(details, 0.0);
  for (double& d : details) d = std::abs(d);
  if (details.empty()) return 0.0;
  const auto middle = details.begin() + static_cast<std::ptrdiff_t>(details.size() / 2);
  std::nth_element(details.begin(), middle, details.end());
  double median = *middle;
  if (details.size() % 2 == 0) median = 0.5 * (median + *std::max_element(details.begin(), middle));
  return median / normal_quartile;
}

/// Index of the half-sample symmetric extension: ... 1 0 0 1 2 ... n-1 n-1 n-2 ...
int symmetric(int i, int n) {
  const int period = 2 * n;
  const int folded = ((i % period) + period) % period;
  return folded < n ? folded : period - 1 - folded;
}

/// High pass filters of Daubechies' wavelets (1988).
constexpr std::array db1_high{-0.70710678118654752440, 0.70710678118654752440};
constexpr std::array db2_high{-0.48296291314453414338, 0.83651630373780790558, -0.22414386804201338103,
                              -0.12940952255126038117};

/// Diagonal band of one level: high pass down the columns, then along the rows. What is zero but for rounding counts
/// among the coefficients of the reference, so the order of its sums is kept.
template <std::size_t Taps>
std::vector<double> diagonal_band(const Image2<float>& image, double unit, const std::array<double, Taps>& high) {
  constexpr int taps = Taps;
  const int rows = (image.rows() + taps - 1) / 2, columns = (image.columns() + taps - 1) / 2;
  std::vector<double> band(static_cast<std::size_t>(rows) * columns), filtered(image.columns());
  for (int k = 0; k < rows; ++k) {
    std::ranges::fill(filtered, 0.0);
    for (int t = 0; t < taps; ++t) {
      const auto row = image.row(symmetric(2 * k + 1 - t, image.rows()));
      for (std::size_t j = 0; j < filtered.size(); ++j) filtered[j] += high[t] * (unit * row[j]);
    }
    double* out = band.data() + static_cast<std::size_t>(k) * columns;
    for (int m = 0; m < columns; ++m) {
      const int last = 2 * m + 1;
      const bool inside = last >= taps - 1 && last < image.columns();
      for (int t = 0; t < taps; ++t) {
        out[m] += high[t] * filtered[inside ? last - t : symmetric(last - t, image.columns())];
      }
    }
  }
  return band;
}

void soft(Image2<float>& band, double threshold) {
  const auto t = static_cast<float>(threshold);
  for (float& d : band.pixels()) d = std::copysign(std::max(std::abs(d) - t, 0.0F), d);
}

double bayes_threshold(const Image2<float>& band, double sigma) {
  double energy = 0;
  for (const float d : band.pixels()) energy += static_cast<double>(d) * d;
  const double scene = energy / static_cast<double>(band.size()) - sigma * sigma;
  return sigma * sigma / std::sqrt(std::max(scene, std::numeric_limits<double>::epsilon()));
}

}  // namespace

Image2<float> apply(const Wavelet& f, const GreyImage& image) {
  const auto shortest = static_cast<unsigned>(std::min(image.grey.rows(), image.grey.columns()));
  const int levels_count = std::max(static_cast<int>(std::bit_width(shortest)) - 1 - 3, 1);
  const bool visu = f.rule == WaveletRule::visu;

  Image2<float> out = image.grey;
  std::vector<HaarLevel> levels = split_haar(out, levels_count);
  const auto estimate = [&] {
    if (visu) return robust_sigma(diagonal_band(image.grey, 1.0, db2_high));
    const double unit = image.depth == GreyDepth::real ? 1.0 : 1.0 / 255.0;  // scikit-image works on 0..1 there
    return robust_sigma(diagonal_band(image.grey, unit, db1_high)) / unit;
  };
  const double sigma = f.sigma ? *f.sigma : estimate() * f.sigma_scale.value_or(visu ? 0.25 : 1.0);
  if (sigma == 0.0) return image.grey;
  const double universal = sigma * std::sqrt(2.0 * std::log(static_cast<double>(image.grey.size())));
  for (HaarLevel& level : levels) {
    for (Image2<float>* band : {&level.rows, &level.columns, &level.diagonal}) {
      soft(*band, visu ? universal : bayes_threshold(*band, sigma));
    }
  }
  out = join_haar(std::move(out), levels);
  if (image.depth != GreyDepth::real) {
    for (float& x : out.pixels()) x = std::clamp(x, 0.0F, 255.0F);
  }
  return out;
}

}  // namespace ensonify
