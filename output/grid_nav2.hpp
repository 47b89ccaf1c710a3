#pragma once

#include <filesystem>

#include "ensonify/core/occupancy_grid.hpp"

namespace ensonify {

/// A horizontal slice through the cells at height `z_m` (world, negative below the water surface) as a map of nav2's
/// map_server: `path` (.pgm; 0 occupied, 254 free, 205 unknown; row 0 at the largest y) and beside it the .yaml. With
/// `unobserved_is_unknown` cells that no ping observed are unknown. Throws ConfigError for a slice outside the grid.
void write_grid_nav2(const OccupancyGrid& grid, const std::filesystem::path& path, double z_m,
                     bool unobserved_is_unknown);

}  // namespace ensonify
