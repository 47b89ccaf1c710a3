#pragma once

#include <cstdint>

#include "ensonify/core/image2.hpp"
#include "ensonify/core/sonar_geometry.hpp"

namespace ensonify {

/// Nearest keeps a mask's two levels.
enum class Resampling { bilinear, nearest };

/// The image as an operator sees it: forward up, port left, sonar at the middle of the lower edge, `height` pixels for
/// range_max, 2 ceil(height sin(half the fan)) wide. Between beam centres and bin centres, 0 outside the fan.
Image2<std::uint8_t> fan_view(const Image2<std::uint8_t>& image, const SonarGeometry& geometry, int height);
Image2<float> fan_view(const Image2<float>& image, const SonarGeometry& geometry, int height, Resampling resampling);

/// Back from such a view to range bins and beams, bilinear. Throws DataError where the view is not as wide as its
/// height and the fan make it.
Image2<float> polar_view(const Image2<float>& fan, const SonarGeometry& geometry);

}  // namespace ensonify
