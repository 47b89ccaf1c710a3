#pragma once

#include <filesystem>

#include "ensonify/core/log_odds_map.hpp"
#include "ensonify/core/occupancy_grid.hpp"

namespace ensonify {

/// Point cloud (PLY 1.0, binary little endian): centre of every surface cell as x, y, z (float, m, world), its class
/// (`occupancy`, uchar) and whether it was observed (`observable`, uchar).
void write_grid_ply(const OccupancyGrid& grid, const std::filesystem::path& path);

/// Of a map, the centre of every occupied cell as x, y, z and its `log_odds` (float, natural).
void write_map_ply(const LogOddsMap& map, const std::filesystem::path& path);

}  // namespace ensonify
