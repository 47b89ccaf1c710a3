#pragma once

#include <cstdint>

#include "ensonify/core/image2.hpp"
#include "ensonify/core/sonar_geometry.hpp"

namespace ensonify {

/// The image as an operator sees it: forward up, port left, sonar at the middle of the lower edge, `height` pixels for
/// range_max. Bilinear between beam centres and bin centres, 0 outside the fan.
Image2<std::uint8_t> fan_view(const Image2<std::uint8_t>& image, const SonarGeometry& geometry, int height);

}  // namespace ensonify
