#pragma once

#include "ensonify/core/echo.hpp"
#include "ensonify/core/occupancy_grid.hpp"
#include "ensonify/core/sonar_geometry.hpp"

namespace ensonify {

/// Sets grid.observable to 1 for every cell that one ping sees; never clears one.
/// - A free cell: its centre lies in the nominal frustum (range_min..range_max, between the outer beam borders,
///   |elevation| <= elevation_fov / 2) nearer than the first hit of the nearest traced ray.
/// - A surface cell: the hit point of a ray in the nominal frustum lies in it.
/// - An interior cell: never.
/// Projective: the cells look themselves up in the image of first hits, no ray is walked.
/// Throws ConfigError where sizes do not match.
void mark_observed(const PingTruth& truth, const SonarGeometry& geometry, const Pose& T_world_sonar,
                   OccupancyGrid& grid);

}  // namespace ensonify
