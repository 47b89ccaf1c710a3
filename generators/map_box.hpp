#pragma once

#include <optional>
#include <string>

#include "ensonify/core/occupancy_grid.hpp"
#include "ensonify/generators/map_pings.hpp"

namespace ensonify {

/// A box of the world, metres.
struct WorldBox {
  Vec3 low_m = Vec3::Zero(), high_m = Vec3::Zero();
};

/// What the pings reach: nominal fields of view out to their last bins.
WorldBox reach_of(const PlacePings& pings, MapPoses poses);
WorldBox box_of_grid(const GridFrame& frame);
WorldBox union_of(const WorldBox& a, const WorldBox& b);

/// The truth grid of a place (DATASET/grids/<place>.npz); empty where there is none. Throws DataError for a broken one.
std::optional<OccupancyGrid> truth_of_place(const Dataset& dataset, const std::string& place);

/// What a frame of cells must not exceed.
struct MemoryRule {
  double bytes_a_cell = 0;
  double other_bytes = 0;
  double limit_bytes = 0;
};

/// Cells that hold the box, their borders at multiples of the resolution. Before anything is allocated: throws
/// ConfigError where they may need more memory than there is, and says which resolution would do.
GridFrame frame_over(const WorldBox& box, double resolution_m, const MemoryRule& rule);

}  // namespace ensonify
