#pragma once

#include <cstdint>
#include <vector>

#include "ensonify/core/occupancy_grid.hpp"
#include "ensonify/mapping/log_odds_grid.hpp"

namespace ensonify {

enum class ColumnState : std::uint8_t { unknown, free, occupied };

/// Columns of cells, as high as a vehicle that keeps its depth: what it may run into. Frame: size[2] is 1 and z of no
/// meaning.
struct Slice {
  GridFrame frame;
  std::vector<ColumnState> columns;  ///< in the order of GridFrame::index

  std::size_t index(int ix, int iy) const { return frame.index(ix, iy, 0); }
  bool contains(int ix, int iy) const { return frame.contains(ix, iy, 0); }
  /// Unknown outside.
  ColumnState at(int ix, int iy) const { return contains(ix, iy) ? columns[index(ix, iy)] : ColumnState::unknown; }
  int ix_of(double x_m) const { return static_cast<int>(std::floor((x_m - frame.origin_m.x()) / frame.resolution_m)); }
  int iy_of(double y_m) const { return static_cast<int>(std::floor((y_m - frame.origin_m.y()) / frame.resolution_m)); }
  double x_m(int ix) const { return frame.origin_m.x() + frame.resolution_m * (ix + 0.5); }
  double y_m(int iy) const { return frame.origin_m.y() + frame.resolution_m * (iy + 0.5); }
};

/// One byte a column, 0 or 1.
using ColumnMask = std::vector<std::uint8_t>;

/// The layers of `whole` that z_m +- height_m / 2 touches, as a grid of its own. Throws ConfigError where they are not
/// all inside.
GridFrame slab_of(const GridFrame& whole, double z_m, double height_m);

/// A column is occupied where one of its cells is, free where all are, and unknown else.
Slice slice_of(const LogOddsGrid& map);
/// The truth within the layers of `slab`, which must be a slab of its grid. Surface and interior are occupied.
Slice slice_of(const OccupancyGrid& truth, const GridFrame& slab);

/// Distance (m) of a point from the nearest point of a column; 0 inside.
double distance_to_column_m(const Slice& slice, int ix, int iy, double x_m, double y_m);

/// Columns whose centre is at least clearance_m from every column that is not free. What lies outside the slice is not
/// free.
ColumnMask columns_with_room(const Slice& slice, double clearance_m);

}  // namespace ensonify
