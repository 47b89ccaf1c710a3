#pragma once

#include <cstdint>
#include <vector>

#include "ensonify/core/echo.hpp"
#include "ensonify/core/occupancy_grid.hpp"
#include "ensonify/core/sonar_geometry.hpp"

namespace ensonify {

/// Cells first .. first + count - 1 of a grid, in the order of GridFrame::index.
struct CellRun {
  std::uint32_t first = 0;
  std::uint32_t count = 0;
  bool operator==(const CellRun&) const = default;
};

/// The cells that one ping sees, ascending:
/// - a free cell: its centre lies in the nominal frustum (range_min..range_max, between the outer beam borders,
///   |elevation| <= elevation_fov / 2) nearer than the first hit of the nearest traced ray;
/// - a surface cell: the hit point of a ray in the nominal frustum lies in it;
/// - an interior cell: never.
/// Projective: the cells look themselves up in the image of first hits, no ray is walked.
/// Throws ConfigError where sizes do not match, or the grid has 2^32 cells.
std::vector<CellRun> observed_cells(const PingTruth& truth, const SonarGeometry& geometry, const Pose& T_world_sonar,
                                    const OccupancyGrid& grid);

/// Sets grid.observable to 1 for the observed cells; never clears one.
void mark_observed(const PingTruth& truth, const SonarGeometry& geometry, const Pose& T_world_sonar,
                   OccupancyGrid& grid);

}  // namespace ensonify
