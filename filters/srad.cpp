#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "ensonify/filters/diffusion.hpp"

namespace ensonify {
namespace {

using Row = std::vector<float>;
/// Of I + 1: negative levels, which no sonar gives, must not divide by zero.
constexpr float least_pixel = 1e-3F;

/// Coefficient of variation of the whole image.
double variation(const Image2<float>& image) {
  double sum = 0, squares = 0;
  for (const float x : image.pixels()) {
    sum += x;
    squares += static_cast<double>(x) * x;
  }
  const auto n = static_cast<double>(image.size());
  const double mean = sum / n;
  return std::sqrt(std::max(squares / n - mean * mean, 0.0)) / mean;
}

/// A row with its end pixels repeated.
void repeat_ends(const float* row, int n, Row& wide) {
  std::copy_n(row, n, wide.begin() + 1);
  wide.front() = row[0];
  wide[n + 1] = row[n - 1];
}

/// Conductance of a row from itself and its neighbours, the last repeated. `wide` is scratch.
void conductances(const float* above, const float* row, const float* below, float q02, Row& wide, Row& c) {
  const int n = static_cast<int>(c.size()) - 1;
  repeat_ends(row, n, wide);
  const float* left_of = wide.data();
  const float* right_of = wide.data() + 2;
  const float scale = 1.0F / (q02 * (1.0F + q02));
  for (int j = 0; j < n; ++j) {
    const float inverse = 1.0F / std::max(row[j], least_pixel);
    const float up = above[j] - row[j], down = below[j] - row[j];
    const float left = left_of[j] - row[j], right = right_of[j] - row[j];
    const float gradient2 = (up * up + down * down + left * left + right * right) * inverse * inverse;
    const float laplacian = (up + down + left + right) * inverse;
    const float divisor = 1.0F + 0.25F * laplacian;
    const float q2 = std::max((0.5F * gradient2 - 0.0625F * laplacian * laplacian) / (divisor * divisor), 0.0F);
    c[j] = std::min(std::max(1.0F / (1.0F + (q2 - q02) * scale), 0.0F), 1.0F);
  }
  c[n] = c[n - 1];
}

}  // namespace

Image2<float> apply(const Srad& f, const GreyImage& image) {
  Image2<float> out = image.grey;
  for (float& x : out.pixels()) x += 1.0F;
  const double q0 = f.q0.value_or(variation(out));
  const int rows = out.rows(), columns = out.columns();
  Row c(columns + 1), c_below(columns + 1), above(columns), wide(columns + 2);
  const auto at = [&](int i) { return out.row(std::clamp(i, 0, rows - 1)).data(); };
  const auto quarter = static_cast<float>(f.dt / 4.0);
  for (int n = 0; n < f.iterations; ++n) {
    const double q = q0 * std::exp(-f.rho * f.dt * n);
    const auto q02 = static_cast<float>(q * q);
    if (q02 < 1e-12F) break;  // no speckle, nothing to diffuse
    conductances(at(0), at(0), at(1), q02, wide, c);
    std::copy_n(at(0), columns, above.begin());
    for (int i = 0; i < rows; ++i) {
      float* row = at(i);
      if (i + 1 < rows) {
        conductances(row, at(i + 1), at(i + 2), q02, wide, c_below);
      } else {
        c_below = c;
      }
      repeat_ends(row, columns, wide);
      const float* old = wide.data() + 1;
      const float* below = i + 1 < rows ? at(i + 1) : old;
      for (int j = 0; j < columns; ++j) {
        row[j] = old[j] + quarter * (c_below[j] * (below[j] - old[j]) + c[j] * (above[j] - old[j]) +
                                     c[j + 1] * (old[j + 1] - old[j]) + c[j] * (old[j - 1] - old[j]));
      }
      std::copy_n(old, columns, above.begin());
      c.swap(c_below);
    }
  }
  for (float& x : out.pixels()) x -= 1.0F;
  return out;
}

}  // namespace ensonify
