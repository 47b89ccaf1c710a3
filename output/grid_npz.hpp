#pragma once

#include <filesystem>

#include "ensonify/core/occupancy_grid.hpp"

namespace ensonify {

/// Arrays: occupancy u1 [z, y, x], observable u1 [z, y, x] (all 0 before any ping), origin f8 [3] = minimum corner of
/// cell 0 (m, world), resolution f8 (m), and the texts axis_order, frame and classes for people.
void write_grid_npz(const OccupancyGrid& grid, const std::filesystem::path& path);

/// Reads what write_grid_npz writes; `observable` may be absent, arrays of other names are ignored. Throws DataError.
OccupancyGrid read_grid_npz(const std::filesystem::path& path);

}  // namespace ensonify
