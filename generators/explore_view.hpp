#pragma once

#include <vector>

#include "ensonify/core/sonar_geometry.hpp"
#include "ensonify/generators/explore_ways.hpp"

namespace ensonify {

/// What a level sonar sees of the columns of a slice.
struct SonarView {
  double port_rad = 0;       ///< outer border of the port-most beam
  double starboard_rad = 0;  ///< of the last, below port_rad
  /// Nearer columns are higher than the fan there: it can not tell that they are free.
  double nearest_m = 0;
  double range_max_m = 0;
};

/// The view of the layers of `slab` by a sonar at z_m; elevations count within +-elevation_fov_rad / 2.
SonarView view_of(const SonarGeometry& geometry, double elevation_fov_rad, const GridFrame& slab, double z_m);

/// What a look at a column is worth: 0 of columns that are known or of no interest.
using ColumnWorth = std::vector<float>;

/// Worth times area (m2) of the columns that a look from (x, y) passes, for bearings 2 pi (i + 1/2) / bearings from
/// east: rays end at occupied columns; beyond unknown ones, which may hide more, worth halves every metre.
std::vector<double> worth_by_bearing(const Slice& slice, const ColumnWorth& worth, const SonarView& view, double x_m,
                                     double y_m, int bearings);

/// Of every heading 2 pi (i + 1/2) / n, the sum over the bearings within the fan.
std::vector<double> worth_by_heading(const std::vector<double>& by_bearing, const SonarView& view);

/// Counts one more look for the columns that are still unknown after the ping from `at` and that it should have told
/// of: the first 0.3 m of unknown along its rays, since deeper ones may well be hidden.
void count_looks(const Slice& slice, const SonarView& view, const PlanarPose& at, std::vector<std::uint8_t>& looks);

}  // namespace ensonify
