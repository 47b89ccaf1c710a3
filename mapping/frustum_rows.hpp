#pragma once

#include "ensonify/core/sonar_geometry.hpp"
#include "ensonify/mapping/cell_box.hpp"

namespace ensonify {

/// The part of space that an image shows: range_min..range_max, the fan between the outer borders of its beams,
/// elevations within +-elevation_share of the nominal field of view.
struct Frustum {
  double range_max_m = 0;
  double port_rad = 0;
  double starboard_rad = 0;
  double tan_elevation = 0;
  Pose T_world_sonar = Pose::Identity();

  Frustum(const SonarGeometry& geometry, double elevation_share, const Pose& T_world_sonar_);

  /// A box of cells of the grid that holds all of it.
  CellBox reach(const GridFrame& frame) const;
};

/// Pieces of a row of cells along x, as [low, high) of ix.
struct RowPieces {
  std::array<std::array<int, 2>, 2> piece{};
  int count = 0;
};

/// Pieces whose centres `start + ix * step` (sonar frame) may lie in the frustum, with a cell to spare at their ends;
/// ranges nearer than range_min are not left out. Two at most: a cone of elevations may have a row in its both halves.
RowPieces pieces_in(const Frustum& frustum, const Vec3& start, const Vec3& step, int low, int high);

}  // namespace ensonify
