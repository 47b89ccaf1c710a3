#pragma once

#include <algorithm>
#include <cstdint>
#include <type_traits>

#include "ensonify/core/image2.hpp"

namespace ensonify {

/// How finely the pixels of an image were stored: some filters' references round or clip where the input was whole.
enum class GreyDepth { bits8, bits16, real };

/// Between neighbouring levels; 0 of real numbers.
constexpr double level_step(GreyDepth depth) {
  if (depth == GreyDepth::bits8) return 1.0;
  return depth == GreyDepth::bits16 ? 1.0 / 257.0 : 0.0;
}

/// A sonar image as filters see it: grey levels on the scale 0..255 whatever the depth, rows = range bins, columns =
/// beams.
struct GreyImage {
  Image2<float> grey;
  GreyDepth depth = GreyDepth::real;
};

/// From pixels of 8 bits, or of 16 whose 65535 becomes 255.
template <typename Pixel>
GreyImage to_grey(const Image2<Pixel>& pixels) {
  constexpr bool bits8 = std::is_same_v<Pixel, std::uint8_t>;
  static_assert(bits8 || std::is_same_v<Pixel, std::uint16_t>);
  GreyImage image{Image2<float>(pixels.rows(), pixels.columns()), bits8 ? GreyDepth::bits8 : GreyDepth::bits16};
  std::transform(pixels.pixels().begin(), pixels.pixels().end(), image.grey.pixels().begin(),
                 [](Pixel v) { return bits8 ? static_cast<float>(v) : static_cast<float>(v * (1.0 / 257.0)); });
  return image;
}

}  // namespace ensonify
