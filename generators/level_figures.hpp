#pragma once

#include <array>
#include <cstdint>

#include "ensonify/generators/speckle_figures.hpp"

namespace ensonify {

constexpr int range_profile_bins = 20;
constexpr int beam_profile_bins = 16;
inline constexpr std::array level_percents{1.0, 5.0, 25.0, 50.0, 75.0, 90.0, 95.0, 99.0, 99.9};

/// Sums over the levels of whole images; images of any size add up, since profiles are in equal parts of an image.
struct LevelSums {
  std::array<std::uint64_t, 256> histogram{};  ///< pixels of a level, rounded down
  std::uint64_t pixels = 0, zeros = 0, saturated = 0;
  double sum = 0, square = 0;
  std::array<double, range_profile_bins> range_sum{};
  std::array<std::uint64_t, range_profile_bins> range_pixels{};
  std::array<double, beam_profile_bins> beam_sum{};
  std::array<std::uint64_t, beam_profile_bins> beam_pixels{};

  LevelSums& operator+=(const LevelSums& other);

  /// Of at least one pixel.
  double mean() const;
  double standard_deviation() const;
  /// The level below which `percent` of the pixels lie, between neighbours by a straight line; of the histogram.
  double percentile(double percent) const;
};

LevelSums sum_levels(const GreyImage& image);

}  // namespace ensonify
