#pragma once

#include <cstdint>
#include <variant>

#include "ensonify/core/image2.hpp"
#include "ensonify/core/pose.hpp"
#include "ensonify/core/sonar_geometry.hpp"

namespace ensonify {

/// Grey levels on 0..255, as a device or a filter gives them; rows = range bins, columns = beams.
using GreyPixels = std::variant<Image2<std::uint8_t>, Image2<float>>;

/// One ping as a mapper gets it: what was heard, by which geometry (range window included), from where.
struct PosedImage {
  GreyPixels grey;
  SonarGeometry geometry;
  Pose T_world_sonar = Pose::Identity();
  /// Elevation (rad) of the strongest echo of a pixel, NaN where none. Empty unless known: only a simulator can tell.
  Image2<float> elevation_rad = {};
};

}  // namespace ensonify
