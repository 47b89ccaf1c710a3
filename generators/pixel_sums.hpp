#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "ensonify/generators/frame_pixels.hpp"

namespace ensonify {

/// Equal steps of range over which frames are averaged.
struct RangeBins {
  double min_m = 0, max_m = 1;
  int bins = 1;
};

constexpr int label_count = 6;

/// Sums over the pixels of frames. Whole numbers only, so that the order in which frames are added does not matter.
struct PixelSums {
  std::array<std::uint64_t, 256> raw{}, clean{};  ///< pixels of a grey level; 16 bits are told by their upper byte
  std::array<std::uint64_t, label_count> labels{};
  std::uint64_t frames = 0;
  std::uint64_t without_echo = 0;  ///< frames whose mask is empty
  /// A range bin: its pixels, those in the mask, and the sum of raw (0..65535, a grey level of 8 bits counts 257).
  std::vector<std::uint64_t> bin_pixels, bin_mask, bin_raw;

  PixelSums& operator+=(const PixelSums& other);
};

/// The sums of one frame, whose rows reach from range_min_m to range_max_m; labels must be below label_count.
PixelSums sum_pixels(const FramePixels& pixels, double range_min_m, double range_max_m, const RangeBins& bins);

}  // namespace ensonify
