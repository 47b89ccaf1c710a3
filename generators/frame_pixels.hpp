#pragma once

#include <cstdint>
#include <string_view>
#include <variant>

#include "ensonify/core/image2.hpp"

namespace ensonify {

/// The pixels of a frame as its files hold them; `raw` has 8 or 16 bits, as the instrument has.
struct FramePixels {
  std::variant<Image2<std::uint8_t>, Image2<std::uint16_t>> raw;
  Image2<std::uint8_t> clean;
  Image2<std::uint8_t> mask;
  Image2<std::uint8_t> labels;
};

/// Which of them to read: decoding is most of the work.
struct FrameKinds {
  bool raw = true, clean = true, mask = true, labels = true;

  bool has(std::string_view kind) const {
    return (kind == "raw" && raw) || (kind == "clean" && clean) || (kind == "mask" && mask) ||
           (kind == "labels" && labels);
  }
};

}  // namespace ensonify
