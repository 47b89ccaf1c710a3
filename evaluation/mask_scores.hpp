#pragma once

#include <array>
#include <cstdint>

#include "ensonify/core/image2.hpp"

namespace ensonify {

/// Pixels of a mask against the true one.
struct MaskCounts {
  std::uint64_t true_positive = 0, false_positive = 0, false_negative = 0;

  MaskCounts& operator+=(const MaskCounts& other);
  /// NaN for 0 / 0.
  double precision() const, recall() const, iou() const, f1() const;
};

/// Grey levels, cut to whole numbers and held to 0..255, of pixels in and outside the true mask: all that masks by any
/// whole threshold depend on.
struct LevelCounts {
  std::array<std::uint64_t, 256> echo{}, background{};

  LevelCounts& operator+=(const LevelCounts& other);
  /// Of the mask "level >= t".
  MaskCounts at(int t) const;
  /// The threshold of 1..255 with the greatest IoU, and so the greatest F1; the lowest of equals.
  int best_threshold() const;
};

LevelCounts count_levels(const Image2<float>& image, const Image2<std::uint8_t>& mask);

}  // namespace ensonify
