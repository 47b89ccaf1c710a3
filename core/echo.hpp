#pragma once

#include <cstdint>
#include <vector>

#include "ensonify/core/image2.hpp"

namespace ensonify {

/// Mean (speckle-free) echo of one ping before the point spread, in layers; rows = range bins, columns = beams.
/// A cell holds the received intensity over the source intensity at 1 m (dimensionless, linear), so that
/// echo level = source level + 10 log10(cell) (Urick 1983, sonar equation).
struct Echo {
  Image2<float> direct;
  /// Paths that met more than one surface, at the range of half their length and the bearing of their last leg.
  /// Empty unless traced.
  Image2<float> multipath;
  /// Mean elevation (rad) of the direct echo, weighted with its energy: with range and bearing the place on the surface
  /// that the speckle belongs to. 0 where nothing echoes. Empty unless asked for.
  Image2<float> elevation_rad;
};

/// What the rays of one ping met, from the same hits that made its `Echo`.
struct PingTruth {
  /// First hit along every traced ray: rows = elevation rays (row 0 lowest), columns = azimuth rays
  /// (column 0 port-most); +inf where nothing was met within range_max.
  Image2<float> first_hit_range_m;
  std::vector<float> ray_azimuth_rad;       ///< a column, descending
  std::vector<float> lowest_elevation_rad;  ///< a column: elevation of its row 0
  float elevation_step_rad = 0;             ///< from row to row

  /// A beam: first bin before which at least half of the elevation arc is occluded; range_bins if none.
  std::vector<int> shadow_start_bin;

  /// A cell of the image: extent of the elevations that echo in it, and of its strongest echo the
  /// elevation, the incidence angle (rad) and the scene instance. NaN and -1 where nothing echoes.
  /// Empty unless asked for.
  Image2<float> elevation_min_rad;
  Image2<float> elevation_max_rad;
  Image2<float> elevation_strongest_rad;
  Image2<float> incidence_rad;
  Image2<std::int32_t> instance;
};

/// What a pixel shows (values of labels/*.png).
enum class PixelLabel : std::uint8_t {
  water = 0,
  direct = 1,
  multipath = 2,
  sidelobe = 3,
  shadow = 4,
  outside = 5,
};

/// An image as a device gives it: `level` in 0..1 after gamma, `grey` the same quantised to 8 bits.
struct SonarImage {
  Image2<float> level;
  Image2<std::uint8_t> grey;
};

}  // namespace ensonify
