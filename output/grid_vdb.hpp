#pragma once

#include <filesystem>

#include "ensonify/core/occupancy_grid.hpp"

namespace ensonify {

/// OpenVDB file: a float grid `occupancy` (background 0 free, 1 surface, 2 interior) and, after pings, a bool grid
/// `observable`; cell centres at VDB's integer coordinates. Throws DataError where the build has no OpenVDB.
void write_grid_vdb(const OccupancyGrid& grid, const std::filesystem::path& path);

}  // namespace ensonify
