#include "ensonify/filters/wiener.hpp"

#include <vector>

#include "ensonify/filters/window_sums.hpp"

namespace ensonify {
namespace {

double mean_variance(const Image2<float>& grey, int radius) {
  WindowSums sums(grey, radius, WindowBorder::zero);
  std::vector<double> mean(grey.columns()), variance(grey.columns());
  double total = 0;
  for (int i = 0; i < grey.rows(); ++i) {
    sums.next_row(mean, variance);
    for (const double v : variance) total += v;
  }
  return total / static_cast<double>(grey.size());
}

}  // namespace

Image2<float> apply(const Wiener& f, const GreyImage& image) {
  const double noise = f.noise ? *f.noise : mean_variance(image.grey, f.window.radius());
  Image2<float> out(image.grey.rows(), image.grey.columns());
  WindowSums sums(image.grey, f.window.radius());
  std::vector<double> mean(out.columns()), variance(out.columns());
  for (int i = 0; i < out.rows(); ++i) {
    sums.next_row(mean, variance);
    const auto in = image.grey.row(i);
    const auto row = out.row(i);
    for (std::size_t j = 0; j < row.size(); ++j) {
      const double gain = variance[j] > noise ? 1.0 - noise / variance[j] : 0.0;
      row[j] = static_cast<float>(mean[j] + gain * (in[j] - mean[j]));
    }
  }
  return out;
}

}  // namespace ensonify
