#include "ensonify/filters/lee_family.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "ensonify/filters/pyradar_windows.hpp"
#include "ensonify/filters/window_sums.hpp"

namespace ensonify {
namespace {

using Row = std::vector<double>;
constexpr double tiny = std::numeric_limits<double>::min();

/// Ci of the window about a pixel in two passes, sums of rows first: the order in which numpy adds up a window.
double variation_by_rows(const Image2<float>& grey, int row, int column, int radius) {
  const auto mean_of = [&](const auto& value) {
    double total = 0;
    for (int y = row - radius; y <= row + radius; ++y) {
      const auto pixels = grey.row(mirrored(y, grey.rows()));
      double sum = 0;
      for (int x = column - radius; x <= column + radius; ++x) sum += value(pixels[mirrored(x, grey.columns())]);
      total += sum;
    }
    const double side = 2.0 * radius + 1.0;
    return total / (side * side);
  };
  const double mean = mean_of([](double x) { return x; });
  return std::sqrt(mean_of([=](double x) { return (x - mean) * (x - mean); })) / mean;
}

/// Calls weigh(row, mean, Ci^2, pixels, out) for every row.
template <typename Weigh>
Image2<float> over_rows(const Image2<float>& grey, int radius, const Weigh& weigh) {
  Image2<float> out(grey.rows(), grey.columns());
  WindowSums sums(grey, radius);
  Row mean(grey.columns()), variation2(grey.columns());
  for (int i = 0; i < grey.rows(); ++i) {
    sums.next_row(mean, variation2);
    for (std::size_t j = 0; j < mean.size(); ++j) variation2[j] /= std::max(mean[j] * mean[j], tiny);
    weigh(i, mean, variation2, grey.row(i), out.row(i));
  }
  return out;
}

/// Lee's and Kuan's weight differ by a constant factor.
Image2<float> linear_weight(const Image2<float>& grey, int radius, double cu, double factor) {
  return over_rows(grey, radius,
                   [=](int, const Row& mean, const Row& variation2, std::span<const float> in, std::span<float> out) {
                     for (std::size_t j = 0; j < out.size(); ++j) {
                       const double weight = std::max(1.0 - cu * cu / std::max(variation2[j], tiny), 0.0) * factor;
                       out[j] = static_cast<float>(mean[j] + weight * (in[j] - mean[j]));
                     }
                   });
}

}  // namespace

Image2<float> apply(const Lee& f, const GreyImage& image) {
  if (f.variant == FilterVariant::pyradar) return pyradar_lee(image.grey, f.window.pixels, f.cu, 1.0);
  return linear_weight(image.grey, f.window.radius(), f.cu, 1.0);
}

Image2<float> apply(const Kuan& f, const GreyImage& image) {
  const double factor = 1.0 / (1.0 + f.cu * f.cu);
  if (f.variant == FilterVariant::pyradar) return pyradar_lee(image.grey, f.window.pixels, f.cu, factor);
  return linear_weight(image.grey, f.window.radius(), f.cu, factor);
}

Image2<float> apply(const LeeEnhanced& f, const GreyImage& image) {
  if (f.variant == FilterVariant::pyradar) return pyradar_lee_enhanced(image.grey, f);
  // Of its own memory: where Eigen maps foreign memory, its alignment would decide which numbers go the scalar way.
  Eigen::ArrayXd weight(image.grey.columns());
  return over_rows(image.grey, f.window.radius(),
                   [&](int, const Row& mean, const Row& variation2, std::span<const float> in, std::span<float> out) {
                     // Held between cu and cmax the exponent gives the outer classes too: 1 at cu, 0 at cmax.
                     for (Eigen::Index j = 0; j < weight.size(); ++j) {
                       const double c =
                           std::min(std::max(std::sqrt(variation2[static_cast<std::size_t>(j)]), f.cu), f.cmax);
                       weight[j] = -f.k * (c - f.cu) / std::max(f.cmax - c, 1e-12);
                       if (c == f.cmax) weight[j] = -1e3;
                     }
                     weight = weight.exp();
                     for (std::size_t j = 0; j < out.size(); ++j) {
                       out[j] = static_cast<float>(in[j] + weight[static_cast<Eigen::Index>(j)] * (mean[j] - in[j]));
                     }
                   });
}

Image2<float> apply(const GammaMap& f, const GreyImage& image) {
  const double cu2 = f.cu * f.cu;
  const double looks = f.looks.value_or(1.0 / cu2);
  const double cmax = f.cmax.value_or(std::sqrt(2.0) * f.cu);
  const double keep_from = cmax * cmax;
  return over_rows(image.grey, f.window.radius(),
                   [&](int i, const Row& mean, const Row& variation2, std::span<const float> in, std::span<float> out) {
                     for (std::size_t j = 0; j < out.size(); ++j) {
                       const double m = mean[j], c2 = variation2[j], pixel = in[j];
                       // Below cu a grows beyond bounds and the root goes to m.
                       const double a = (1.0 + cu2) / std::max(c2 - cu2, 1e-30);
                       const double bm = (a - looks - 1.0) * m;
                       const double root = std::sqrt(std::max(bm * bm + 4.0 * a * looks * m * pixel, 0.0));
                       const double between = (bm + root) / (2.0 * a);
                       const double kept = c2 >= keep_from ? pixel : between;
                       out[j] = static_cast<float>(c2 <= cu2 ? m : kept);
                     }
                     // The result jumps at cmax, and windows of whole grey levels meet it exactly: rounding decides, so
                     // numpy's is taken.
                     for (std::size_t j = 0; j < out.size(); ++j) {
                       if (std::abs(variation2[j] - keep_from) > 1e-9 * keep_from) continue;
                       const double m = mean[j], a = (1.0 + cu2) / (keep_from - cu2), bm = (a - looks - 1.0) * m;
                       const bool stays =
                           variation_by_rows(image.grey, i, static_cast<int>(j), f.window.radius()) >= cmax;
                       const double between = (bm + std::sqrt(bm * bm + 4.0 * a * looks * m * in[j])) / (2.0 * a);
                       out[j] = stays ? in[j] : static_cast<float>(between);
                     }
                   });
}

}  // namespace ensonify
