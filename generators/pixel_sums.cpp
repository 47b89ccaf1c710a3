#include "ensonify/generators/pixel_sums.hpp"

#include <algorithm>

namespace ensonify {
namespace {

template <typename Sums>
void add_to(Sums& sums, const Sums& more) {
  for (std::size_t i = 0; i < more.size(); ++i) sums[i] += more[i];
}

void add_raw(const Image2<std::uint8_t>& raw, int row, PixelSums& sums, std::uint64_t& bin) {
  for (const std::uint8_t v : raw.row(row)) {
    ++sums.raw[v];
    bin += 257u * v;
  }
}

void add_raw(const Image2<std::uint16_t>& raw, int row, PixelSums& sums, std::uint64_t& bin) {
  for (const std::uint16_t v : raw.row(row)) {
    ++sums.raw[v >> 8];
    bin += v;
  }
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
  const int rows = pixels.clean.rows();
  std::uint64_t in_mask = 0;
  for (int r = 0; r < rows; ++r) {
    // Of the row's middle: where all frames share one window and bins are rows, bin r however it is rounded.
    const double range_m = range_min_m + (r + 0.5) * (range_max_m - range_min_m) / rows;
    const int bin =
        std::clamp(static_cast<int>((range_m - bins.min_m) / (bins.max_m - bins.min_m) * bins.bins), 0, bins.bins - 1);
    const auto at = static_cast<std::size_t>(bin);
    std::visit([&](const auto& raw) { add_raw(raw, r, sums, sums.bin_raw[at]); }, pixels.raw);
    for (const std::uint8_t v : pixels.clean.row(r)) ++sums.clean[v];
    for (const std::uint8_t v : pixels.labels.row(r)) ++sums.labels[v];
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
