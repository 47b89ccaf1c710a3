#pragma once

#include "ensonify/core/image2.hpp"

namespace ensonify {

/// How finely the pixels of an image were stored: some filters' references round or clip where the input was whole.
enum class GreyDepth { bits8, bits16, real };

/// A sonar image as filters see it: grey levels on the scale 0..255 whatever the depth, rows = range bins, columns =
/// beams.
struct GreyImage {
  Image2<float> grey;
  GreyDepth depth = GreyDepth::real;
};

}  // namespace ensonify
