#include "ensonify/filters/haar.hpp"

#include <utility>

namespace ensonify {
namespace {

/// Pixels (2k, 2k + 1) of both rows -> the four bands at k.
void split_rows(const float* top, const float* bottom, int columns, float* low, float* across_rows,
                float* across_columns, float* diagonal) {
  const auto put = [&](int k, float a, float b, float c, float d) {
    low[k] = 0.5F * ((a + b) + (c + d));
    across_columns[k] = 0.5F * ((a - b) + (c - d));
    across_rows[k] = 0.5F * ((a + b) - (c + d));
    diagonal[k] = 0.5F * ((a - b) - (c - d));
  };
  const int whole = columns / 2;
  for (int k = 0; k < whole; ++k) put(k, top[2 * k], top[2 * k + 1], bottom[2 * k], bottom[2 * k + 1]);
  if (columns % 2 == 1) put(whole, top[columns - 1], top[columns - 1], bottom[columns - 1], bottom[columns - 1]);
}

HaarLevel split(Image2<float>& image) {
  const int rows = (image.rows() + 1) / 2, columns = (image.columns() + 1) / 2;
  HaarLevel level{Image2<float>(rows, columns), Image2<float>(rows, columns), Image2<float>(rows, columns),
                  image.rows(), image.columns()};
  Image2<float> low(rows, columns);
  for (int k = 0; k < rows; ++k) {
    const int bottom = 2 * k + 1 < image.rows() ? 2 * k + 1 : 2 * k;
    split_rows(image.row(2 * k).data(), image.row(bottom).data(), image.columns(), low.row(k).data(),
               level.rows.row(k).data(), level.columns.row(k).data(), level.diagonal.row(k).data());
  }
  image = std::move(low);
  return level;
}

Image2<float> join(const Image2<float>& low, const HaarLevel& level) {
  Image2<float> image(level.image_rows, level.image_columns);
  for (int i = 0; i < image.rows(); ++i) {
    const int k = i / 2;
    const float sign = i % 2 == 0 ? 1.0F : -1.0F;
    const float* a = low.row(k).data();
    const float* r = level.rows.row(k).data();
    const float* c = level.columns.row(k).data();
    const float* d = level.diagonal.row(k).data();
    float* out = image.row(i).data();
    const int whole = image.columns() / 2;
    for (int m = 0; m < whole; ++m) {
      const float even = a[m] + sign * r[m], odd = c[m] + sign * d[m];
      out[2 * m] = 0.5F * (even + odd);
      out[2 * m + 1] = 0.5F * (even - odd);
    }
    if (image.columns() % 2 == 1) out[2 * whole] = 0.5F * ((a[whole] + sign * r[whole]) + (c[whole] + sign * d[whole]));
  }
  return image;
}

}  // namespace

std::vector<HaarLevel> split_haar(Image2<float>& image, int count) {
  std::vector<HaarLevel> levels;
  for (int n = 0; n < count; ++n) levels.push_back(split(image));
  return levels;
}

Image2<float> join_haar(Image2<float> approximation, const std::vector<HaarLevel>& levels) {
  for (auto level = levels.rbegin(); level != levels.rend(); ++level) approximation = join(approximation, *level);
  return approximation;
}

}  // namespace ensonify
