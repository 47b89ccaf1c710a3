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

/// What the looks so far leave to be asked of columns.
struct LookMemory {
  std::vector<std::uint8_t> in_vain;  ///< looks that should have told of it and did not
  std::vector<float> nearest_m;       ///< from where it was seen as the first occupied one of a ray; infinite: never
};

/// What a look at a column is worth, 0..1.
struct ColumnWorth {
  std::vector<float> look;      ///< halved by every look in vain
  std::vector<float> closer_m;  ///< an occupied one is worth it only from at most so far: afar, what echoes may be
                                ///< above or below the slice
};

/// Unknown columns have 1, occupied ones half of it: resolved are those that were seen from `resolved_m`; else a look
/// is worth it from there, or from half as far as the nearest.
ColumnWorth worth_of(const Slice& slice, const ColumnMask& interest, const LookMemory& looks, double resolved_m);

/// Worth times area (m2) of the columns that a look from (x, y) passes, for bearings 2 pi (i + 1/2) / bearings from
/// east: rays end at occupied columns; beyond unknown ones, which may hide more, worth halves every metre.
std::vector<double> worth_by_bearing(const Slice& slice, const ColumnWorth& worth, const SonarView& view, double x_m,
                                     double y_m, int bearings);

/// Of every heading 2 pi (i + 1/2) / n, the sum over the bearings within the fan.
std::vector<double> worth_by_heading(const std::vector<double>& by_bearing, const SonarView& view);

/// Counts a look in vain for all columns that worth_by_bearing() sees from `at` in the fan: once the vehicle has been
/// there, what it promised and did not give must not call it back for ever.
void count_in_vain(const Slice& slice, const ColumnWorth& worth, const SonarView& view, const PlanarPose& at,
                   int bearings, LookMemory& looks);

/// Remembers the ping from `at`, after it was mapped. Of unknown columns the first 0.3 m along a ray count as looked at
/// in vain, since deeper ones may well be hidden.
void count_looks(const Slice& slice, const SonarView& view, const PlanarPose& at, LookMemory& looks);

}  // namespace ensonify
