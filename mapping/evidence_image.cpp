#include "ensonify/mapping/evidence_image.hpp"

#include <algorithm>
#include <bit>

#include "ensonify/core/parallel.hpp"

namespace ensonify {
namespace {

using Classes = Image2<std::uint8_t>;

void strongest_of(std::span<const std::uint8_t> a, std::span<const std::uint8_t> b, std::span<std::uint8_t> out) {
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = std::max(a[i], b[i]);
}

/// The strongest at or before each bin of a beam.
Classes strongest_so_far(Classes image) {
  for (int k = 1; k < image.rows(); ++k) strongest_of(image.row(k - 1), image.row(k), image.row(k));
  return image;
}

/// The strongest within `half` bins of each: windows of doubling length, two of which make one of any length.
Classes pooled_in_range(const Classes& image, int half) {
  half = std::min(half, image.rows());
  if (half == 0) return image;
  const int rows = image.rows();
  Classes window(rows + 2 * half, image.columns());  // starting at its row, silence beyond the ends
  for (int k = 0; k < rows; ++k) std::copy(image.row(k).begin(), image.row(k).end(), window.row(k + half).begin());
  int length = 1;
  for (; 2 * length <= 2 * half + 1; length *= 2) {
    for (int k = 0; k + length < window.rows(); ++k) strongest_of(window.row(k), window.row(k + length), window.row(k));
  }
  Classes out(rows, image.columns());
  for (int k = 0; k < rows; ++k) strongest_of(window.row(k), window.row(k + 2 * half + 1 - length), out.row(k));
  return out;
}

/// The strongest within `half_rad` of each beam of one row, whose azimuths descend.
void pool_across(const std::vector<double>& azimuth_rad, double half_rad, std::span<std::uint8_t> row,
                 std::vector<std::uint8_t>& windows) {
  const auto [least, most] = std::minmax_element(row.begin(), row.end());
  if (*least == *most) return;
  const std::size_t n = row.size();
  // Level j: the strongest of the 2^j beams from each on.
  const int levels = static_cast<int>(std::bit_width(n));
  windows.resize(static_cast<std::size_t>(levels) * n);
  std::copy(row.begin(), row.end(), windows.begin());
  int made = 1;
  std::size_t from = 0;
  std::size_t to = 0;  // excluded
  for (std::size_t b = 0; b < n; ++b) {
    while (azimuth_rad[from] > azimuth_rad[b] + half_rad) ++from;
    to = std::max(to, b + 1);
    while (to < n && azimuth_rad[to] >= azimuth_rad[b] - half_rad) ++to;
    const int level = static_cast<int>(std::bit_width(to - from)) - 1;
    for (; made <= level; ++made) {
      const std::uint8_t* half = windows.data() + static_cast<std::size_t>(made - 1) * n;
      std::uint8_t* whole = windows.data() + static_cast<std::size_t>(made) * n;
      const std::size_t step = std::size_t{1} << (made - 1);
      for (std::size_t i = 0; i + step < n; ++i) whole[i] = std::max(half[i], half[i + step]);
    }
    const std::uint8_t* window = windows.data() + static_cast<std::size_t>(level) * n;
    row[b] = std::max(window[from], window[to - (std::size_t{1} << level)]);
  }
}

Classes pooled(const Classes& image, const SonarGeometry& g, double half_m) {
  constexpr int rows_a_task = 32;
  constexpr double rounding = 1e-9;
  const double half_bins = std::min(half_m / g.bin_size_m() + rounding, 1.0 * image.rows());
  Classes out = pooled_in_range(image, static_cast<int>(half_bins));
  parallel_for((image.rows() + rows_a_task - 1) / rows_a_task, [&](int task) {
    std::vector<std::uint8_t> windows;
    for (int k = task * rows_a_task; k < std::min(image.rows(), (task + 1) * rows_a_task); ++k) {
      pool_across(g.beam_azimuth_rad, half_m / g.bin_centre_m(k), out.row(k), windows);
    }
  });
  return out;
}

}  // namespace

template <typename M>
EvidenceImage<M> evidence_of(const ClassImage& classes, const SonarGeometry& geometry, double footprint_m,
                             Shadow shadow, bool echoes_count) {
  const Classes echo = pooled(classes.class_of_pixel, geometry, 0.5 * footprint_m);
  const Classes before =
      shadow == Shadow::ignored ? echo : pooled(strongest_so_far(classes.class_of_pixel), geometry, 0.5 * footprint_m);
  EvidenceImage<M> out(echo.size() + 1);
  for (std::size_t i = 0; i < echo.size(); ++i) {
    out[i] = mark_of<M>(echoes_count ? echo.pixels()[i] : classes.class_of_silence, before.pixels()[i]);
  }
  return out;
}

template EvidenceImage<Mark> evidence_of<Mark>(const ClassImage&, const SonarGeometry&, double, Shadow, bool);
template EvidenceImage<SweepMark> evidence_of<SweepMark>(const ClassImage&, const SonarGeometry&, double, Shadow, bool);

}  // namespace ensonify
