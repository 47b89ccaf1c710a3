#pragma once

#include <cstdint>

namespace ensonify {

/// One pixel of a picture, sRGB.
struct Rgb {
  std::uint8_t red = 0, green = 0, blue = 0;
  bool operator==(const Rgb&) const = default;
};

}  // namespace ensonify
