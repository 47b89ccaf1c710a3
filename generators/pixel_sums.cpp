#include "ensonify/generators/pixel_sums.hpp"

#include <algorithm>
#include <numeric>
#include <span>

namespace ensonify {
namespace {

template <typename Sums>
void add_to(Sums& sums, const Sums& more) {
  for (std::size_t i = 0; i < more.size(); ++i) sums[i] += more[i];
}

/// Counts values by their upper byte. Four tables in turn: neighbouring pixels are often equal, and one counter can not
/// be raised twice in a cycle.
template <std::size_t Counters, typename Value>
void count_values(std::span<const Value> values, std::array<std::uint64_t, Counters>& counts) {
  std::array<std::array<std::uint32_t, 256>, 4> tables{};
  constexpr int shift = 8 * (sizeof(Value) - 1);
  for (std::size_t i = 0; i < values.size(); ++i) ++tables[i % 4][values[i] >> shift];
  for (const auto& table : tables) {
    for (std::size_t v = 0; v < Counters; ++v) counts[v] += table[v];
  }
}

template <typename Value>
std::uint64_t sum_of(std::span<const Value> values) {
  constexpr std::uint64_t unit = sizeof(Value) == 1 ? 257 : 1;
  return unit * std::accumulate(values.begin(), values.end(), std::uint32_t{0});
}

}  // namespace

PixelSums& PixelSums::operator+=(const PixelSums& other) {
  add_to(raw, other.raw);
  add_to(clean, other.clean);
  add_to(labels, other.labels);
  frames += other.frames;
  without_echo += other.without_echo;
  for (auto* bins : {&bin_pixels, &bin_mask, &bin_raw}) bins->resize(std::max(bins->size(), other.bin_pixels.size()));
  add_to(bin_pixels, other.bin_pixels);
  add_to(bin_mask, other.bin_mask);
  add_to(bin_raw, other.bin_raw);
  return *this;
}

PixelSums sum_pixels(const FramePixels& pixels, double range_min_m, double range_max_m, const RangeBins& bins) {
  PixelSums sums;
  sums.frames = 1;
  sums.bin_pixels.resize(static_cast<std::size_t>(bins.bins));
  sums.bin_mask = sums.bin_raw = sums.bin_pixels;
  std::visit([&](const auto& raw) { count_values(raw.pixels(), sums.raw); }, pixels.raw);
  count_values(pixels.clean.pixels(), sums.clean);
  count_values(pixels.labels.pixels(), sums.labels);
  const int rows = pixels.clean.rows();
  std::uint64_t in_mask = 0;
  for (int r = 0; r < rows; ++r) {
    // Of the row's middle: where all frames share one window and bins are rows, bin r however it is rounded.
    const double range_m = range_min_m + (r + 0.5) * (range_max_m - range_min_m) / rows;
    const int bin =
        std::clamp(static_cast<int>((range_m - bins.min_m) / (bins.max_m - bins.min_m) * bins.bins), 0, bins.bins - 1);
    const auto at = static_cast<std::size_t>(bin);
    sums.bin_raw[at] += std::visit([&](const auto& raw) { return sum_of(raw.row(r)); }, pixels.raw);
    const auto mask = pixels.mask.row(r);
    const auto set = static_cast<std::uint64_t>(std::count(mask.begin(), mask.end(), 255));
    sums.bin_pixels[at] += mask.size();
    sums.bin_mask[at] += set;
    in_mask += set;
  }
  sums.without_echo = in_mask == 0 ? 1 : 0;
  return sums;
}

}  // namespace ensonify
