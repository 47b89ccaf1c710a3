#pragma once

#include <vector>

#include "ensonify/core/posed_image.hpp"

namespace ensonify {

/// Most thresholds that one sweep holds.
constexpr int most_thresholds = 254;

/// The class of a grey level: how many of the ascending thresholds it reaches (z >= t). All that a map needs to know of
/// an image; the strongest pixel has the highest class.
struct ClassImage {
  Image2<std::uint8_t> class_of_pixel;
  int class_of_silence = 0;  ///< of level 0: more than 0 only where a threshold is 0 or less
};

/// Throws ConfigError for no thresholds, more than most_thresholds, one that is no number, or an order not ascending.
void require_valid(const std::vector<double>& thresholds);

/// Throws ConfigError for such thresholds, DataError for an empty image or a pixel that is no number.
ClassImage classify(const GreyPixels& grey, const std::vector<double>& thresholds);

}  // namespace ensonify
