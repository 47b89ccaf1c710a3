#pragma once

#include <filesystem>

#include "ensonify/core/occupancy_grid.hpp"

namespace ensonify {

/// Point cloud (PLY 1.0, binary little endian): centre of every surface cell as x, y, z (float, m, world), its class
/// (`occupancy`, uchar) and whether it was observed (`observable`, uchar).
void write_grid_ply(const OccupancyGrid& grid, const std::filesystem::path& path);

}  // namespace ensonify
