#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "ensonify/core/colour.hpp"
#include "ensonify/core/image2.hpp"

namespace ensonify {

/// A grey image scaled to this size; where it shrinks, a pixel is the mean of those that it covers.
Image2<std::uint8_t> resized(const Image2<std::uint8_t>& image, int rows, int columns);

/// Pictures that belong together, side by side, of one height.
struct ContactTile {
  std::string caption;  ///< below
  std::vector<Image2<std::uint8_t>> pictures;
};

struct ContactRow {
  std::string label;  ///< above
  std::vector<ContactTile> tiles;
};

struct ContactSheet {
  std::string title;
  std::vector<ContactRow> rows;
};

/// Lays the rows out below each other, each in columns of equal width. Letters beyond ASCII are drawn as '?'.
Image2<Rgb> draw_contact_sheet(const ContactSheet& sheet);

}  // namespace ensonify
