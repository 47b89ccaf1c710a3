#include "ensonify/generators/perceptual_hash.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace ensonify {
namespace {

constexpr int side = thumbnail_side;
constexpr int low = 8;

/// In 1/256 of a thumbnail's level, so that cells are sums of whole numbers: the same on any machine.
std::array<std::uint32_t, 256> log_levels() {
  std::array<std::uint32_t, 256> levels{};
  for (std::size_t g = 0; g < levels.size(); ++g) {
    levels[g] = static_cast<std::uint32_t>(std::lround(255.0 * 256.0 * std::log2(1.0 + static_cast<double>(g)) / 8.0));
  }
  return levels;
}

/// Rows (or columns) of cell i: at least one.
std::pair<int, int> cell_span(int i, int length) {
  const int first = std::min(static_cast<int>(std::int64_t{i} * length / side), length - 1);
  return {first, std::max(first + 1, static_cast<int>(std::int64_t{i + 1} * length / side))};
}

/// cos(pi (2 x + 1) u / 64) for u = 0..7: the orthonormal DCT-II but for a common factor, which the median takes out.
std::array<std::array<double, side>, low> cosines() {
  std::array<std::array<double, side>, low> table{};
  for (int u = 0; u < low; ++u) {
    for (int x = 0; x < side; ++x) {
      table[u][x] =
          (u == 0 ? std::numbers::sqrt2 / 2 : 1.0) * std::cos(std::numbers::pi * (2 * x + 1) * u / (2.0 * side));
    }
  }
  return table;
}

}  // namespace

Thumbnail thumbnail_of(const Image2<std::uint8_t>& image) {
  static const auto levels = log_levels();
  Thumbnail small{};
  if (image.empty()) return small;
  for (int i = 0; i < side; ++i) {
    const auto [top, bottom] = cell_span(i, image.rows());
    for (int j = 0; j < side; ++j) {
      const auto [left, right] = cell_span(j, image.columns());
      std::uint64_t sum = 0;
      for (int r = top; r < bottom; ++r) {
        const auto row = image.row(r);
        for (int c = left; c < right; ++c) sum += levels[row[static_cast<std::size_t>(c)]];
      }
      const std::uint64_t pixels = static_cast<std::uint64_t>(bottom - top) * static_cast<std::uint64_t>(right - left);
      small[static_cast<std::size_t>(i * side + j)] = static_cast<std::uint8_t>((sum / pixels + 128) / 256);
    }
  }
  return small;
}

std::uint64_t perceptual_hash(const Thumbnail& thumbnail) {
  static const auto cosine = cosines();
  if (std::all_of(thumbnail.begin(), thumbnail.end(), [&](std::uint8_t v) { return v == thumbnail[0]; })) return 0;
  std::array<std::array<double, side>, low> rows{};  // transformed along range
  for (int u = 0; u < low; ++u) {
    for (int y = 0; y < side; ++y) {
      for (int x = 0; x < side; ++x) rows[u][x] += cosine[u][y] * thumbnail[static_cast<std::size_t>(y * side + x)];
    }
  }
  std::array<double, low * low> coefficients{};
  for (int u = 0; u < low; ++u) {
    for (int v = 0; v < low; ++v) {
      double sum = 0;
      for (int x = 0; x < side; ++x) sum += rows[u][x] * cosine[v][x];
      coefficients[static_cast<std::size_t>(u * low + v)] = sum;
    }
  }
  std::array<double, low * low - 1> sorted;
  std::copy(coefficients.begin() + 1, coefficients.end(), sorted.begin());
  std::nth_element(sorted.begin(), sorted.begin() + sorted.size() / 2, sorted.end());
  const double median = sorted[sorted.size() / 2];
  std::uint64_t hash = 0;
  for (std::size_t i = 1; i < coefficients.size(); ++i) {
    if (coefficients[i] > median) hash |= std::uint64_t{1} << i;
  }
  return hash;
}

double correlation(const Thumbnail& a, const Thumbnail& b) {
  std::int64_t sum_a = 0, sum_b = 0, sum_aa = 0, sum_bb = 0, sum_ab = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const std::int64_t x = a[i], y = b[i];
    sum_a += x;
    sum_b += y;
    sum_aa += x * x;
    sum_bb += y * y;
    sum_ab += x * y;
  }
  const auto n = static_cast<std::int64_t>(a.size());
  const auto var_a = n * sum_aa - sum_a * sum_a, var_b = n * sum_bb - sum_b * sum_b;
  if (var_a == 0 || var_b == 0) return 0;
  return static_cast<double>(n * sum_ab - sum_a * sum_b) /
         (std::sqrt(static_cast<double>(var_a)) * std::sqrt(static_cast<double>(var_b)));
}

}  // namespace ensonify
