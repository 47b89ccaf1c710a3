#pragma once

#include <vector>

#include "ensonify/core/image2.hpp"

namespace ensonify {

/// One level of the orthonormal two-dimensional Haar transform; an odd side repeats its last pixel (half-sample
/// symmetric extension).
struct HaarLevel {
  Image2<float> rows, columns, diagonal;  ///< detail across rows, across columns, both
  int image_rows = 0, image_columns = 0;  ///< of what was split
};

/// Splits `image` `count` times; it becomes the approximation. Finest level first.
std::vector<HaarLevel> split_haar(Image2<float>& image, int count);

/// Undoes split_haar.
Image2<float> join_haar(Image2<float> approximation, const std::vector<HaarLevel>& levels);

}  // namespace ensonify
