#include "ensonify/generators/level_figures.hpp"

#include <algorithm>
#include <cmath>

namespace ensonify {
namespace {

template <typename Sums>
void add_to(Sums& sums, const Sums& more) {
  for (std::size_t i = 0; i < more.size(); ++i) sums[i] += more[i];
}

/// Of n places in `parts` parts that differ by one place at most, the longer ones first (numpy.array_split): the part
/// of place i.
std::size_t part_of(int i, int n, int parts) {
  const int least = n / parts, longer = n % parts;
  const int in_longer = longer * (least + 1);
  return static_cast<std::size_t>(i < in_longer ? i / (least + 1) : longer + (i - in_longer) / least);
}

}  // namespace

LevelSums& LevelSums::operator+=(const LevelSums& other) {
  add_to(histogram, other.histogram);
  pixels += other.pixels;
  zeros += other.zeros;
  saturated += other.saturated;
  sum += other.sum;
  square += other.square;
  add_to(range_sum, other.range_sum);
  add_to(range_pixels, other.range_pixels);
  add_to(beam_sum, other.beam_sum);
  add_to(beam_pixels, other.beam_pixels);
  return *this;
}

double LevelSums::mean() const { return sum / static_cast<double>(pixels); }

double LevelSums::standard_deviation() const {
  return std::sqrt(std::max(0.0, square / static_cast<double>(pixels) - mean() * mean()));
}

double LevelSums::percentile(double percent) const {
  const auto level_at = [&](std::uint64_t rank) {
    std::uint64_t below = 0;
    for (std::size_t level = 0; level < histogram.size(); ++level) {
      below += histogram[level];
      if (rank < below) return static_cast<double>(level);
    }
    return 255.0;
  };
  const double at = percent / 100 * static_cast<double>(pixels - 1);
  const auto rank = static_cast<std::uint64_t>(at);
  const double low = level_at(rank), high = level_at(std::min(rank + 1, pixels - 1));
  return low + (at - static_cast<double>(rank)) * (high - low);
}

LevelSums sum_levels(const GreyImage& image) {
  LevelSums sums;
  const int rows = image.grey.rows(), columns = image.grey.columns();
  sums.pixels = image.grey.size();
  for (int r = 0; r < rows; ++r) {
    const std::size_t range = part_of(r, rows, range_profile_bins);
    for (int c = 0; c < columns; ++c) {
      const double level = image.grey(r, c);
      const std::size_t beam = part_of(c, columns, beam_profile_bins);
      ++sums.histogram[static_cast<std::size_t>(std::clamp(level, 0.0, 255.0))];
      sums.zeros += level == 0 ? 1 : 0;
      sums.saturated += level >= saturated_level ? 1 : 0;
      sums.sum += level;
      sums.square += level * level;
      sums.range_sum[range] += level;
      ++sums.range_pixels[range];
      sums.beam_sum[beam] += level;
      ++sums.beam_pixels[beam];
    }
  }
  return sums;
}

}  // namespace ensonify
