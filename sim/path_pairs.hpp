#pragma once

#include "ensonify/sim/path_image.hpp"
#include "ensonify/sim/path_points.hpp"

namespace ensonify {

/// Share of the fan's points that every point is joined to: one of every tile.
inline constexpr float joined_share = 1.0f / PathFan::tile_columns;

/// Joins points of the fan with each other (see `path_pair`) and adds every pair at both of its bearings. Whether a tile
/// sees a block of tiles is asked by one ray, of a pair picked in proportion to its energy: so the energy of the pairs is
/// free of noise, and their visibility right on average.
void add_joined_pairs(const RayScene& scene, const PathHits& hits, const RayAxes& axes, PathImage& image);

}  // namespace ensonify
