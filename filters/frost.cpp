#include "ensonify/filters/frost.hpp"

#include <Eigen/Core>
#include <cmath>
#include <limits>
#include <map>
#include <vector>

#include "ensonify/filters/pyradar_windows.hpp"
#include "ensonify/filters/window_sums.hpp"

namespace ensonify {
namespace {

struct Offset {
  int row = 0, column = 0;
};

/// Pixels of a window that are equally far from its centre share a weight.
struct Ring {
  double distance = 0;
  std::vector<Offset> offsets;  ///< from the window's first pixel
};

std::vector<Ring> rings_of(int radius) {
  std::map<int, std::vector<Offset>> by_square;
  for (int y = -radius; y <= radius; ++y) {
    for (int x = -radius; x <= radius; ++x) by_square[y * y + x * x].push_back({y + radius, x + radius});
  }
  std::vector<Ring> rings;
  for (auto& [square, offsets] : by_square)
    rings.push_back({std::sqrt(static_cast<double>(square)), std::move(offsets)});
  return rings;
}

}  // namespace

Image2<float> apply(const Frost& f, const GreyImage& image) {
  if (f.variant == FilterVariant::pyradar) return pyradar_frost(image, f);
  using Array = Eigen::Array<float, Eigen::Dynamic, 1>;
  const int radius = f.window.radius();
  const Image2<float> wide = mirrored_border(image.grey, radius);
  const std::vector<Ring> rings = rings_of(radius);
  const int columns = image.grey.columns();
  WindowSums sums(image.grey, radius);
  std::vector<double> mean(columns), variance(columns);
  Array decay(columns), ring_sum(columns), weight(columns), sum(columns), weight_sum(columns);
  Image2<float> out(image.grey.rows(), columns);
  for (int i = 0; i < out.rows(); ++i) {
    sums.next_row(mean, variance);
    for (int j = 0; j < columns; ++j) {
      const double m2 = std::max(mean[j] * mean[j], std::numeric_limits<double>::min());
      // Beyond 80 a weight is nothing beside the centre's.
      decay[j] = static_cast<float>(std::min(f.damping * variance[j] / m2, 80.0));
    }
    sum.setZero();
    weight_sum.setZero();
    for (const Ring& ring : rings) {
      ring_sum.setZero();
      for (const Offset& at : ring.offsets) {
        ring_sum += Eigen::Map<const Array>(wide.row(i + at.row).data() + at.column, columns);
      }
      weight = (decay * static_cast<float>(-ring.distance)).exp();
      sum += weight * ring_sum;
      weight_sum += weight * static_cast<float>(ring.offsets.size());
    }
    Eigen::Map<Array>(out.row(i).data(), columns) = sum / weight_sum;
  }
  return out;
}

}  // namespace ensonify
