#pragma once

#include <filesystem>

#include "ensonify/core/log_odds_map.hpp"
#include "ensonify/core/occupancy_grid.hpp"

namespace ensonify {

/// Arrays: occupancy u1 [z, y, x], observable u1 [z, y, x] (all 0 before any ping), origin f8 [3] = minimum corner of
/// cell 0 (m, world), resolution f8 (m), and the texts axis_order, frame and classes for people.
void write_grid_npz(const OccupancyGrid& grid, const std::filesystem::path& path);

/// Reads what write_grid_npz writes; `observable` may be absent, arrays of other names are ignored. Throws DataError.
OccupancyGrid read_grid_npz(const std::filesystem::path& path);

/// A map: the arrays of a grid (occupancy 0 or 1, observable where the cell is known) and log_odds f4 [z, y, x],
/// natural, positive = occupied, 0 = unknown; the text `log_odds_sign` says so.
void write_map_npz(const LogOddsMap& map, const std::filesystem::path& path);

/// Reads log_odds, origin and resolution of what write_map_npz writes. Throws DataError, also where a value is no
/// number.
LogOddsMap read_map_npz(const std::filesystem::path& path);

}  // namespace ensonify
